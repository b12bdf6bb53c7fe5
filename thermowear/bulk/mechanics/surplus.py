"""Hierarchical surplus of the next degree over a space of Lagrange elements.

It consists of the polynomials of degree k + 1 that vanish at the nodes of degree k. On an edge with
Gauss-Lobatto nodes that is one function, ``(1 - s²) P'_k(s)``, so that the surplus is continuous
between cells, and in 1D orthogonal in energy to the polynomials of degree k (Szabó and Babuška,
Finite Element Analysis (1991), 6.1). On hexahedra only its products with linear functions of the
other directions are used: the others have a higher total degree and cost ten times as much.
"""

from __future__ import annotations

from functools import cache
from itertools import product

import basix
import basix.ufl
import numpy as np
from dolfinx import fem

from ..bodies import Bodies
from ..field import reference_element
from ..spaces import Spaces

_LEGENDRE = basix.PolynomialType.legendre
_RANK_TOLERANCE = 1e-10


def surplus_spaces(bodies: Bodies, degree: int, components: int = 0) -> Spaces:
    """Surplus spaces over `spaces.lagrange_spaces` of a degree, scalar or vector-valued."""
    each = []
    for body in bodies.each:
        element = _element(reference_element(body.mesh, 1).cell_type, degree)
        if components:
            element = basix.ufl.blocked_element(element, shape=(components,))
        each.append(fem.functionspace(body.mesh, element))
    return Spaces(tuple(each))


@cache
def _element(cell: basix.CellType, degree: int):
    """Scalar element; its degrees of freedom are moments on edges, facets and cells."""
    geometry, topology = np.asarray(basix.geometry(cell)), basix.topology(cell)
    edges_only = cell == basix.CellType.hexahedron
    dim = len(topology) - 1
    points: list[list[np.ndarray]] = [[] for _ in range(4)]
    moments: list[list[np.ndarray]] = [[] for _ in range(4)]
    for d, (entities, kinds) in enumerate(
        zip(topology, basix.cell.subentity_types(cell), strict=True)
    ):
        for corners, kind in zip(entities, kinds, strict=True):
            at, weights = np.zeros((0, dim)), np.zeros((0, 0))
            if d == 1 or (d > 1 and not edges_only):
                local, weights = _moments(kind, degree)
                at = _mapped(kind, geometry[corners], local)
            points[d].append(np.ascontiguousarray(at))
            moments[d].append(np.ascontiguousarray(weights[:, None, :, None]))
    span = _products(cell, degree) if edges_only else _vanishing(cell, degree, inside=False)
    return basix.ufl.custom_element(
        cell,
        [],
        np.ascontiguousarray(span),
        points,
        moments,
        0,
        basix.MapType.identity,
        basix.SobolevSpace.H1,
        False,
        1,
        degree + 1,
    )


def _vanishing(cell: basix.CellType, degree: int, inside: bool) -> np.ndarray:
    """Polynomials of degree k + 1 that vanish at the nodes of degree k, in an orthonormal basis.

    If `inside`, they vanish on the boundary of the cell too.
    """
    low, high = (
        basix.create_element(basix.ElementFamily.P, cell, k, basix.LagrangeVariant.gll_warped)
        for k in (degree, degree + 1)
    )
    nodes = np.asarray(low.points)
    if inside:
        boundary = [i for entities in high.entity_dofs[:-1] for dofs in entities for i in dofs]
        nodes = np.vstack([nodes, np.asarray(high.points)[boundary]])
    values = np.asarray(basix.tabulate_polynomials(_LEGENDRE, cell, degree + 1, nodes))
    left, sizes, _ = np.linalg.svd(values)
    return left[:, np.count_nonzero(sizes > _RANK_TOLERANCE * sizes[0]) :].T


@cache
def _moments(kind: basix.CellType, degree: int) -> tuple[np.ndarray, np.ndarray]:
    """Quadrature points in an edge, facet or cell, and the weights of each moment there."""
    points, weights = _quadrature(kind, 2 * degree + 2)
    values = basix.tabulate_polynomials(_LEGENDRE, kind, degree + 1, points)
    return points, _vanishing(kind, degree, inside=True) @ values * weights


def _quadrature(cell: basix.CellType, degree: int) -> tuple[np.ndarray, np.ndarray]:
    points, weights = basix.make_quadrature(cell, degree)
    return np.asarray(points), np.asarray(weights)


def _mapped(kind: basix.CellType, corners: np.ndarray, local: np.ndarray) -> np.ndarray:
    """Map local points of an edge or facet with given corners to the cell."""
    units = np.asarray(basix.geometry(kind))
    along = [np.flatnonzero((units == unit).all(axis=1))[0] for unit in np.eye(units.shape[1])]
    return corners[0] + local @ (corners[along] - corners[0])


def _products(cell: basix.CellType, degree: int) -> np.ndarray:
    """Surplus along each direction times linear functions of the others, orthonormalised."""
    line = basix.CellType.interval
    inner = _vanishing(line, degree, inside=True)
    points, weights = _quadrature(cell, 2 * degree + 4)
    dim = points.shape[1]
    functions = []
    for i in range(dim):
        column = np.ascontiguousarray(points[:, i : i + 1])
        along = (inner @ basix.tabulate_polynomials(_LEGENDRE, line, degree + 1, column))[0]
        others = [points[:, j] for j in range(dim) if j != i]
        for ends in product((False, True), repeat=dim - 1):
            linear = [x if end else 1 - x for x, end in zip(others, ends, strict=True)]
            functions.append(along * np.prod(linear, axis=0))
    values = basix.tabulate_polynomials(_LEGENDRE, cell, degree + 1, points)
    return np.linalg.qr(values @ (np.array(functions) * weights).T)[0].T

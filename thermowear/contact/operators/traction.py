"""Traction operators: from nodal displacements to the normal stress of body 1 at the points.

Transposed and distributed like the operators of `traces`.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from dolfinx import fem

from ...bulk.field import reference_element
from ...bulk.mechanics.elasticity import Elasticity
from ...compat import coordinate_element, geometry_dofmap
from ...lagrange import equispaced, tabulated
from ...parallel import sum_over_ranks
from ..search.pairing import PairedFace, Pairing
from .traces import gather_rows, reference_points


def normal_traction(elastic: Elasticity, pairing: Pairing) -> sp.csr_matrix:
    """Transposed normal traction Sᵀ of body 1: shape (n_owned, n_points). Every rank calls.

    ``S u = n·σ(u) n_1 / (n·n_1)`` of body 1 [Pa], compression negative, without the thermal part
    (see `thermal_traction`): the traction on its own face, of normal n_1, along the normal of the
    common face, whose area is smaller by ``n·n_1``. At points shared by two facets it is the mean
    of both cells, weighted by their parts of the area, and converges like the interior stress.
    """
    space = elastic.space
    side, point, share = on_every_facet(pairing)
    mine = np.flatnonzero(side.face.rank[side.facet] == space.mesh.comm.rank)
    values = cell_traction(elastic, side, mine, pairing.normals[point[mine]])
    values *= share[mine, None, None]
    cells = side.face.cell[side.facet[mine]]
    rows = space.dofmap.list[cells].astype(np.int64)[..., None] * 2 + np.arange(2)
    columns = np.broadcast_to(point[mine, None, None], values.shape)
    entries = rows.ravel(), columns.ravel(), values.ravel()
    return gather_rows(space, *entries, len(pairing.weights))


def cell_traction(
    elastic: Elasticity, side: PairedFace, chosen: np.ndarray, normals: np.ndarray
) -> np.ndarray:
    """Traction along normals per nodal displacement of the cell, shape (n, nodes, 2) [Pa/m].

    Per area of the common face with these normals.

    Parameters
    ----------
    elastic : Elasticity
    side : PairedFace
    chosen : ndarray of int, shape (n,)
        Entries of the side, all in cells of this rank.
    normals : ndarray, shape (n, 2)
        Normals of the common face.
    """
    facet = side.facet[chosen]
    cells = side.face.cell[facet]
    own = side.face.normals(facet, side.t[chosen])
    kind = reference_element(elastic.bodies.mesh, 1).cell_type
    reference = reference_points(side, chosen, kind)
    _, slopes, divergence = displacement_slopes(elastic, cells, reference)
    λ, μ = (cell_values(function, cells)[:, None, None] for function in elastic.lame[:2])
    along, outward = (np.einsum("nai,ni->na", slopes, v)[..., None] for v in (normals, own))
    sheared = outward * normals[:, None] + along * own[:, None]
    return λ * divergence + μ * sheared / np.einsum("ni,ni->n", normals, own)[:, None, None]


def thermal_traction(elastic: Elasticity, pairing: Pairing) -> np.ndarray:
    """Thermal modulus m: a rise adds ``-m rise`` to the normal traction, shape (n,) [Pa/K]."""
    return at_points(elastic.lame[2], pairing.sides[0])


def at_points(function: fem.Function, side: PairedFace) -> np.ndarray:
    """Values of a function that is constant on each cell, shape (n,). Every rank calls."""
    comm = function.function_space.mesh.comm
    mine = side.face.rank[side.facet] == comm.rank
    values = np.zeros(len(side.t))
    values[mine] = cell_values(function, side.face.cell[side.facet[mine]])
    return sum_over_ranks(comm, values)


def cell_values(function: fem.Function, cells: np.ndarray) -> np.ndarray:
    """Values of a function that is constant on each cell, in cells of this rank."""
    return function.x.array[function.function_space.dofmap.list[cells, 0]]


def displacement_slopes(elastic: Elasticity, cells: np.ndarray, reference: np.ndarray):
    """Derivatives of the displacement shape functions at one reference point per cell.

    Parameters
    ----------
    elastic : Elasticity
    cells : ndarray of int, shape (n,)
        Cells of this rank.
    reference : ndarray, shape (n, 2)

    Returns
    -------
    volume : ndarray, shape (n,)
        Volume of the solid per volume of the reference cell [m³].
    slopes : ndarray, shape (n, nodes, 2)
        Derivatives of the shape functions along the coordinates [1/m].
    divergence : ndarray, shape (n, nodes, 2)
        tr ε per nodal displacement in each direction [1/m].
    """
    mesh, model = elastic.bodies.mesh, elastic.kinematics
    element = reference_element(mesh, elastic.space.ufl_element().degree)
    geometry = equispaced(element.cell_type.name, coordinate_element(mesh).degree)
    values, *derivatives = tabulated(element, reference, 1)
    placed, *stretched = tabulated(geometry, reference, 1)
    nodes = mesh.geometry.x[geometry_dofmap(mesh)[cells], :2]
    points = np.einsum("ng,ngi->ni", placed, nodes)
    jacobian = np.einsum("dng,ngi->nid", stretched, nodes)
    slopes = np.einsum("dna,ndi->nai", derivatives, np.linalg.inv(jacobian))
    divergence = slopes.copy()
    divergence[..., 0] += model.strain_across(values, slopes, points)
    return np.abs(np.linalg.det(jacobian)) * model.area_factor(points), slopes, divergence


def on_every_facet(pairing: Pairing) -> tuple[PairedFace, np.ndarray, np.ndarray]:
    """Points on body 1, those shared by two facets once per facet, with their area fraction.

    Returns
    -------
    side : PairedFace
        One entry per point and facet.
    point : ndarray of int
        Point index of each entry.
    share : ndarray
        Sums to one at each point.
    """
    side, s = pairing.sides[0], pairing.position
    inner = np.arange(1, len(s) - 1)
    meets = (side.t[inner] > 1 - 1e-9) & (side.facet[inner + 1] == side.facet[inner] + 1)
    meeting = inner[meets]
    # the end weights of a rule are proportional to the length of its piece, as is its first step
    left, right = s[meeting] - s[meeting - 1], s[meeting + 1] - s[meeting]
    share = np.ones(len(s))
    share[meeting] = left / (left + right)
    facet = np.concatenate([side.facet, side.facet[meeting] + 1])
    t = np.concatenate([side.t, np.zeros(len(meeting))])
    point = np.concatenate([np.arange(len(s)), meeting])
    return PairedFace(side.face, facet, t), point, np.concatenate([share, 1 - share[meeting]])

"""Nitsche's method: normal stress at the contact points, and stabilisation parameters.

The stress is that of the body whose face carries the points, here body 1.

The traction operator maps nodal displacements to the normal stress, transposed and distributed like
the operators of `condensation`. The parameters, of the penalty method too, come from the cells at
the contact.
"""

from __future__ import annotations

import itertools

import basix
import numpy as np
import scipy.sparse as sp
from dolfinx import fem

from ...bulk.elasticity.body import ElasticBody
from ...bulk.elasticity.elasticity import Elasticity
from ...bulk.spaces import reference_element
from ...compat import coordinate_element, geometry_dofmap
from ...lagrange import equispaced, tabulated
from ...parallel import sum_over_ranks
from ..operators.condensation import gather_rows, reference_points
from ..search.pairing import PairedFace, Pairing

GAMMA = 10.0
"""Default γ0. The stability limit is between 0.6 and 1.8 for ν <= 0.3 and below 4.2 at ν = 0.49,
over degrees 1 to 8, both cell types and all models."""
PENALTY = 10.0
"""Default penalty, on the scale of γ0: approach and mean pressures of a cylinder are then within
2e-3 (degree 1) to 1e-4 (degree 8) of the limit, and degree 1 does not yet oscillate."""
_MAX_STABILITY_MARGIN = 1e4
_REGULARISATION = 1e-9


def normal_traction(elastic: Elasticity, pairing: Pairing) -> sp.csr_matrix:
    """Transposed normal traction Sᵀ of body 1, compression negative, see `face_traction`."""
    return face_traction(elastic, pairing, pairing.normals)


def face_traction(elastic: Elasticity, pairing: Pairing, directions: np.ndarray) -> sp.csr_matrix:
    """Transposed traction Sᵀ of body 1 along directions e: (n_owned, n_points). Every rank calls.

    ``S u = e·σ(u) n_1 / (n·n_1)`` of body 1 [Pa], without the thermal part (see
    `thermal_traction`): the traction on its own face, of normal n_1, per area of the common face,
    which is smaller by ``n·n_1``. At points shared by two facets it is the mean of both cells,
    weighted by their parts of the area, and converges like the interior stress.

    Parameters
    ----------
    elastic : Elasticity
    pairing : Pairing
    directions : ndarray, shape (n_points, gdim)
    """
    side, point, share = on_every_facet(pairing)
    index, dim = side.face.body, elastic.bodies.dim
    space = elastic.spaces.each[index]
    mine = np.flatnonzero(side.face.rank[side.facet] == elastic.bodies.comm.rank)
    along = pairing.normals[point[mine]], directions[point[mine]]
    values = cell_traction(elastic.each[index], side, mine, *along)
    values *= share[mine, None, None]
    cells = side.face.cell[side.facet[mine]]
    rows = space.dofmap.list[cells].astype(np.int64)[..., None] * dim + np.arange(dim)
    columns = np.broadcast_to(point[mine, None, None], values.shape)
    entries = rows.ravel(), columns.ravel(), values.ravel()
    return gather_rows(elastic.spaces, index, *entries, len(pairing.weights))


def cell_traction(
    elastic: ElasticBody,
    side: PairedFace,
    chosen: np.ndarray,
    normals: np.ndarray,
    directions: np.ndarray,
) -> np.ndarray:
    """Traction along directions per nodal displacement of the cell, shape (n, nodes, gdim) [Pa/m].

    Per area of the common face with these normals.

    Parameters
    ----------
    elastic : ElasticBody
        The body of this side.
    side : PairedFace
    chosen : ndarray of int, shape (n,)
        Entries of the side, all in cells of this rank.
    normals, directions : ndarray, shape (n, gdim)
        Normals of the common face, and directions e.
    """
    facet = side.facet[chosen]
    cells = side.face.cell[facet]
    own = side.face.normals(facet, side.t[chosen])
    kind = reference_element(elastic.body.mesh, 1).cell_type
    reference = reference_points(side, chosen, kind)
    _, slopes, divergence = displacement_slopes(elastic, cells, reference)
    λ, μ = (cell_values(function, cells)[:, None, None] for function in elastic.lame[:2])
    along, outward = (np.einsum("nai,ni->na", slopes, v)[..., None] for v in (directions, own))
    area, across = (np.einsum("ni,ni->n", v, own) for v in (normals, directions))
    sheared = outward * directions[:, None] + along * own[:, None]
    return λ * divergence * (across / area)[:, None, None] + μ * sheared / area[:, None, None]


def thermal_traction(elastic: Elasticity, pairing: Pairing) -> np.ndarray:
    """Thermal modulus m: a rise adds ``-m rise`` to the normal traction, shape (n,) [Pa/K]."""
    return lame_at_points(elastic, pairing.carrying)[2]


def lame_at_points(elastic: Elasticity, side: PairedFace) -> np.ndarray:
    """Constants `lame` of the body of a side at its points, shape (3, n). Every rank calls."""
    comm = elastic.bodies.comm
    mine = side.face.rank[side.facet] == comm.rank
    values = np.zeros((3, len(side.t)))
    for row, function in zip(values, elastic.each[side.face.body].lame, strict=True):
        row[mine] = cell_values(function, side.face.cell[side.facet[mine]])
    return sum_over_ranks(comm, values)


def cell_values(function: fem.Function, cells: np.ndarray) -> np.ndarray:
    """Values of a function that is constant on each cell, in cells of this rank."""
    return function.x.array[function.function_space.dofmap.list[cells, 0]]


def displacement_slopes(elastic: ElasticBody, cells: np.ndarray, reference: np.ndarray):
    """Derivatives of the displacement shape functions at one reference point per cell.

    Parameters
    ----------
    elastic : ElasticBody
    cells : ndarray of int, shape (n,)
        Cells of this rank.
    reference : ndarray, shape (n, gdim)

    Returns
    -------
    volume : ndarray, shape (n,)
        Volume of the solid per volume of the reference cell [m³].
    slopes : ndarray, shape (n, nodes, gdim)
        Derivatives of the shape functions along the coordinates [1/m].
    divergence : ndarray, shape (n, nodes, gdim)
        tr ε per nodal displacement in each direction [1/m].
    """
    mesh, model = elastic.body.mesh, elastic.kinematics
    element = reference_element(mesh, elastic.space.ufl_element().degree)
    geometry = equispaced(element.cell_type.name, coordinate_element(mesh).degree)
    values, *derivatives = tabulated(element, reference, 1)
    placed, *stretched = tabulated(geometry, reference, 1)
    nodes = mesh.geometry.x[geometry_dofmap(mesh)[cells], : mesh.geometry.dim]
    points = np.einsum("ng,ngi->ni", placed, nodes)
    jacobian = np.einsum("dng,ngi->nid", stretched, nodes)
    slopes = np.einsum("dna,ndi->nai", derivatives, np.linalg.inv(jacobian))
    divergence = slopes.copy()
    divergence[..., 0] += model.strain_across(values, slopes, points)
    return np.abs(np.linalg.det(jacobian)) * model.area_factor(points), slopes, divergence


def on_every_facet(pairing: Pairing) -> tuple[PairedFace, np.ndarray, np.ndarray]:
    """Points on body 1, those shared by several facets for each of them, with their area fraction.

    Returns
    -------
    side : PairedFace
        One entry per point and part of a facet.
    point : ndarray of int
        Point index of each entry.
    share : ndarray
        Sums to one at each point.
    """
    face, pieces = pairing.carrying.face, pairing.pieces
    assert pieces.point is not None  # the points are paired
    every = PairedFace(face, pieces.facet, pieces.t)
    area = pieces.weight * face.stretch(pieces.facet, pieces.t)
    return every, pieces.point, area / np.bincount(pieces.point, area)[pieces.point]


def nitsche_stiffness(elastic: Elasticity, pairing: Pairing, gamma: float = GAMMA) -> np.ndarray:
    """Nitsche's γ = γ0 (λ + 2μ) k² / h of body 1, shape (n,) [Pa/m]. Every rank calls.

    k is the degree of the displacement and h the depth of the cell under its facet, volume over
    area: the length in the inverse trace inequality that bounds γ from below (Warburton and
    Hesthaven, Comput. Methods Appl. Mech. Eng. 192 (2003) 2765), for any cell shape; λ + 2μ is the
    exact factor between the square of a normal stress and the energy.
    """
    side, point, _ = on_every_facet(pairing)
    comm, face = elastic.bodies.comm, side.face
    volume = np.zeros(len(face.nodes))
    for facet in np.flatnonzero(face.rank == comm.rank):
        volume[facet] = _cell_rule(elastic.each[face.body], face.cell[facet])[0].sum()
    depth = sum_over_ranks(comm, volume) / face.integrals(elastic.kinematics.area_factor)
    λ, μ, _ = lame_at_points(elastic, side)
    modulus = λ + 2 * μ
    return gamma * elastic.spaces.degree**2 * _largest_at(point, modulus / depth[side.facet])


def default_penalty(elastic: Elasticity, pairing: Pairing) -> np.ndarray:
    """Mesh-dependent default penalty ``10 (λ + 2μ) k² / h``, shape (n,) [Pa/m].

    Every rank calls; same scale as `nitsche_stiffness`.
    """
    return nitsche_stiffness(elastic, pairing, PENALTY)


def stability_limit(elastic: Elasticity, pairing: Pairing) -> np.ndarray:
    """Lower bound of γ for the symmetric variant of Nitsche's method, shape (n,) [Pa/m].

    Largest eigenvalue of ``Sᵀ w S`` against the stiffness, in the cell of each facet: above it the
    Nitsche energy is convex. Every rank calls.
    """
    side, point, share = on_every_facet(pairing)
    limit, body = np.zeros(len(side.face.nodes)), elastic.each[side.face.body]
    for facet in np.unique(side.facet):
        if side.face.rank[facet] == elastic.bodies.comm.rank:
            chosen = np.flatnonzero(side.facet == facet)
            normals = pairing.normals[point[chosen]]
            traction = cell_traction(body, side, chosen, normals, normals)
            traction *= np.sqrt(pairing.weights[point] * share)[chosen, None, None]
            stiffness = _cell_stiffness(body, side.face.cell[facet])
            traction = traction.reshape(len(chosen), -1)
            against = traction @ np.linalg.solve(stiffness, traction.T)
            limit[facet] = np.linalg.eigvalsh(against)[-1]
    limit = sum_over_ranks(elastic.bodies.comm, limit)
    return _largest_at(point, limit[side.facet])


def nitsche_warning(stiffness: np.ndarray, limit: np.ndarray, theta: int) -> str | None:
    """Warning about γ out of range; None if it is within.

    Parameters
    ----------
    stiffness, limit : ndarray, shape (n,)
        Results of `nitsche_stiffness` and `stability_limit`.
    theta : int
    """
    margin = stiffness / limit
    if margin.min() < 1.0 and theta != -1:
        return (
            f"contact.gamma is {1 / margin.min():.2g} times too small: Nitsche's method may be "
            f"unstable. Multiply it by {2 / margin.min():.2g} or more, or set contact.theta = -1"
        )
    if margin.max() > _MAX_STABILITY_MARGIN:
        return (
            f"contact.gamma is {margin.max():.1g} times what stability needs: the method acts like "
            "a stiff penalty and the equations are ill conditioned. Make it smaller"
        )
    return None


def _largest_at(point: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Larger value at points shared by two facets."""
    largest = np.zeros(point.max() + 1)
    np.maximum.at(largest, point, values)
    return largest


def _cell_rule(elastic: ElasticBody, cell: int):
    """Volume weights, gradients and divergence at the quadrature points of one cell."""
    kind = reference_element(elastic.body.mesh, 1).cell_type
    degree = 2 * elastic.space.ufl_element().degree + 2
    reference, weights = (np.asarray(part) for part in basix.make_quadrature(kind, degree))
    cells = np.full(len(weights), cell)
    volume, slopes, divergence = displacement_slopes(elastic, cells, reference)
    return weights * volume, slopes, divergence


def _cell_stiffness(elastic: ElasticBody, cell: int) -> np.ndarray:
    """Stiffness matrix of one cell, regularised against rigid motions."""
    λ, μ = (cell_values(function, np.array([cell]))[0] for function in elastic.lame[:2])
    weights, slopes, divergence = _cell_rule(elastic, cell)
    dim = slopes.shape[-1]
    across = list(itertools.combinations(range(dim), 2))
    strain = np.zeros((len(weights), dim + 1 + len(across), *slopes.shape[1:]))
    for i in range(dim):
        strain[:, i, :, i] = slopes[..., i]
    strain[:, dim, :, 0] = divergence[..., 0] - slopes[..., 0]
    for k, (i, j) in enumerate(across, start=dim + 1):
        strain[:, k, :, [i, j]] = np.moveaxis(slopes[..., [j, i]], 2, 0) / np.sqrt(2)
    # rules in tetrahedra may have negative weights
    strain, trace = (v.reshape(len(v), -1, slopes[0].size) for v in (strain, divergence))
    stiffness = np.zeros((slopes[0].size,) * 2)
    for modulus, parts in ((2 * μ, strain), (λ, trace)):
        scaled = (modulus * weights)[:, None, None] * parts
        stiffness += np.concatenate(scaled).T @ np.concatenate(parts)
    stiffness[np.diag_indices_from(stiffness)] += _REGULARISATION * stiffness.max()
    return stiffness

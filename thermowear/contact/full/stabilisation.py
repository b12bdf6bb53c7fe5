"""Penalty and Nitsche stabilisation parameters from the cells at the contact."""

from __future__ import annotations

import basix
import numpy as np

from ...bulk.field import reference_element
from ...bulk.mechanics.elasticity import Elasticity
from ...parallel import sum_over_ranks
from ..operators.traction import (
    at_points,
    cell_traction,
    cell_values,
    displacement_slopes,
    on_every_facet,
)
from ..search.pairing import Pairing

GAMMA = 10.0
"""Default γ0. The stability limit is between 0.6 and 1.8 for ν <= 0.3 and below 4.2 at ν = 0.49,
over degrees 1 to 8, both cell types and all models."""
PENALTY = 10.0
"""Default penalty, on the scale of γ0: approach and mean pressures of a cylinder are then within
2e-3 (degree 1) to 1e-4 (degree 8) of the limit, and degree 1 does not yet oscillate."""
_MAX_STABILITY_MARGIN = 1e4
_REGULARISATION = 1e-9


def nitsche_stiffness(elastic: Elasticity, pairing: Pairing, gamma: float = GAMMA) -> np.ndarray:
    """Nitsche's γ = γ0 (λ + 2μ) k² / h of body 1, shape (n,) [Pa/m]. Every rank calls.

    k is the degree of the displacement and h the depth of the cell under its facet, volume over
    area: the length in the inverse trace inequality that bounds γ from below (Warburton and
    Hesthaven, Comput. Methods Appl. Mech. Eng. 192 (2003) 2765), for any cell shape; λ + 2μ is the
    exact factor between the square of a normal stress and the energy.
    """
    side, point, _ = on_every_facet(pairing)
    comm, face = elastic.bodies.mesh.comm, side.face
    volume = np.zeros(len(face.nodes))
    for facet in np.flatnonzero(face.rank == comm.rank):
        volume[facet] = _cell_rule(elastic, face.cell[facet])[0].sum()
    depth = sum_over_ranks(comm, volume) / face.integrals(elastic.kinematics.area_factor)
    modulus = at_points(elastic.lame[0], side) + 2 * at_points(elastic.lame[1], side)
    degree = elastic.space.ufl_element().degree
    return gamma * degree**2 * _largest_at(point, modulus / depth[side.facet])


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
    limit = np.zeros(len(side.face.nodes))
    for facet in np.unique(side.facet):
        if side.face.rank[facet] == elastic.bodies.mesh.comm.rank:
            chosen = np.flatnonzero(side.facet == facet)
            traction = cell_traction(elastic, side, chosen, pairing.normals[point[chosen]])
            traction *= np.sqrt(pairing.weights[point] * share)[chosen, None, None]
            stiffness = _cell_stiffness(elastic, side.face.cell[facet])
            traction = traction.reshape(len(chosen), -1)
            against = traction @ np.linalg.solve(stiffness, traction.T)
            limit[facet] = np.linalg.eigvalsh(against)[-1]
    limit = sum_over_ranks(elastic.bodies.mesh.comm, limit)
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


def _cell_rule(elastic: Elasticity, cell: int):
    """Volume weights, gradients and divergence at the quadrature points of one cell."""
    kind = reference_element(elastic.bodies.mesh, 1).cell_type
    degree = 2 * elastic.space.ufl_element().degree + 2
    reference, weights = (np.asarray(part) for part in basix.make_quadrature(kind, degree))
    cells = np.full(len(weights), cell)
    volume, slopes, divergence = displacement_slopes(elastic, cells, reference)
    return weights * volume, slopes, divergence


def _cell_stiffness(elastic: Elasticity, cell: int) -> np.ndarray:
    """Stiffness matrix of one cell, regularised against rigid motions."""
    λ, μ = (cell_values(function, np.array([cell]))[0] for function in elastic.lame[:2])
    weights, slopes, divergence = _cell_rule(elastic, cell)
    strain = np.zeros((len(weights), 4, *slopes.shape[1:]))
    strain[:, 0, :, 0], strain[:, 1, :, 1] = slopes[..., 0], slopes[..., 1]
    strain[:, 2, :, 0] = divergence[..., 0] - slopes[..., 0]
    strain[:, 3] = slopes[..., ::-1] / np.sqrt(2)
    strain *= np.sqrt(2 * μ * weights)[:, None, None, None]
    trace = (np.sqrt(λ * weights)[:, None, None] * divergence).reshape(len(weights), -1)
    strain = strain.reshape(-1, trace.shape[1])
    stiffness = strain.T @ strain + trace.T @ trace
    stiffness[np.diag_indices_from(stiffness)] += _REGULARISATION * stiffness.max()
    return stiffness

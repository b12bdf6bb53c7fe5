"""Pressure in an enriched pressure space, for a hierarchical error estimate.

The enriched space Ψ⁺ has the next degree. The response to Ψ is known at every contact point; of the
compliance of Ψ⁺ only the block of the details is missing, of the pressures orthogonal to Ψ. These
have short wavelengths, and the response to them is local, with a compliance proportional to the
facet size; one solution gives the constant.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import scipy.sparse as sp

from ...parallel import sum_over_ranks
from ..operators.condensation import Influence
from ..operators.pressure import dense, pressure_basis
from ..operators.rigid_motion import RigidHolder
from ..search.contacts import Contacts
from .signorini import solve_contact


def enriched_pressure(
    contacts: Contacts,
    influence: Influence,
    degrees: Sequence[int],
    holder: RigidHolder,
    pressure: np.ndarray,
    gap: np.ndarray,
    local: np.ndarray,
    elastic_opening: Callable[[np.ndarray], np.ndarray],
) -> np.ndarray:
    """Solve contact in the pressure space of the next degree, linearised at a known solution.

    Parameters
    ----------
    contacts : Contacts
    influence : Influence
    degrees : sequence of int
        Degree of the enriched pressure space Ψ⁺ of each interface.
    holder : RigidHolder
    pressure : ndarray, shape (n,) [Pa]
    gap : ndarray, shape (n,)
        Gap under that pressure, as accurate as available [m].
    local : ndarray, shape (n,)
        Local gap opening per pressure, without the elastic bodies [m/Pa].
    elastic_opening : callable
        Approximate elastic gap opening at the points due to a pressure at them [m].

    Returns
    -------
    ndarray, shape (n,) [Pa]

    Raises
    ------
    ComputationError
        If there is no solution.
    """
    finer = [pressure_basis(*each) for each in zip(contacts.each, degrees, strict=True)]
    basis, weights = dense(sp.block_diag(finer, format="csr")), contacts.weights
    weighted = weights[:, None] * basis
    compliance = _compliance(contacts, influence, basis, elastic_opening)
    compliance = compliance + weighted.T @ (local[:, None] * basis)
    start = np.linalg.lstsq(basis, pressure, rcond=None)[0]
    modes, force_modes = weighted.T @ holder.modes, weighted.T @ holder.force_modes
    solution = solve_contact(
        compliance,
        weighted.T @ gap - compliance @ start,
        modes,
        force_modes.T @ start,
        force_modes=force_modes,
    )
    return basis @ solution.coefficients


def _compliance(
    contacts: Contacts, influence: Influence, basis: np.ndarray, elastic_opening
) -> np.ndarray:
    """Compliance of the enriched basis: elastic response to Ψ, local for the details."""
    weighted = dense(influence.weighted)
    opened = influence.trace[influence.touching].T @ influence.near
    opened = sum_over_ranks(influence.comm, opened)
    known = weighted.T @ opened
    known = (known + known.T) / 2
    details = basis - influence.basis @ influence.projected(basis)
    signs = np.random.default_rng(0).choice([-1.0, 1.0], basis.shape[1])
    probe = details @ signs
    found = elastic_opening(probe)
    found = found - opened @ np.linalg.solve(known, weighted.T @ found)
    weights, sizes = contacts.weights, np.empty(len(probe))
    softness = np.empty(len(probe))
    for pairing, own in contacts:
        side = pairing.carrying
        sizes[own] = side.face.lengths[side.facet]  # of the carrying facets at the points
        probed = weights[own] * probe[own]
        softness[own] = (probed @ found[own]) / (probed * probe[own] @ sizes[own])
    mixed = (weights[:, None] * basis).T @ opened
    local = (softness * sizes * weights)[:, None] * details
    result = mixed @ np.linalg.solve(known, mixed.T) + details.T @ local
    return (result + result.T) / 2

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
from scipy.sparse import linalg

from ...parallel import sum_over_ranks
from ..operators.condensation import Influence
from ..operators.pressure import Basis, dense, pressure_basis
from ..operators.rigid_motion import RigidHolder
from ..search.contacts import Contacts
from .signorini import solve_contact

_ZERO_PRESSURE = 1e-9
"""Coefficients below this fraction of the largest one are open."""
_TOLERANCE, _ITERATIONS = 1e-2, 60
"""Relative residual and largest number of iterations of the linearised contact."""


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
    basis = dense(_enriched_basis(contacts, degrees))
    weighted = contacts.weights[:, None] * basis
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


def linearised_pressure(
    contacts: Contacts,
    influence: Influence,
    degrees: Sequence[int],
    holder: RigidHolder,
    pressure: np.ndarray,
    gap: np.ndarray,
    local: np.ndarray,
    elastic_opening: Callable[[np.ndarray], np.ndarray],
) -> np.ndarray:
    """Approximate `enriched_pressure` of many points; the contact set is kept.

    The change in Ψ follows from products with the known response, by iteration; that of the details
    from their local compliance. Parameters and result as in `enriched_pressure`.
    """
    weighted, basis = influence.weighted, influence.basis
    levelled = _projection(weighted, basis)
    coefficients = levelled(pressure)
    active = np.flatnonzero(coefficients > _ZERO_PRESSURE * coefficients.max())
    modes = weighted.T @ holder.modes
    force_modes = weighted.T @ holder.force_modes
    count, functions = len(active), basis.shape[1]

    def opened(change: np.ndarray) -> np.ndarray:
        every = np.zeros(functions)
        every[active] = change
        bodies = influence.trace[influence.touching].T @ (influence.near @ every)
        return sum_over_ranks(influence.comm, bodies) + local * (basis @ every)

    def product(unknowns: np.ndarray) -> np.ndarray:
        change, motion = unknowns[:count], unknowns[count:] * scale
        weak = weighted.T @ opened(change) - modes @ motion
        return np.concatenate([weak[active], force_modes[active].T @ change * scale])

    opening = float(np.linalg.norm(weighted.T @ opened(coefficients[active])))
    closed = float(np.linalg.norm(modes) * np.linalg.norm(coefficients))
    scale = opening / (closed or 1.0)  # columns of equal size
    operator = linalg.LinearOperator((count + modes.shape[1],) * 2, matvec=product)
    loads = np.concatenate([-(weighted.T @ gap)[active], np.zeros(modes.shape[1])])
    found, _ = linalg.gmres(operator, loads, rtol=_TOLERANCE, restart=_ITERATIONS, maxiter=1)
    left = gap + opened(found[:count]) - holder.modes @ (found[count:] * scale)
    left = left - basis @ levelled(left)

    finer = sp.csr_array(_enriched_basis(contacts, degrees))
    weighted_finer = (sp.diags_array(contacts.weights) @ finer).tocsr()
    signs = np.random.default_rng(0).choice([-1.0, 1.0], finer.shape[1])
    probe = finer @ signs
    probe = probe - basis @ levelled(probe)
    answer = elastic_opening(probe)
    softness = _softness(contacts, probe, answer - basis @ levelled(answer))
    details = finer @ _projection(weighted_finer, finer)(-left / (softness + local))
    change = np.zeros(functions)
    change[active] = found[:count]
    enriched = np.maximum(pressure + basis @ change + details, 0.0)
    return np.where(pressure > 0.0, enriched, 0.0)


def _projection(weighted: Basis, basis: Basis) -> Callable[[np.ndarray], np.ndarray]:
    """Coefficients of the L² projection of values at the points on a basis."""
    mass = linalg.splu(sp.csc_matrix(weighted.T @ basis))
    return lambda values: mass.solve(weighted.T @ values)


def _enriched_basis(contacts: Contacts, degrees: Sequence[int]) -> sp.csr_array:
    """Basis Ψ⁺ at the points of all interfaces."""
    finer = [pressure_basis(*each) for each in zip(contacts.each, degrees, strict=True)]
    return sp.csr_array(sp.block_diag(finer, format="csr"))


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
    weights = contacts.weights
    mixed = (weights[:, None] * basis).T @ opened
    local = (_softness(contacts, probe, found) * weights)[:, None] * details
    result = mixed @ np.linalg.solve(known, mixed.T) + details.T @ local
    return (result + result.T) / 2


def _softness(contacts: Contacts, probe: np.ndarray, opened: np.ndarray) -> np.ndarray:
    """Local compliance of details, in proportion to the facet, from one answer, (n,) [m/Pa]."""
    weights, softness = contacts.weights, np.empty(len(probe))
    for pairing, own in contacts:
        side = pairing.carrying
        sizes = side.face.lengths[side.facet]  # of the carrying facets at the points
        probed = weights[own] * probe[own]
        softness[own] = (probed @ opened[own]) / (probed * probe[own] @ sizes) * sizes
    return softness

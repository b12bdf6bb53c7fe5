"""Pressure in an enriched pressure space, for a hierarchical error estimate.

The enriched space Ψ⁺ has the next degree. The response to Ψ is known at every contact point; of the
compliance of Ψ⁺ only the block of the details is missing, of the pressures orthogonal to Ψ. These
have short wavelengths, and the response to them is local, with a compliance proportional to the
facet size; one solution gives the constant.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.sparse import linalg

from ...parallel import sum_over_ranks
from ..operators.condensation import Influence
from ..operators.pressure import Basis, dense, pressure_basis
from ..operators.rigid_motion import RigidHolder
from ..search.pairing import Contacts
from .signorini import solve_contact

_ZERO_PRESSURE = 1e-9
"""Coefficients below this fraction of the largest one are open."""
_TOLERANCE, _ITERATIONS = 1e-2, 60
"""Relative residual and largest number of iterations of the linearised contact."""


@dataclass(frozen=True)
class EnrichedContact:
    """Contact in the pressure space of the next degree, linearised at a known solution.

    Attributes
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
    """

    contacts: Contacts
    influence: Influence
    degrees: Sequence[int]
    holder: RigidHolder
    pressure: np.ndarray
    gap: np.ndarray
    local: np.ndarray
    elastic_opening: Callable[[np.ndarray], np.ndarray]

    def solved(self) -> np.ndarray:
        """Pressure at the points, shape (n,) [Pa].

        Raises
        ------
        ComputationError
            If there is no solution.
        """
        basis, weights = self._basis, self.contacts.weights
        weighted = (sp.diags_array(weights) @ basis).tocsr()
        compliance = self._compliance(basis) + _within(basis, self.local * weights)
        mass = dense(weighted.T @ basis)  # singular where a function has no points
        start = np.linalg.lstsq(mass, weighted.T @ self.pressure)[0]
        force_modes = weighted.T @ self.holder.force_modes
        solution = solve_contact(
            compliance,
            weighted.T @ self.gap - compliance @ start,
            weighted.T @ self.holder.modes,
            force_modes.T @ start,
            force_modes=force_modes,
        )
        return basis @ solution.coefficients

    def linearised(self) -> np.ndarray:
        """Approximation of `solved` for many points; the contact set is kept.

        The change in Ψ follows from products with the known response, by iteration; that of the
        details from their local compliance.
        """
        influence, gap, local = self.influence, self.gap, self.local
        weighted, basis = influence.weighted, influence.basis
        levelled = _projection(weighted, basis)
        coefficients = levelled(self.pressure)
        active = np.flatnonzero(coefficients > _ZERO_PRESSURE * coefficients.max())
        modes = weighted.T @ self.holder.modes
        force_modes = weighted.T @ self.holder.force_modes
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

        def detailed(values: np.ndarray) -> np.ndarray:
            return values - basis @ levelled(values)

        opening = float(np.linalg.norm(weighted.T @ opened(coefficients[active])))
        closed = float(np.linalg.norm(modes) * np.linalg.norm(coefficients))
        scale = opening / (closed or 1.0)  # columns of equal size
        operator = linalg.LinearOperator((count + modes.shape[1],) * 2, matvec=product)
        loads = np.concatenate([-(weighted.T @ gap)[active], np.zeros(modes.shape[1])])
        found, _ = linalg.gmres(operator, loads, rtol=_TOLERANCE, restart=_ITERATIONS, maxiter=1)
        left = gap + opened(found[:count]) - self.holder.modes @ (found[count:] * scale)
        left = detailed(left)

        finer = self._basis
        softness = self._softness(detailed(finer @ _signs(finer)), detailed)
        weighted_finer = (sp.diags_array(self.contacts.weights) @ finer).tocsr()
        details = finer @ _projection(weighted_finer, finer)(-left / (softness + local))
        change = np.zeros(functions)
        change[active] = found[:count]
        enriched = np.maximum(self.pressure + basis @ change + details, 0.0)
        return np.where(self.pressure > 0.0, enriched, 0.0)

    @cached_property
    def _basis(self) -> sp.csr_array:
        """Basis Ψ⁺ at the points of all interfaces."""
        each = zip(self.contacts.each, self.degrees, strict=True)
        return sp.csr_array(sp.block_diag([pressure_basis(*one) for one in each], format="csr"))

    def _compliance(self, basis: sp.csr_array) -> np.ndarray:
        """Compliance of the enriched basis: elastic response to Ψ, local for the details."""
        influence, weights = self.influence, self.contacts.weights
        weighted, known_basis = sp.csr_array(influence.weighted), sp.csr_array(influence.basis)
        opened = influence.trace[influence.touching].T @ influence.near
        opened = sum_over_ranks(influence.comm, opened)
        known = weighted.T @ opened
        known = (known + known.T) / 2
        levels = np.linalg.solve(influence.mass, dense(weighted.T @ basis))
        signs = _signs(basis)
        softness = self._softness(
            basis @ signs - known_basis @ (levels @ signs),
            lambda values: values - opened @ np.linalg.solve(known, weighted.T @ values),
        )
        mixed = (sp.diags_array(weights) @ basis).T @ opened
        result = mixed @ np.linalg.solve(known, mixed.T)
        local = softness * weights  # of the details, basis - known_basis @ levels
        crossed = (basis.T @ (sp.diags_array(local) @ known_basis)) @ levels
        result += _within(basis, local) - crossed - crossed.T
        result += levels.T @ _within(known_basis, local) @ levels
        return (result + result.T) / 2

    def _softness(
        self, probe: np.ndarray, detailed: Callable[[np.ndarray], np.ndarray]
    ) -> np.ndarray:
        """Local compliance of details, in proportion to the facet, shape (n,) [m/Pa].

        From the details of the gap that one pressure of details opens.
        """
        opened, softness = detailed(self.elastic_opening(probe)), np.empty(len(probe))
        for pairing, own in self.contacts:
            side = pairing.carrying
            sizes = side.face.lengths[side.facet]  # of the carrying facets at the points
            probed = pairing.weights * probe[own]
            softness[own] = (probed @ opened[own]) / (probed * probe[own] @ sizes) * sizes
        return softness


def _within(basis: sp.csr_array, values: np.ndarray) -> np.ndarray:
    """Matrix Ψᵀ diag(values) Ψ, dense."""
    return (basis.T @ (sp.diags_array(values) @ basis)).toarray()


def _signs(basis: Basis) -> np.ndarray:
    """Random signs of the functions of a basis, the same each time."""
    return np.random.default_rng(0).choice([-1.0, 1.0], basis.shape[1])


def _projection(weighted: Basis, basis: Basis) -> Callable[[np.ndarray], np.ndarray]:
    """Coefficients of the L² projection of values at the points on a basis."""
    mass = linalg.splu(sp.csc_matrix(weighted.T @ basis))
    return lambda values: mass.solve(weighted.T @ values)

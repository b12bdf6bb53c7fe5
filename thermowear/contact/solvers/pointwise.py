"""Contact at each point: pressures resolved within the elements.

Weak contact (`signorini`) has pressures of the space Ψ, whose functions press as a whole or not at
all. Where an edge of the contact crosses an element, the outermost functions that press carry too
little, and their neighbours too much. Here the conditions hold at each point::

    p >= 0,   g + C c - R d + s p + ε (p - Ψ c) >= 0,   complementary,
    Ψᵀ w (p - Ψ c) = 0,   Tᵀ w p = F

The projection Ψ c of the pressure loads the bodies: C = B K⁻¹ Bᵀ w Ψ is their deflection at the
points. The remainder p - Ψ c has shorter wavelengths than Ψ; the response to it is about that to
the shortest wave of Ψ, with the compliance ε, as in `contact.wear.wear_edge`. s is a local
compliance. Solved for the pressure,

    p = max(0, ε Ψ c - g - C c + R d) / (ε + s),

so that only c and d are unknown. The augmented Lagrangian method (Alart and Curnier, Comput.
Methods Appl. Mech. Eng. 92 (1991) 353) solves equations of this form, with a free parameter 1/ε.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ...errors import ComputationError
from ...parallel import sum_over_ranks
from ..operators.condensation import CondensedContact, Influence
from ..operators.rigid_motion import RigidHolder
from ..wear.wear_edge import shortest_compliance

_MAX_ITERATIONS = 40
_ROUNDING = 1e-10
"""Overlap of a point that counts as none, relative to the largest one."""
_FEW = 0.2
"""Largest fraction of the points whose changes update the deflection instead of a new sum."""


@dataclass(frozen=True)
class PointwiseSolution:
    """Pressure at the points, its projection, and the motion of the holder.

    Attributes
    ----------
    pressure : ndarray, shape (n,) [Pa]
    coefficients : ndarray, shape (m,)
        c: coefficients of the projection in Ψ, not necessarily positive [Pa].
    motion : ndarray, shape (k,)
    """

    pressure: np.ndarray
    coefficients: np.ndarray
    motion: np.ndarray


class PointwiseContact:
    """Contact at each point for any gaps and loads; every rank calls.

    Parameters
    ----------
    influence : Influence
        Response of the bodies to Ψ.
    contact : CondensedContact
        The same bodies condensed, without friction in the section.
    holder : RigidHolder
    """

    def __init__(self, influence: Influence, contact: CondensedContact, holder: RigidHolder):
        self._comm, self._near = influence.comm, influence.near
        self._trace = influence.trace[influence.touching].tocsc()
        self._basis, self._mass = sp.csr_array(contact.basis), contact.mass
        self._softness = shortest_compliance(contact)
        self._modes = holder.modes
        weights = np.asarray(contact.weighted.sum(axis=1)).ravel()
        tested = sp.hstack([self._basis, sp.csr_array(holder.force_modes)], format="csr")
        self._tested = sp.csr_array(sp.diags_array(weights) @ tested)
        self._summed: tuple[np.ndarray, np.ndarray] = (
            np.zeros(len(weights)),
            np.zeros((tested.shape[1], len(self._mass))),
        )

    def solve(
        self,
        gap: np.ndarray,
        compliance: np.ndarray,
        load: np.ndarray,
        coefficients: np.ndarray,
        motion: np.ndarray,
    ) -> PointwiseSolution:
        """Solve by Newton's method, which ends when no point opens or closes.

        Parameters
        ----------
        gap : ndarray, shape (n,)
            Gap g [m].
        compliance : ndarray, shape (n,)
            Local compliance s [m/Pa].
        load : ndarray, shape (k,)
            Load F.
        coefficients, motion : ndarray, shape (m,), (k,)
            First guess: the weak solution.

        Raises
        ------
        ComputationError
            If the points that press do not settle.
        """
        yielding = self._softness + compliance
        count, unit = len(coefficients), float(self._softness.mean())
        pressing: np.ndarray = np.zeros(0, dtype=bool)
        # relative to the guess: a far approach would lose the digits of the deflection
        origin, motion = motion, np.zeros(len(motion))
        gap = gap - self._modes @ origin
        for _ in range(_MAX_ITERATIONS):
            overlap = self._overlap(gap, coefficients, motion)
            before, pressing = pressing, overlap > 0.0
            pressure = np.where(pressing, overlap, 0.0) / yielding
            if len(before):
                changed = np.abs(overlap[before != pressing]).max(initial=0.0)
                if changed <= _ROUNDING * np.abs(overlap[pressing]).max(initial=0.0):
                    return PointwiseSolution(pressure, coefficients, origin + motion)
            known = np.concatenate([self._mass @ coefficients, load])
            matrix = self._matrix(pressing / yielding, unit)
            try:
                step = np.linalg.solve(matrix, self._tested.T @ pressure - known)
            except np.linalg.LinAlgError:
                break
            coefficients = coefficients + step[:count]
            motion = motion + unit * step[count:]
        raise ComputationError(
            "contact: the points that press did not settle; use contact.method = "
            '"condensed", or a finer mesh'
        )

    def _overlap(self, gap: np.ndarray, coefficients: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """Overlap ``ε Ψ c - g - C c + R d`` of faces without the remainder, shape (n,) [m]."""
        opened = sum_over_ranks(self._comm, self._trace.T @ (self._near @ coefficients))
        return self._softness * (self._basis @ coefficients) - gap - opened + self._modes @ motion

    def _matrix(self, factors: np.ndarray, unit: float) -> np.ndarray:
        """Derivative of the residual by c and by d in units (m/Pa), for factors of the overlap."""
        count = len(self._mass)
        result = np.zeros((self._tested.shape[1],) * 2)
        result[:count, :count] = self._mass
        loaded = self._tested.T @ sp.diags_array(factors)
        own = loaded @ (sp.diags_array(self._softness) @ self._basis)
        result[:, :count] += self._deflection(factors) - own.toarray()
        result[:, count:] -= unit * (loaded @ self._modes)
        return result

    def _deflection(self, factors: np.ndarray) -> np.ndarray:
        """Weak deflection ``[Ψ T]ᵀ w diag(factors) C``; only what changed since is computed."""
        change = factors - self._summed[0]
        changed = np.flatnonzero(change)
        summed = self._summed[1]
        if len(changed) > _FEW * len(factors):
            change, changed, summed = factors, np.flatnonzero(factors), np.zeros_like(summed)
        loads = sp.diags_array(change[changed]) @ self._tested[changed]
        found = (self._trace[:, changed] @ loads).T @ self._near
        summed = summed + sum_over_ranks(self._comm, found)
        self._summed = factors, summed
        return summed

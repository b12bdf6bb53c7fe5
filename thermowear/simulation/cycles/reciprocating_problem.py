"""Cycle-averaged contact and wear in reciprocating sliding.

The wear of one cycle is small, so that depths are constant during a cycle. Body 1 loses W1 at its
points x, body 2 loses W2 at its points ξ. At each position X_j the contact has the gap

    g0 + W1(x) + W2(x + X_j) + C_j p_j - R d_j,

and the rates, averaged over the cycle with time shares c_j, follow from the local speeds v_j::

    W1'(x) = Σ_j c_j κ1 p_j(x)^b |v_j|^a,      W2'(ξ) = Σ_j c_j κ2 p_j(ξ - X_j)^b |v_j|^a

W1 has coefficients in the pressure basis, like fretting wear; for W2 see `contact.wear.track`.

Steady state. Steady pressures need ``W1'(x) + W2'(x + X) = V(X)`` wherever the faces touch, V being
the approach rate of a holder that does not rotate. The derivative along x gives
``W1''(x) = -W2''(x + X)`` for all X, so that both slopes are opposite constants, which vanish for a
symmetric stroke. Both rates are then uniform for any pressures, and for ``a = b = 1`` the load
determines them: with the mean speed v, the half-width h and the thickness t of body 1, and the
amplitude A, ``W1' = κ1 F v / (2 h t)`` and ``W2' = κ2 F v / (2 (h + A) t)``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...contact.solvers.coupled_positions import CoupledSolution, solve_coupled
from ...contact.solvers.signorini import solve_contact
from ...contact.wear.implicit_step import Slope, newton_with_wear
from ...contact.wear.track import StrokeGrid, track
from ...errors import ComputationError
from ...laws.interfaces import Law, LocalState
from ..interface.contact_solver import ContactSolution
from ..interface.sdirk import InterfaceState, WearProblem
from ..system.system import System
from .stroke import Position, condensed, stroke_distribution

_INNER = 0.9  # part of the faces that the distance from the steady state covers, without their ends


class ReciprocatingProblem(WearProblem):
    """Contact in all positions of the stroke, coupled by the worn depths.

    Depths form one row of N values: coefficients of body 1, then nodal values of body 2.
    Pressures have one row per position, shape (J, m).

    Attributes
    ----------
    track : StrokeGrid
        Grid of the depths of body 2.
    areas : tuple of ndarray, shape (m,) and (n_nodes,)
        Areas of the depth values of body 1 and of body 2 [m²].
    """

    track: StrokeGrid
    areas: tuple[np.ndarray, np.ndarray]

    def __init__(self, system: System, stroke: list[Position]):
        self._systems = [position.system for position in stroke]
        self._holder = system.holder
        speeds = np.array([[position.speed] for position in stroke])
        self._local = _LocalWear(
            tuple(system.laws.values()), speeds, system.model.interface.nominal_friction
        )
        pairings = [there.pairing for there in self._systems]
        lengths = [position.length for position in stroke]
        self._length = float(system.contacts.position[-1])
        # resolution is limited by the parts of the stroke and by the pressure basis
        spacing = max(float(np.mean(lengths)), self._length / system.basis.shape[1])
        self.track = track(pairings, lengths, spacing, system.model.thickness or 1.0)
        self._contacts = condensed(stroke, self.track)
        self._shares = np.array([position.share for position in stroke])
        weighted = system.contact.weighted
        self.areas = weighted.sum(axis=0), self.track.areas
        self._places = (system.contacts.position @ weighted) / self.areas[0], self.track.position
        self._spread = stroke_distribution(self._contacts, self.track, self._shares)[
            list(system.laws)
        ]

    def split(self, depths: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients of body 1, shape (m,), and values at the nodes of body 2."""
        m = self._contacts.gap.shape[1]
        return depths[0, :m], depths[0, m:]

    def start(self) -> InterfaceState:
        """Contact of the unworn faces in all positions."""
        all_of = self._contacts
        each = zip(all_of.compliance, all_of.gap, all_of.modes, all_of.force_modes, strict=True)
        found = [
            solve_contact(compliance, gap, modes, all_of.load, force_modes=force_modes)
            for compliance, gap, modes, force_modes in each
        ]
        λ, motion, active = (
            np.array([getattr(solution, name) for solution in found])
            for name in ("coefficients", "motion", "active")
        )
        zeros = np.zeros(all_of.gap_per_depth.shape[2])
        contact = self._contact(CoupledSolution(λ, motion, active, zeros))
        return InterfaceState(np.zeros_like(self.rates(contact.pressure)), contact)

    def rates(self, pressure: np.ndarray) -> np.ndarray:
        """Wear rates of all depths, averaged over the cycle, shape (1, N) [m/s].

        Parameters
        ----------
        pressure : ndarray, shape (J, m)
            Coefficients [Pa].
        """
        return np.einsum("bjnm,bjm->n", self._spread, self._local.value(pressure))[None]

    def of_cycle(self, contact: ContactSolution) -> tuple[float, float, np.ndarray]:
        """Largest pressure over all positions [Pa], mean contact area [m²] and mean motion."""
        areas, largest = [], 0.0
        for system, λ in zip(self._systems, contact.pressure, strict=True):
            p = system.basis @ λ
            areas.append(system.weights[p > 0].sum())
            largest = max(largest, float(p.max()))
        return largest, float(self._shares @ areas), self._shares @ contact.motion

    def first_step(self, state: InterfaceState) -> float:
        """Step in which wear is small compared with the elastic deflection of the bodies [s]."""
        opened = np.einsum("jmn,jn->jm", self._contacts.compliance, state.pressure)
        fastest = float(self.rates(state.pressure).max())
        return 1e-3 * float((opened / self.areas[0]).max()) / fastest if fastest > 0.0 else np.inf

    def distance(self, state: InterfaceState, steady) -> float:
        """Nonuniformity of the wear rates, which are uniform along both faces in the steady state.

        Largest relative deviation from the mean, excluding the ends of the faces: at the turning
        points the punch corner carries half the load, which no mesh resolves.
        """
        parts = zip(self.split(self.rates(state.pressure)), self._places, strict=True)
        return max(_unevenness(rate, place) for rate, place in parts if rate.any())

    def stage(
        self,
        before: InterfaceState,
        step: float,
        time: float,
        guess: InterfaceState,
        last: bool = True,
    ) -> InterfaceState:
        """End of an implicit Euler step of wear."""
        contact = self._solve(before.worn[0], step, guess.contact)
        return replace(
            before, worn=before.worn + step * self.rates(contact.pressure), contact=contact
        )

    def _solve(self, worn: np.ndarray, step: float, guess: ContactSolution) -> ContactSolution:
        """Contact at the end of a step.

        Parameters
        ----------
        worn : ndarray, shape (N,)
            Depths before the step [m].
        step : float
            [s]
        guess : ContactSolution

        Raises
        ------
        ComputationError
        """
        if worn.max() > self._length:
            raise ComputationError(
                "wear: the worn depth exceeds the length of the contact; to reach the steady "
                "state, use more elements or a larger analysis.steady_tolerance"
            )

        def solve(start: np.ndarray, slope: Slope, last: ContactSolution) -> ContactSolution:
            gains = step * np.einsum("bjnm,bjm->jnm", self._spread, slope.point)
            depths = worn + step * np.einsum("bjnm,bjm->n", self._spread, start)
            return self._contact(
                solve_coupled(self._contacts, depths, gains, last.warm_start.active)
            )

        return newton_with_wear(solve, self._local, guess)

    def _contact(self, solution: CoupledSolution) -> ContactSolution:
        motion = np.array([self._holder.amplitudes(d) for d in solution.motion])
        return ContactSolution(np.maximum(solution.coefficients, 0.0), motion, solution)


@dataclass(frozen=True)
class _LocalWear:
    """Local wear rates in all positions, see `contact.wear.implicit_step`.

    Attributes
    ----------
    laws : tuple of Law
        Wear laws of the wearing bodies.
    speeds : ndarray, shape (J, 1) [m/s]
    friction : float
    """

    laws: tuple[Law, ...]
    speeds: np.ndarray
    friction: float

    def value(self, pressure: np.ndarray, last: object = None) -> np.ndarray:
        """Local rates under coefficients of the pressure (J, m), shape (n_wearing, J, m) [m/s]."""
        return self._each(pressure, [law.value for law in self.laws])

    def slope(self, pressure: np.ndarray, last: object = None) -> Slope:
        """Derivatives of the local rates with respect to pressure [m/s/Pa]."""
        return Slope.diagonal(self._each(pressure, [law.slope for law in self.laws]))

    def _each(self, pressure: np.ndarray, functions) -> np.ndarray:
        at = LocalState(pressure, self.speeds, mu=self.friction)
        return np.array([of_law(at) for of_law in functions])


def _unevenness(rate: np.ndarray, place: np.ndarray) -> float:
    inner = np.abs(place - (place[0] + place[-1]) / 2) <= _INNER * (place[-1] - place[0]) / 2
    return float(np.abs(rate[inner] / rate[inner].mean() - 1).max())

"""Contact solvers on the condensed interface: with a pressure space, and at each point."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Protocol

import numpy as np

from ...contact.operators.condensation import CondensedContact
from ...contact.solvers.pointwise import PointwiseContact
from ...contact.solvers.signorini import (
    NoEquilibrium,
    SaddleFactors,
    SignoriniSolution,
    critical_factor,
    solve_contact,
)
from ...contact.wear.implicit_step import Slope, WearRates, newton_with_wear
from ...contact.wear.wear_edge import EdgeSpace, edge_space
from ...errors import CaseError, ComputationError
from ...serialise import serialisable
from ..heat.friction_heat import AnyHeat
from ..system.conditions import InterfaceConditions, parted_by_fluid
from ..system.system import System


@serialisable
@dataclass(frozen=True)
class ContactSolution:
    """Solution of a contact problem.

    Attributes
    ----------
    pressure : ndarray, shape (n,) [Pa]
    motion : ndarray, shape (n_modes,)
        Amount of each rigid mode of the holder [m or rad].
    warm_start : object
        Solution to start the solver from.
    apart : ndarray or None, shape (n,)
        Gap of the points with pointwise contact: 0 where they press, NaN at other points; None
        without such points [m].
    """

    pressure: np.ndarray
    motion: np.ndarray
    warm_start: Any
    apart: np.ndarray | None = None


class ContactSolver(Protocol):
    """Solver of contact under given loads: condensed, or on the full system."""

    def solve(
        self,
        gap: np.ndarray,
        slope: Slope,
        guess: ContactSolution | None,
        conditions: InterfaceConditions,
        heat: AnyHeat | None,
        pointwise: np.ndarray | None = None,
    ) -> ContactSolution:
        """Solve contact of bodies with friction heat and a local compliance.

        Parameters
        ----------
        gap : ndarray, shape (n,)
            Gap without pressure, heat and motion of the holder [m].
        slope : Slope
            Gap per pressure in addition to the deflection of the bodies [m/Pa].
        guess : ContactSolution or None
        conditions : InterfaceConditions
        heat : AnyHeat or None
        pointwise : ndarray of bool, shape (n,), optional
            Points at the edge of the wear with pointwise contact, see `contact.wear.wear_edge`.

        Raises
        ------
        ComputationError
        """

    def point_compliance(self, points: np.ndarray) -> np.ndarray:
        """Deflection per pressure of a single point, NaN at other points, shape (n,) [m/Pa].

        Parameters
        ----------
        points : ndarray of bool, shape (n,)
            From `InterfaceProblem.begin`.
        """

    def steady(
        self,
        pressure: np.ndarray,
        rates: WearRates,
        conditions: InterfaceConditions,
        pointwise: np.ndarray | None = None,
    ) -> np.ndarray:
        """Steady pressure in the discretisation of the solver, from that of the principle [Pa].

        Parameters
        ----------
        pressure : ndarray, shape (n,) [Pa]
        rates : WearRates
        conditions : InterfaceConditions
            Conditions in the steady state.
        pointwise : ndarray of bool, shape (n,), optional
            Points with pointwise contact.
        """

    def largest_deflection(self, contact: ContactSolution) -> float:
        """Largest change of the gap by elastic deflection [m]."""

    def deflection_range(self, contact: ContactSolution) -> float:
        """Range of the elastic deflection over the contact area [m]."""


_ITERATIONS = 60
_FIRST_PART, _LEAST_PART = 1 / 8, 1 / 256
"""First and smallest step of the thermal distortion in a continuation."""
_KEPT = 8
"""Number of compliances and factors kept: of the stages of a step and its halves."""
_CRITICAL = (
    "the speed is beyond the critical sliding speed of this contact{} (thermoelastic instability): "
    "reduce the speed, the expansion or the friction"
)
_SMALL = (
    "the speed is not beyond a critical sliding speed of this contact zone; its elements may be "
    "too large where heat makes it smaller: refine the mesh at the contact"
)
_LOCKED = (
    "friction along the faces locks body 1 or tips it over an edge: lower contact.friction, "
    "reverse the motion, or change the line of the load or the free motions of the holder"
)
_TIPPED = (
    "the load lifts body 1 off or tips it over an edge: change the line of the load or the free "
    "motions of the holder"
)


class _Unstable(NoEquilibrium):
    """Error: small perturbations would leave an equilibrium."""


class RecentSums:
    """Sums of matrices; the last are cached.

    The stages of a step of wear share their compliances, and so the factors of them.
    """

    def __init__(self) -> None:
        self._known: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []

    def of(self, first: np.ndarray, second: np.ndarray) -> np.ndarray:
        """Sum of two matrices."""
        for one, two, total in self._known:
            if one is first and two is second:
                return total
        total = first + second
        self._known = [*self._known[1 - _KEPT :], (first, second, total)]
        return total


class CondensedMethod:
    """Weak contact conditions in the pressure space.

    At the edge of the wear they hold pointwise, see `contact.wear.wear_edge`.
    """

    def __init__(self, system: System):
        self._system = system
        self._contact = system.contact
        self._last_friction = (system.friction.tobytes(), self._contact)
        self._dead = system.gap - system.contacts.gap
        self._free = system.holder.free
        self._given = system.holder.amplitudes(np.zeros(int(self._free.sum())))
        self._last_space: tuple[CondensedContact, np.ndarray, EdgeSpace] | None = None
        self._sums, self._factors = RecentSums(), SaddleFactors(_KEPT)
        self._last_opening: tuple[CondensedContact | EdgeSpace, np.ndarray, np.ndarray] | None = (
            None
        )

    def solve(
        self, gap, slope, guess: ContactSolution | None, conditions, heat, pointwise=None
    ) -> ContactSolution:
        try:
            return self._balanced(gap, slope, guess, conditions, heat, pointwise)
        except NoEquilibrium as error:
            cause = _LOCKED if conditions.friction.any() else _TIPPED
            if isinstance(error, _Unstable):
                cause = _CRITICAL.format("")
            elif heat is not None:
                cause = self._hot_cause(gap, conditions, heat, cause)
            parted = parted_by_fluid(self._system, conditions.load)
            raise parted or ComputationError(f"{error}; {cause}") from None

    def _hot_cause(self, gap, conditions, heat, cold_cause: str) -> str:
        """Cause of a contact without equilibrium, by the stability of its zone without heat.

        That of the contact without heat if it has none either.
        """
        bodies, compliance = self._contact, self._contact.compliance
        thermal, opening = heat.coupling(conditions, bodies.basis)
        weak = bodies.weighted.T @ (gap + self._dead) + opening
        try:
            cold = solve_contact(
                compliance,
                weak,
                bodies.modes,
                conditions.load,
                force_modes=bodies.force_modes,
            )
            factor = critical_factor(compliance, thermal, bodies.modes, cold.active)
        except NoEquilibrium:
            return cold_cause
        except np.linalg.LinAlgError:
            return _SMALL
        return _CRITICAL.format(f", {1 / factor:.3g} times it") if factor < 1.0 else _SMALL

    def _balanced(
        self, gap, slope, guess: ContactSolution | None, conditions, heat, pointwise
    ) -> ContactSolution:
        bodies, load = self._with_friction(conditions.friction), conditions.load
        edge = self._space(bodies, pointwise)
        gap, compliance = gap + self._dead, bodies.compliance
        if heat is None:
            thermal_gap = np.zeros(len(compliance))
            return self._solved(bodies, edge, compliance, thermal_gap, gap, slope, guess, load)
        for _ in range(_ITERATIONS):
            thermal, opening = heat.coupling(conditions, bodies.basis)
            solved = partial(self._solved, bodies, edge, slope=slope, gap=gap, load=load)
            try:
                both = self._sums.of(compliance, thermal)
                guess = solved(both, opening, guess=guess)
            except NoEquilibrium:
                guess = self._with_growing_heat(solved, compliance, thermal, opening)
            if heat.converged(conditions, guess.pressure):
                return guess
        raise ComputationError(
            "contact: the iteration for pressure and temperatures with temperature-dependent "
            "conductivity or expansion did not converge; reduce the speed"
        )

    def _with_growing_heat(
        self, solved, compliance: np.ndarray, thermal: np.ndarray, opening: np.ndarray
    ) -> ContactSolution:
        """Contact by continuation from bodies without distortion by friction heat.

        Heat shrinks a contact zone, which active sets from full contact, or from another speed, may
        miss; Lemke's method is not sure to end where the compliance is no positive operator. The
        continuation may pass a critical speed: a state that perturbations would leave is refused.
        """
        guess, part, step = solved(compliance, opening, guess=None), 0.0, _FIRST_PART
        while part < 1.0:
            grown = min(part + step, 1.0)
            try:
                guess = solved(compliance + grown * thermal, opening, guess=guess)
            except NoEquilibrium:
                step /= 2
                if step < _LEAST_PART:
                    raise
            else:
                part = grown
        active = guess.warm_start.active
        if critical_factor(compliance, thermal, self._contact.modes, active) < 1.0:
            raise _Unstable("contact: no equilibrium found that small perturbations leave as it is")
        return guess

    def point_compliance(self, points) -> np.ndarray:
        space = self._space(self._contact, points)
        assert space is not None
        return space.at_points(np.diag(space.compliance(self._contact.compliance)))

    def steady(self, pressure, rates: WearRates, conditions, pointwise=None) -> np.ndarray:
        """Steady-state principle in the pressure space.

        The wear rates, weighted by the basis functions, equal the rigid-body wear velocity. That is
        an implicit step of wear of rigid bodies. Contacts at rest keep their pressure, elastically.
        """
        contact, load = self._with_friction(conditions.friction), conditions.load
        coefficients = contact.projected(pressure)
        active = np.ones(len(coefficients), dtype=bool)
        no_motion = np.zeros(contact.modes.shape[1])
        start = ContactSolution(
            pressure, no_motion, SignoriniSolution(coefficients, no_motion, active)
        )
        resting = abs(contact.basis).T @ self._system.at_rest > 0.0
        rigid = np.diag(np.where(resting, np.diag(contact.compliance), 0.0))
        thermal_gap, space = -rigid @ coefficients, self._space(contact, pointwise)
        if space is not None:
            still = np.zeros_like(space.local_compliance)
            space = replace(space, local_compliance=still, **self._divided(space))
        else:
            contact = replace(contact, **self._divided(contact))
        load = np.hstack(self._system.divided_motions).T @ load
        return newton_with_wear(
            lambda worn, slope, last: self._solved(
                contact, space, rigid, thermal_gap, worn, slope, last, load
            ),
            rates,
            start,
        ).pressure

    def _divided(self, space: CondensedContact | EdgeSpace) -> dict[str, np.ndarray]:
        """Modes that wear admits, of the sliding contacts, and others, of contacts at rest."""
        admitted, pressing = self._system.divided_motions
        resting = (abs(space.basis).T @ self._system.at_rest > 0.0)[:, None]
        modes = [~resting * (space.modes @ admitted), resting * (space.modes @ pressing)]
        forces = [~resting * (space.force_modes @ admitted), space.force_modes @ pressing]
        return {"modes": np.hstack(modes), "force_modes": np.hstack(forces)}

    def largest_deflection(self, contact: ContactSolution) -> float:
        return float(self._opened(contact).max())

    def deflection_range(self, contact: ContactSolution) -> float:
        opened = self._opened(contact)[contact.warm_start.active]
        return float(np.ptp(opened)) if opened.size else 0.0

    def _opened(self, contact: ContactSolution) -> np.ndarray:
        """Change of the gap by elastic deflection, means over the basis functions, (m,) [m]."""
        opened = self._contact.compliance @ contact.warm_start.coefficients
        return opened / self._contact.weighted.sum(axis=0)

    def _with_friction(self, friction: np.ndarray) -> CondensedContact:
        """Condensed bodies for coefficients of friction (n,); the last result is cached."""
        key = friction.tobytes()
        if self._last_friction[0] != key:
            self._last_friction = (key, self._system.with_friction(friction).contact)
        return self._last_friction[1]

    def _space(self, bodies: CondensedContact, points: np.ndarray | None) -> EdgeSpace | None:
        """Pressure space with pointwise unknowns at given points, None without any; cached."""
        if points is None:
            return None
        last = self._last_space
        if last is None or last[0] is not bodies or not np.array_equal(last[1], points):
            space = edge_space(bodies, points, self._system.holder)
            last = self._last_space = bodies, points, space
        return last[2]

    def _opening_at_points(
        self, space: CondensedContact | EdgeSpace, slope: np.ndarray
    ) -> np.ndarray:
        """Weak gaps (k, k) per coefficient by a local compliance [m/Pa]; the last are cached."""
        last = self._last_opening
        if last is None or last[0] is not space or not np.array_equal(last[1], slope):
            opening = space.weighted.T @ (space.basis.T * slope).T
            last = self._last_opening = space, slope, opening
        return last[2]

    def _solved(
        self,
        bodies: CondensedContact,
        edge: EdgeSpace | None,
        compliance: np.ndarray,
        thermal_gap: np.ndarray,
        gap: np.ndarray,
        slope: Slope,
        guess: ContactSolution | None,
        load: np.ndarray,
    ) -> ContactSolution:
        """Solve contact for a compliance (m, m) and a weak gap without pressure (m,)."""
        space = bodies if edge is None else edge
        start = None if guess is None else guess.warm_start.active
        if edge is not None:
            compliance, thermal_gap = edge.compliance(compliance), edge.projection.T @ thermal_gap
            start = None if guess is None else edge.pressing(guess.pressure)
        if slope.point.any():
            compliance = self._sums.of(compliance, self._opening_at_points(space, slope.point))
        if len(slope.rows):
            reach = space.weighted.T @ slope.reach
            compliance = compliance + reach @ (slope.rows @ space.basis)
        weak = space.weighted.T @ gap + thermal_gap
        solution = solve_contact(
            compliance, weak, space.modes, load, start, space.force_modes, self._factors
        )
        pressure = space.basis @ solution.coefficients
        apart = None
        if edge is not None:
            left = weak + compliance @ solution.coefficients - space.modes @ solution.motion
            apart = (pressure == 0.0) * edge.at_points(left)
            projected, active = edge.projection @ solution.coefficients, bodies.weak(pressure) > 0.0
            solution = replace(solution, coefficients=projected, active=active)
        motion = self._given.copy()
        motion[self._free] = solution.motion
        return ContactSolution(pressure, motion, solution, apart)


class PointwiseMethod(CondensedMethod):
    """Contact conditions at each point, from the solution of weak contact.

    Without wear, heat and friction in the section.

    Raises
    ------
    CaseError
        If there is one of them.
    """

    def __init__(self, system: System):
        super().__init__(system)
        if system.thermal is not None or system.traction is not system.trace:
            raise CaseError(_ALONE)
        self._points = PointwiseContact(system.influence, system.contact, system.holder)

    def solve(
        self, gap, slope, guess: ContactSolution | None, conditions, heat, pointwise=None
    ) -> ContactSolution:
        wears = len(slope.rows) or np.any(slope.point != self._system.softness)
        if wears or heat is not None or pointwise is not None:
            raise CaseError(_ALONE)
        weak = super().solve(gap, slope, guess, conditions, heat)
        given, start = gap + self._dead, weak.warm_start
        found = self._points.solve(
            given, slope.point, conditions.load, start.coefficients, start.motion
        )
        motion = self._given.copy()
        motion[self._free] = found.motion
        resolved = replace(start, coefficients=found.coefficients, motion=found.motion)
        return ContactSolution(found.pressure, motion, resolved)


_ALONE = 'contact.method: "pointwise" is for contact without wear, heat and friction'

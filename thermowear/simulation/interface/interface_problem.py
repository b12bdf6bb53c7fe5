"""Interface problem: contact, friction heat and an implicit step of wear."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ...contact.wear.edge_times import closing_times
from ...contact.wear.implicit_step import newton_with_wear
from ...contact.wear.wear_edge import WearEdge
from ..heat.friction_heat import FrictionHeat
from ..heat.heat_stages import HeatStage, InitialHeat
from ..heat.heat_states import HeatBalance
from ..model.conditions import ConditionModel, InterfaceConditions
from ..model.system import System
from .body_state import ContactState
from .contact_solver import ContactSolution, ContactSolver, Slope, StepWear, WearRates
from .fixed_point import Trial, self_consistent
from .sdirk import InterfaceState
from .steady import SteadyState

_UNWORN = (
    "contact: neither the touching points nor what depends on temperature and pressure settle; "
    "give the contact a (smaller) heat.conductance, or reduce the speed"
)
_RISE = 0.1
"""Fraction of the rise of the largest pressure in a step that counts as its error."""
_BEHIND = 0.03
"""Delay of the end of a step behind the expected time of reaching a point, relative to the step."""
_SETTLING = 0.4
"""Step after reaching a point, relative to the time in which wear takes up its deflection."""
_STEP = "contact: what depends on temperature or pressure does not settle in a step"


class InterfaceProblem:
    """Contact with heat and wear for given loads.

    Parameters
    ----------
    system : System
    method : ContactSolver
    heat : FrictionHeat or None
    """

    def __init__(self, system: System, method: ContactSolver, heat: FrictionHeat | None):
        self._system = system
        self._method = method
        self._heat = heat
        self._surroundings = ConditionModel(system)
        self._edge = WearEdge(system.pairing.sides[0].facet, system.basis, system.weights)
        self._gap = system.pairing.gap - system.holder.imposed
        self._softness = np.full(len(self._gap), system.softness)
        self._laws, self._spreads = list(system.laws.values()), list(system.spreads.values())
        case = system.case
        self._transient = case.heat is not None and case.heat.transient

    @property
    def stores_heat(self) -> bool:
        """True if conduction is transient."""
        return self._transient

    @property
    def note(self) -> str | None:
        """Warning about the settings of the contact solver; None without one."""
        return self._method.note

    def unworn(self) -> InterfaceState:
        """Contact of the unworn faces with the steady temperatures of its own friction heat.

        The points that exchange heat are found by fixed-point iteration.

        Raises
        ------
        ComputationError
            If the contact set or the state-dependent properties do not converge.
        """
        return self._lasting(self._nothing(), 0.0)

    def _lasting(
        self, worn: np.ndarray, time: float, pointwise: np.ndarray | None = None
    ) -> InterfaceState:
        """Contact of faces with given wear and the steady temperatures of its friction heat."""
        heat = None if self._heat is None else self._heat.steady

        def respond(conditions: InterfaceConditions) -> InterfaceState:
            contact = self._contact(worn, 0.0, conditions, heat, None, pointwise)
            faces = None if heat is None else heat.faces(conditions, contact.pressure)
            return InterfaceState(worn, contact, faces=faces)

        faces = None if heat is None else heat.unheated
        start = Trial(self._guess.pressure, faces, worn)
        return self_consistent(self._surroundings, time, start, respond, _UNWORN)[1]

    def worn(self, depth: np.ndarray, guess: ContactSolution | None = None) -> ContactSolution:
        """Contact of faces with a total wear depth (n,) [m], without heat."""
        conditions = self.conditions(InterfaceState(self._nothing(), self._guess), 0.0)
        return self._contact(depth[None], 0.0, conditions, None, guess)

    def start(self) -> InterfaceState:
        """State of the unworn faces at time 0."""
        if not self._transient:
            return self.unworn()
        assert self._heat is not None
        return self._frozen(self._nothing(), self._heat.frozen, 0.0)

    def take_over(
        self,
        former: InterfaceProblem,
        state: InterfaceState,
        worn: np.ndarray,
        rise: np.ndarray | None,
        time: float,
    ) -> InterfaceState:
        """Transfer a state of the same bodies from before an update of their meshes.

        Parameters
        ----------
        former : InterfaceProblem
            Problem on the former meshes.
        state : InterfaceState
            State of the former problem.
        worn : ndarray, shape (n_wearing, n)
            Transferred wear depths at the points of this problem [m].
        rise : ndarray or None, shape (n_owned,)
            Transferred nodal temperature rise in transient conduction [K].
        time : float
            [s]
        """
        edge, geometry = state.pointwise, self._system.worn
        if edge is not None and (geometry is None or geometry.pieces is None):
            edge = self._edge.points(worn)  # the contact points have changed
        if state.stored is None:
            found = self._lasting(worn, time, edge)
        else:
            assert self._heat is not None
            assert former._heat is not None
            assert rise is not None
            stored = self._heat.take_over(former._heat, state.stored, rise)
            found = self._frozen(worn, self._heat.at_moment(stored), time, edge)
        return replace(found, peak=state.largest, pointwise=edge)

    def _frozen(
        self,
        worn: np.ndarray,
        heat: InitialHeat,
        time: float,
        pointwise: np.ndarray | None = None,
    ) -> InterfaceState:
        """Contact at given temperatures."""
        guess = InterfaceState(worn, self._guess, faces=heat.initial)
        conditions = self.conditions(guess, time)
        contact = self._contact(worn, 0.0, conditions, heat, None, pointwise)
        return replace(guess, contact=contact, stored=heat.stored)

    def begin(self, state: InterfaceState) -> InterfaceState:
        """Choose the points with pointwise contact for the next step.

        None until the edge of the contact is the edge of the wear. At a distance ξ from an edge
        that travels at a speed c the pressure rises as ``ξ^θ``, ``tan πθ = 2 c / (E* k v)``:
        ``2 p / E*`` is the slope of the elastic deflection, ``k v p / c`` that of the wear depth
        (from ``k v p / c + 2 / (π E*) ∫ p(s) / (s - ξ) ds = const``, a singular integral equation;
        Muskhelishvili, Singular Integral Equations, 1953, ch. 12). Without wear θ is 1/2, and p
        falls to zero smoothly; where wear dominates, θ < 1/4, it is nearly a jump. The mean slopes
        are compared, by the ranges of wear depth and deflection over the contact.
        """
        pressed = state.worn.any() and state.contact.memory is not None
        if not pressed:
            return state
        if state.pointwise is None:
            depth = state.worn.sum(axis=0)[state.pressure > 0.0]
            if not depth.size or np.ptp(depth) <= self._method.bending(state.contact):
                return state
        edge = self._edge.points(state.worn, state.pressure, state.pointwise)
        return replace(state, pointwise=edge)

    def stage(
        self, before: InterfaceState, step: float, time: float, guess: InterfaceState
    ) -> InterfaceState:
        """Implicit Euler step of wear, and of heat in transient conduction.

        State-dependent conditions are those at the end of the step, except for the points that
        exchange heat: the contact set of the guess.
        """
        heat, last = self._heat_at_end(before, step, time), guess.contact

        def respond(conditions: InterfaceConditions) -> InterfaceState:
            nonlocal last
            last = self._contact(before.worn, step, conditions, heat, last, before.pointwise)
            faces = None if heat is None else heat.faces(conditions, last.pressure)
            worn = before.worn + step * self._rates(conditions)(last.pressure)
            return InterfaceState(worn, last, before.peak, faces, pointwise=before.pointwise)

        conditions, found = self_consistent(
            self._surroundings, time, guess, respond, _STEP, closed=guess.pressure > 0
        )
        return self._moved_on(before, found, step, conditions, heat)

    def conditions(self, state: InterfaceState, time: float) -> InterfaceConditions:
        """Interface conditions in a state at a time [s]."""
        touching = state.pressure > 0
        return self._surroundings.at(time, state.pressure, state.faces, touching, state.worn)

    def contact_state(self, state: InterfaceState, time: float) -> ContactState:
        """Contact loads of a state on the bodies; every rank calls."""
        conditions, warmth = self.conditions(state, time), None
        if self._heat is not None and state.stored is not None and state.faces is not None:
            warmth = self._heat.momentary(state.stored, state.faces)
        elif self._heat is not None:
            warmth = self._heat.lasting(conditions, state.pressure)
        return ContactState(state.pressure, conditions, warmth)

    def hottest(self, state: InterfaceState) -> float:
        """Highest temperature of both faces [K]; NaN without heat."""
        if self._heat is None or state.faces is None:
            return float("nan")
        return float(np.max(state.faces.rise)) + self._heat.ambient

    def face_temperatures(self, state: InterfaceState) -> tuple[np.ndarray, np.ndarray]:
        """Temperatures of both faces at the points, two arrays of shape (n,) [K]; needs heat."""
        assert self._heat is not None
        assert state.faces is not None
        T1, T2 = state.faces.rise
        return T1 + self._heat.ambient, T2 + self._heat.ambient

    def heat_balance(self, state: InterfaceState) -> HeatBalance:
        """Heat balance since the start in transient conduction; every rank calls."""
        assert self._heat is not None
        assert state.stored is not None
        return self._heat.balance(state.stored)

    def difference(
        self, before: InterfaceState, one: InterfaceState, other: InterfaceState
    ) -> float:
        """Difference of two pressures, the maximum norm where they are continuous in time [Pa].

        A point with pointwise contact begins to press suddenly when the edge of the wear reaches
        it. The maximum norm of the difference of two histories then measures the time of that
        event and does not decrease with the step. The norms that converge are the mean over the
        contact area and the difference of the largest pressures, at any points. A step that
        reaches a point in its last stage wears it too late and loads it too much, possibly alike
        in both histories: a rise of the largest pressure therefore counts as well. If the edge has
        passed beyond its points, the largest pressure itself is returned.
        """
        change = np.abs(one.pressure - other.pressure)
        if one.pointwise is None:
            return float(change.max())
        if self._edge.has_passed(one.pointwise, before.worn, one.worn):
            return float(one.pressure.max())
        pressing = (one.pressure > 0.0) | (other.pressure > 0.0)
        area = float(pressing @ self._system.weights)
        mean = float(change @ self._system.weights) / area if area > 0.0 else 0.0
        largest, expected, earlier = (v.pressure.max() for v in (one, other, before))
        return float(max(mean, abs(largest - expected), _RISE * (largest - earlier)))

    def edge_steps(
        self,
        states: tuple[InterfaceState, InterfaceState, InterfaceState],
        step: float,
        time: float,
    ) -> tuple[float, float]:
        """Step sizes that end right behind a time at which the edge of the wear reaches a point.

        See `WearProblem`. The step after one in which a point has begun to press is short.
        """
        start, middle, end = (state.contact.apart for state in states)
        if start is None or middle is None or end is None:
            return 0.0, np.inf
        times = closing_times(start, middle, end, step)
        reached = float(times[end == 0.0].min(initial=np.inf))
        left = float(times[end > 0.0].min(initial=np.inf)) - step
        following = left + _BEHIND * max(left, step)
        begun = (end == 0.0) & (states[0].pressure == 0.0)
        if begun.any():
            following = min(following, _SETTLING * self._settling(states[2], time, begun))
        return (1 + _BEHIND) * reached if np.isfinite(reached) else 0.0, following

    def _settling(self, state: InterfaceState, time: float, points: np.ndarray) -> float:
        """Shortest time in which wear takes up the elastic deflection under single points [s]."""
        assert state.pointwise is not None
        slope = self._rates(self.conditions(state, time)).slope(state.pressure).point[points]
        yielding = self._method.yielding(state.pointwise)[points]
        return float((yielding[slope > 0.0] / slope[slope > 0.0]).min(initial=np.inf))

    def difference_inside(self, one: InterfaceState, other: InterfaceState) -> float:
        """Largest difference of temperatures inside the bodies [K]; every rank calls."""
        if self._heat is None or one.stored is None or other.stored is None:
            return 0.0
        return self._heat.difference(one.stored, other.stored)

    def memory(self) -> Any:
        """Internal state to restart from beside the last interface state; see `recall`."""
        return None if self._heat is None else self._heat.memory()

    def recall(self, memory: Any) -> None:
        """Restore the internal state from `memory`."""
        if self._heat is not None:
            self._heat.recall(memory)

    def corners(self, end: float) -> tuple[float, ...]:
        """Times up to an end at which a history has a corner [s]."""
        return self._surroundings.corners(end)

    def first_step(self, state: InterfaceState) -> float:
        """Initial step: wear small against elastic deflection, small penetration of heat [s].

        May be infinite.
        """
        conditions = self.conditions(state, 0.0)
        fastest = float(self._rates(conditions)(state.pressure).sum(axis=0).max(initial=0.0))
        step = np.inf
        if fastest > 0.0:
            step = 1e-3 * self._method.opening(state.contact) / fastest
        if self._heat is not None and self._transient:
            made = conditions.heating * state.pressure
            step = min(step, self._heat.first_step(float(made.max())))
        return step

    def steady(self, steady: SteadyState) -> np.ndarray:
        """Steady pressure of the discrete interface, the limit of its running-in [Pa]."""
        conditions = steady.conditions
        return self._method.steady(steady.wear.pressure, self._rates(conditions), conditions)

    def distance(self, state: InterfaceState, steady: np.ndarray | None) -> float:
        """Largest difference to a steady pressure, relative to its maximum; NaN without one."""
        if steady is None:
            return float("nan")
        return float(np.abs(state.pressure - steady).max() / steady.max())

    def _rates(self, conditions: InterfaceConditions) -> WearRates:
        return WearRates(self._laws, self._spreads, conditions)

    def _nothing(self) -> np.ndarray:
        """Zero wear depths, shape (n_wearing, n)."""
        return np.zeros((len(self._laws), len(self._gap)))

    @property
    def _guess(self) -> ContactSolution:
        """Initial guess: the mean pressure, uniform over the face."""
        area = float(self._system.weights.sum())
        pressure = np.full(len(self._gap), (self._system.case.force() or area) / area)
        return ContactSolution(pressure, np.zeros(0), None)

    def _heat_at_end(self, before: InterfaceState, step: float, time: float) -> HeatStage | None:
        if self._heat is None:
            return None
        if before.stored is None:
            return self._heat.steady
        return self._heat.after(before.stored, step, time)

    def _moved_on(self, before, state, step, conditions, heat) -> InterfaceState:
        """State with the wear and heat accumulated in a step."""
        worn = before.worn + step * self._rates(conditions)(state.pressure)
        stored = None
        if before.stored is not None:
            assert self._heat is not None
            made = conditions.heating * state.pressure
            stored = self._heat.stored(before.stored, step, heat, state.faces, made)
        return replace(state, worn=worn, stored=stored)

    def _contact(
        self,
        worn: np.ndarray,
        step: float,
        conditions: InterfaceConditions,
        heat: HeatStage | None,
        guess: ContactSolution | None,
        pointwise: np.ndarray | None = None,
    ) -> ContactSolution:
        """Contact at the end of an implicit step of wear, by Newton's method.

        Each Newton step is a contact problem: pressure-dependent wear adds ``step · ∂rate/∂p`` to
        the compliance of each point.
        """
        gap = self._gap + worn.sum(axis=0)
        if conditions.released:  # the holder stays where it is
            motion = np.zeros(len(self._system.holder.drives)) if guess is None else guess.motion
            return ContactSolution(np.zeros(len(gap)), motion, None)

        def solve(opened, slope, last):
            softer = slope.softer_by(self._softness)
            return self._method.solve(gap + opened, softer, last, conditions, heat, pointwise)

        still = np.zeros(len(gap))
        rigid = Slope.on_the_spot(still)
        if guess is not None and guess.memory is None:
            guess = None
        if step == 0.0 or not self._laws:
            return solve(still, rigid, guess)
        guess = guess or solve(still, rigid, None)
        return newton_with_wear(solve, StepWear(self._rates(conditions), step), guess)

"""The interface alone: contact, friction heat and an implicit step of wear."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ...contact.wear.edge_times import closing_times
from ...contact.wear.wear_edge import WearEdge
from ..heat.friction_heat import FrictionHeat
from ..heat.heat_stages import HeatStage, InitialHeat
from ..heat.heat_states import HeatBalance
from ..model.conditions import ConditionModel, InterfaceConditions
from ..model.system import System
from .body_state import ContactState
from .contact_solver import ContactSolution, ContactSolver, Slope, WearRates, newton_with_wear
from .fixed_point import Trial, self_consistent
from .sdirk import InterfaceState
from .steady import SteadyState

_UNWORN = (
    "contact: neither the touching points nor what depends on temperature and pressure settle; "
    "give the contact a (smaller) heat.conductance, or reduce the speed"
)
_RISE = 0.1
"""Of what the largest pressure has risen by in a step, where its points are reached one by one."""
_BEHIND = 0.03
"""Of a step: so far behind the time at which a point is expected to be reached it ends."""
_SETTLING = 0.4
"""Of the time in which wear takes up the deflection under a point: step after it is reached."""
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
        """Whether temperatures are followed in time."""
        return self._transient

    @property
    def note(self) -> str | None:
        """What the user should know about the settings of the method."""
        return self._method.note

    def unworn(self) -> InterfaceState:
        """Contact of the unworn faces at the temperatures that its friction leads to.

        The points that exchange heat are found by iteration.

        Raises
        ------
        ComputationError
            If the set of touching points, or what depends on the state, does not settle.
        """
        return self._lasting(self._nothing(), 0.0)

    def _lasting(
        self, worn: np.ndarray, time: float, pointwise: np.ndarray | None = None
    ) -> InterfaceState:
        """Contact of faces with given wear, at the temperatures that its friction leads to."""
        heat = None if self._heat is None else self._heat.steady

        def respond(conditions: InterfaceConditions) -> InterfaceState:
            contact = self._contact(worn, 0.0, conditions, heat, None, pointwise)
            faces = None if heat is None else heat.faces(conditions, contact.pressure)
            return InterfaceState(worn, contact, faces=faces)

        faces = None if heat is None else heat.unheated
        start = Trial(self._guess.pressure, faces, worn)
        return self_consistent(self._surroundings, time, start, respond, _UNWORN)[1]

    def worn(self, depth: np.ndarray, guess: ContactSolution | None = None) -> ContactSolution:
        """Contact of faces from which a depth (n,) is worn, without heat [m]."""
        conditions = self.conditions(InterfaceState(self._nothing(), self._guess), 0.0)
        return self._contact(depth[None], 0.0, conditions, None, guess)

    def start(self) -> InterfaceState:
        """The unworn faces at time 0."""
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
        """A state of a problem of the same bodies before their meshes were moved.

        Parameters
        ----------
        former : InterfaceProblem
        state : InterfaceState
            Of that problem.
        worn : ndarray, shape (n_wearing, n)
            Its depths at the points of this problem [m].
        rise : ndarray or None, shape (n_owned,)
            Its temperatures at the nodes of this problem, where they are followed in time [K].
        time : float
            [s]
        """
        edge, geometry = state.pointwise, self._system.worn
        if edge is not None and (geometry is None or geometry.pieces is None):
            edge = self._edge.points(worn)  # the contact points are other ones
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
        """Contact at a moment of which the temperatures are known."""
        guess = InterfaceState(worn, self._guess, faces=heat.initial)
        conditions = self.conditions(guess, time)
        contact = self._contact(worn, 0.0, conditions, heat, None, pointwise)
        return replace(guess, contact=contact, stored=heat.stored)

    def begin(self, state: InterfaceState) -> InterfaceState:
        """A state with the points at which contact holds one by one in the next step.

        None before the edge of the contact is that of the wear. With the distance ξ from an edge
        that travels at a speed c the pressure rises as ``ξ^θ``, ``tan πθ = 2 c / (E* k v)``:
        ``2 p / E*`` is the slope of the bodies' deflection, ``k v p / c`` that of the worn depth
        (from ``k v p / c + 2 / (π E*) ∫ p(s) / (s - ξ) ds = const``, a singular integral equation;
        Muskhelishvili, Singular Integral Equations, 1953, ch. 12). Without wear θ is 1/2, and p
        falls to zero smoothly; where wear counts for more, θ < 1/4, it is nearly a jump. Both
        slopes are taken in the mean, by what depth and deflection differ over the contact.
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
        """The end of an implicit Euler step of wear, and of heat where it is followed in time.

        What depends on the state is that of the end of the step, but for the points that exchange
        heat: those that have touched before.
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
        """What holds at the interface in a state at a time [s]."""
        touching = state.pressure > 0
        return self._surroundings.at(time, state.pressure, state.faces, touching, state.worn)

    def contact_state(self, state: InterfaceState, time: float) -> ContactState:
        """What a state does to the bodies; every rank calls."""
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
        """Of both faces at the points [K], where there is heat."""
        assert self._heat is not None
        assert state.faces is not None
        T1, T2 = state.faces.rise
        return T1 + self._heat.ambient, T2 + self._heat.ambient

    def heat_balance(self, state: InterfaceState) -> HeatBalance:
        """Of all the heat so far, where it is followed in time; every rank calls."""
        assert self._heat is not None
        assert state.stored is not None
        return self._heat.balance(state.stored)

    def difference(
        self, before: InterfaceState, one: InterfaceState, other: InterfaceState
    ) -> float:
        """Difference of two pressures, the largest one where they are continuous in time [Pa].

        A point at which contact holds by itself begins to press at once when the edge of the wear
        reaches it. The largest difference of two histories is then one of the moment when that
        happens, and no step makes it small. What converges, and is asked for, is the mean over the
        area that presses, and the largest pressure, wherever that is. A step that reaches a point
        with its last stage wears that too late and presses it too much, by chance alike in both
        histories: so a rise of the largest pressure counts as well. All of the pressure counts
        where the edge has gone beyond its points.
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
        """Steps that end right behind a time at which the edge of the wear reaches a point.

        See `WearProblem`. After a step within which a pressure has begun the next one is short.
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
        """Shortest time in which wear takes up the deflection under the pressure of points [s]."""
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
        """What the next states depend on beside the last one; see `recall`."""
        return None if self._heat is None else self._heat.memory()

    def recall(self, memory: Any) -> None:
        """Be as another problem of the same system was when it had this memory."""
        if self._heat is not None:
            self._heat.recall(memory)

    def corners(self, end: float) -> tuple[float, ...]:
        """Times up to an end at which something changes its course [s]."""
        return self._surroundings.corners(end)

    def first_step(self, state: InterfaceState) -> float:
        """A step in which wear is small against the bodies' deflection, and heat goes not far [s].

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
        """Steady pressure of the discrete interface: what a running-in of it tends to [Pa]."""
        conditions = steady.conditions
        return self._method.steady(steady.wear.pressure, self._rates(conditions), conditions)

    def distance(self, state: InterfaceState, steady: np.ndarray | None) -> float:
        """Largest difference to a steady pressure, relative to the largest of that; NaN without."""
        if steady is None:
            return float("nan")
        return float(np.abs(state.pressure - steady).max() / steady.max())

    def _rates(self, conditions: InterfaceConditions) -> WearRates:
        return WearRates(self._laws, self._spreads, conditions)

    def _nothing(self) -> np.ndarray:
        """No wear, shape (n_wearing, n)."""
        return np.zeros((len(self._laws), len(self._gap)))

    @property
    def _guess(self) -> ContactSolution:
        """The mean pressure, all over the face."""
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
        """A state with what has accumulated in a step."""
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

        Each Newton step is a contact problem of its own: wear that grows with the pressure adds
        ``step · ∂rate/∂p`` to the compliance of each point.
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
        return newton_with_wear(solve, self._rates(conditions), step, guess)

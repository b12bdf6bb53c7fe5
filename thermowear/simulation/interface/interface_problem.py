"""Interface problem: contact, friction heat and an implicit step of wear."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...contact.wear.implicit_step import Slope, WearRates, newton_with_wear
from ...errors import ComputationError
from ..heat.friction_heat import AnyHeat, FrictionHeat, InitialHeat, friction_heat
from ..system.conditions import ConditionModel, InterfaceConditions
from ..system.system import System
from .body_state import ContactState
from .condensed_method import CondensedMethod, ContactSolution, ContactSolver, PointwiseMethod
from .fixed_point import Trial, imperfect_contact, self_consistent
from .full_method import FullMethod
from .growing_edge import GrowingEdge, Note
from .sdirk import InterfaceState, InterfaceWear, WearProblem
from .steady import SteadyLimit, SteadyState, steady_limit

_UNWORN = (
    "contact: the iteration for the contact set and the state-dependent properties did not "
    "converge; give the contact a (smaller) heat.conductance, or reduce the speed"
)
_WORN_IN = (
    "; it is the unworn state that is critical, in the steady temperatures of its friction heat: "
    "worn faces may have a stable one, so begin with the shape of the steady state "
    "(geometry.initial_shape), or compute the temperatures in time (heat.transient = true)"
)
_STEP = "contact: the iteration for the state-dependent properties of a step did not converge"


class InterfaceProblem(WearProblem):
    """Contact with heat and wear for given loads.

    Attributes
    ----------
    stores_heat : bool
        True if conduction is transient.
    """

    def __init__(
        self, system: System, method: ContactSolver, heat: FrictionHeat | None, note: Note = None
    ):
        self.system, self._method, self.heat = system, method, heat
        self._condition_model = ConditionModel(system)
        self._last_conditions: tuple[bytes, InterfaceConditions] | None = None
        self._wear = InterfaceWear(system)
        self._edge = GrowingEdge(system, method, self._wear, note)
        self._limit: SteadyLimit | None = None
        self._gap, n = system.contacts.gap - system.holder.imposed, len(system.weights)
        self._softness, self._rigid = system.softness, Slope.diagonal(np.zeros(n))
        self._unworn = np.zeros((len(self._wear.laws), n))
        self._guess = ContactSolution(np.full(n, system.mean_pressure), np.zeros(0), None)
        self.stores_heat = system.model.heat is not None and system.model.heat.transient

    def unworn(self) -> InterfaceState:
        """Contact of the unworn faces with the steady temperatures of its own friction heat."""
        try:
            return self._in_steady_heat(self._unworn, 0.0)
        except ComputationError as reason:
            if self.heat is None or not self._wear.laws:
                raise
            raise ComputationError(f"{reason}{_WORN_IN}") from None

    def _in_steady_heat(
        self, worn: np.ndarray, time: float, pointwise: np.ndarray | None = None
    ) -> InterfaceState:
        """Contact of faces with given wear, in the steady temperatures of its heat (iterated)."""
        heat = None if self.heat is None else self.heat.steps.steady

        def respond(conditions: InterfaceConditions) -> InterfaceState:
            contact = self._solve(worn, conditions, heat, pointwise)
            faces = None if heat is None else heat.faces(conditions, contact.pressure)
            return InterfaceState(worn, contact, faces=faces)

        faces = None if heat is None else heat.baseline.unheated
        start = Trial(self._guess.pressure, faces, worn)
        return self_consistent(self._condition_model, time, start, respond, _UNWORN)[1]

    def worn(self, depth: np.ndarray, guess: ContactSolution | None = None) -> ContactSolution:
        """Contact of faces with a total wear depth (n,) [m], without heat."""
        conditions = self.conditions(InterfaceState(self._unworn, self._guess), 0.0)
        return self._solve(depth[None], conditions, None, guess=guess)

    def start(self) -> InterfaceState:
        if self.heat is None or not self.stores_heat:
            return replace(self.unworn(), removed=self._wear.nothing)
        found = self._at_temperatures(self._unworn, self.heat.initial, 0.0)
        return replace(found, removed=self._wear.nothing)

    def take_over(
        self, former: InterfaceProblem, state: InterfaceState, worn, rise, time: float
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
        edge, geometry = state.pointwise, self.system.worn
        if edge is not None and (geometry is None or not geometry.keeps_points):
            edge = self._edge.points(worn)  # the contact points have changed
        if state.stored is None:
            found = self._in_steady_heat(worn, time, edge)
        else:
            assert self.heat is not None
            assert former.heat is not None
            assert rise is not None
            stored = self.heat.take_over(former.heat, state.stored, rise)
            found = self._at_temperatures(worn, self.heat.given(stored), time, edge)
        return replace(found, peak=state.largest, pointwise=edge, removed=state.removed)

    def _at_temperatures(self, worn, heat: InitialHeat, time, pointwise=None) -> InterfaceState:
        """Contact at given temperatures."""
        guess = InterfaceState(worn, self._guess, faces=heat.baseline.unheated)
        conditions = self.conditions(guess, time)
        contact = self._solve(worn, conditions, heat, pointwise)
        return replace(guess, contact=contact, stored=heat.stored)

    def begin(self, state: InterfaceState) -> InterfaceState:
        reached = np.any(state.worn > 0.0, axis=0)
        if not reached.any() or state.contact.warm_start is None:
            return state
        if state.pointwise is None:
            # pointwise contact once the edge of the contact is that of the wear: once the wear
            # depth is steeper than the deflection, in the mean over the contact
            steepness = state.range_of_depth(self.system.contacts.ranges)
            uniform = reached.all() and not self._wear.layered
            if uniform or steepness <= self._method.deflection_range(state.contact):
                return state
        edge = self._edge.points(state.worn, state.pressure, state.pointwise)
        return replace(state, pointwise=edge)

    def stage(
        self,
        before: InterfaceState,
        step: float,
        time: float,
        guess: InterfaceState,
        last: bool = True,
    ) -> InterfaceState:
        """Implicit Euler step of wear, and of heat in transient conduction.

        Conditions are those at its end, but heat is exchanged by the contact set of the guess.
        """
        heat = None if self.heat is None else self.heat.steps.after(before.stored, step, time)
        found, edge, model = guess.contact, before.pointwise, self._condition_model
        faced = heat is not None and (last or model.depends_on_state or before.stored is not None)

        def respond(conditions: InterfaceConditions) -> InterfaceState:
            nonlocal found
            found = self._solve(before.worn, conditions, heat, edge, found, step)
            faces = heat.faces(conditions, found.pressure) if heat is not None and faced else None
            rates = self._rates(conditions, step)
            worn, removed = self._wear.after(before, rates, found.pressure)
            return InterfaceState(worn, found, before.peak, faces, None, edge, removed)

        if guess.touching is not None and before.stored is None:
            faced = True
            conditions, state = imperfect_contact(model, time, guess, respond, _STEP)
        elif model.depends_on_state:
            closed = guess.exchanging
            conditions, state = self_consistent(model, time, guess, respond, _STEP, closed)
        else:
            conditions = self.conditions(guess, time)
            state = respond(conditions)
        if self.heat is None or heat is None or before.stored is None or state.faces is None:
            return state
        made = conditions.heating * state.pressure
        stored = self.heat.steps.end(before.stored, step, heat, state.faces, made)
        return replace(state, stored=stored)

    def prolonged(self, before: InterfaceState, after: InterfaceState, part, step, time):
        found = before.towards(after, part)
        if self._wear.layered:
            rates = self._rates(self.conditions(after, time), part * step)
            worn, removed = self._wear.after(before, rates, after.pressure)
            found = replace(found, worn=worn, removed=removed)
        return found

    def conditions(self, state: InterfaceState, time: float) -> InterfaceConditions:
        """Interface conditions in a state at a time [s]; constant ones are kept."""
        model, closed = self._condition_model, state.exchanging
        kept, key = self._last_conditions, closed.tobytes()
        if kept is not None and kept[0] == key and model.constant:
            return kept[1]
        found = model.at(time, state.pressure, state.faces, closed, state.worn)
        self._last_conditions = key, found
        return found

    def _rates(self, conditions: InterfaceConditions, step: float = 1.0) -> WearRates:
        """Wear rates under given conditions, for wear in a time step [s]."""
        own, at = self._wear, conditions
        return WearRates(own.laws, own.spreads, at.wear, at.states, step)

    def _solve(
        self,
        worn: np.ndarray,
        conditions: InterfaceConditions,
        heat: AnyHeat | None,
        pointwise: np.ndarray | None = None,
        guess: ContactSolution | None = None,
        step: float = 0.0,
    ) -> ContactSolution:
        """Solve contact of faces with given wear, or at the end of an implicit step of wear [s].

        In a step by Newton's method: each iteration is a contact problem, in which wear adds
        ``step · ∂rate/∂p`` to the compliance of each point.
        """
        gap = self._gap + worn.sum(axis=0)
        if conditions.released:  # the holder stays where it is
            at_rest = np.zeros(len(self.system.holder.rigid_modes))
            return ContactSolution(np.zeros(len(gap)), guess.motion if guess else at_rest, None)

        def solve(opened, slope, last):
            softened = slope.with_compliance(self._softness)
            return self._method.solve(gap + opened, softened, last, conditions, heat, pointwise)

        start = None if guess is None or guess.warm_start is None else guess
        if step == 0.0 or not self._wear.laws:
            return solve(self._rigid.point, self._rigid, start)
        start = start or solve(self._rigid.point, self._rigid, None)
        rates = self._rates(conditions, step)
        wear = self._wear.in_step(worn, rates) if self._wear.layered else rates
        return newton_with_wear(solve, wear, start)

    def contact_state(self, state: InterfaceState, time: float) -> ContactState:
        """Contact loads of a state on the bodies; every rank calls."""
        conditions, temperatures = self.conditions(state, time), None
        if self.heat is not None and state.stored is not None and state.faces is not None:
            temperatures = self.heat.transient(state.stored, state.faces)
        elif self.heat is not None:
            temperatures = self.heat.steady(conditions, state.pressure)
        return ContactState(state.pressure, conditions, temperatures)

    def difference(
        self, before: InterfaceState, one: InterfaceState, other: InterfaceState
    ) -> float:
        if one.pointwise is None:
            return super().difference(before, one, other)
        return self._edge.difference(before, one, other)

    def edge_steps(self, states, step: float, time: float) -> tuple[float, float]:
        last = states[2]
        if last.pointwise is None:
            return super().edge_steps(states, step, time)
        return self._edge.steps(states, step, self._rates(self.conditions(last, time)))

    def difference_inside(self, one: InterfaceState, other: InterfaceState) -> float:
        """Largest difference of temperatures inside the bodies [K]; every rank calls."""
        if self.heat is None or one.stored is None or other.stored is None:
            return 0.0
        return self.heat.steps.largest(one.stored.rise - other.stored.rise)

    def corners(self, end: float) -> tuple[float, ...]:
        return self._condition_model.corners(end)

    def first_step(self, state: InterfaceState) -> float:
        """Initial step: wear small against elastic deflection, small penetration of heat [s]."""
        conditions = self.conditions(state, 0.0)
        fastest = float(self._rates(conditions).value(state.pressure).max(initial=0.0))
        step = np.inf
        if fastest > 0.0:
            step = 1e-3 * self._method.largest_deflection(state.contact) / fastest
        if self.heat is not None and self.stores_heat:
            made = conditions.heating * state.pressure
            step = min(step, self.heat.first_step(float(made.max())))
        return step

    def distance(self, state: InterfaceState, steady: SteadyState | None) -> float:
        """Relative difference to the steady pressure; NaN without one, or with layers left on."""
        if steady is None:
            return float("nan")
        last = self._limit
        if last is None or last.steady is not steady or last.edge is not state.pointwise:
            last = self._limit = steady_limit(self._edge, steady, state, last)
        if self._wear.layered and self._wear.are_left(state.worn, last.pressure > 0.0):
            return float("nan")
        return float(np.abs(state.pressure - last.pressure).max() / last.pressure.max())


def interface_problem(system: System, note: Note = None) -> InterfaceProblem:
    """Interface problem of a system, with the contact method of its model. Every rank calls.

    Parameters
    ----------
    system : System
    note : callable, optional
        Called with a warning about what may impair the solution.
    """
    own = {"condensed": CondensedMethod, "pointwise": PointwiseMethod}
    method = own.get(system.model.method)
    if method is not None:
        return InterfaceProblem(system, method(system), friction_heat(system), note)
    with system.phases("contact operators"):
        full = FullMethod(system, note)
    return InterfaceProblem(system, full, friction_heat(system), note)

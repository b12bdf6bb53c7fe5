"""Interface problem: contact, friction heat and an implicit step of wear."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..heat.friction_heat import FrictionHeat
from ..heat.heat_states import HeatBalance
from ..heat.heat_steps import ConductingStep, InitialHeat
from ..system.conditions import ConditionModel, InterfaceConditions
from ..system.system import System
from .body_state import ContactState
from .contact_solver import ContactSolution, ContactSolver
from .fixed_point import Trial, self_consistent
from .growing_edge import GrowingEdge
from .implicit_contact import ImplicitContact
from .sdirk import InterfaceState, WearProblem
from .steady import SteadyState

_UNWORN = (
    "contact: the iteration for the contact set and the state-dependent properties did not "
    "converge; give the contact a (smaller) heat.conductance, or reduce the speed"
)
_STEP = "contact: the iteration for the state-dependent properties of a step did not converge"


class InterfaceProblem(WearProblem):
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
        self._model = ConditionModel(system)
        self._edge = GrowingEdge(system, method)
        self._contact = ImplicitContact(system, method)
        given = system.model.heat
        self._transient = given is not None and given.transient

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
        return self._lasting(self._contact.unworn, 0.0)

    def _lasting(
        self, worn: np.ndarray, time: float, pointwise: np.ndarray | None = None
    ) -> InterfaceState:
        """Contact of faces with given wear and the steady temperatures of its friction heat."""
        heat = None if self._heat is None else self._heat.steps.steady

        def respond(conditions: InterfaceConditions) -> InterfaceState:
            contact = self._contact.solve(worn, conditions, heat, pointwise)
            faces = None if heat is None else heat.faces(conditions, contact.pressure)
            return InterfaceState(worn, contact, faces=faces)

        faces = None if heat is None else heat.unheated
        start = Trial(self._contact.guess.pressure, faces, worn)
        return self_consistent(self._model, time, start, respond, _UNWORN)[1]

    def worn(self, depth: np.ndarray, guess: ContactSolution | None = None) -> ContactSolution:
        """Contact of faces with a total wear depth (n,) [m], without heat."""
        conditions = self.conditions(InterfaceState(self._contact.unworn, self._contact.guess), 0.0)
        return self._contact.solve(depth[None], conditions, None, guess=guess)

    def start(self) -> InterfaceState:
        """State of the unworn faces at time 0."""
        if not self._transient:
            return self.unworn()
        assert self._heat is not None
        return self._frozen(self._contact.unworn, self._heat.frozen, 0.0)

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
        guess = InterfaceState(worn, self._contact.guess, faces=heat.initial)
        conditions = self.conditions(guess, time)
        contact = self._contact.solve(worn, conditions, heat, pointwise)
        return replace(guess, contact=contact, stored=heat.stored)

    def begin(self, state: InterfaceState) -> InterfaceState:
        return self._edge.begin(state)

    def stage(
        self, before: InterfaceState, step: float, time: float, guess: InterfaceState
    ) -> InterfaceState:
        """Implicit Euler step of wear, and of heat in transient conduction.

        State-dependent conditions are those at the end of the step, except for the points that
        exchange heat: the contact set of the guess.
        """
        heat, last, edge = self._heat_at_end(before, step, time), guess.contact, before.pointwise

        def respond(conditions: InterfaceConditions) -> InterfaceState:
            nonlocal last
            last = self._contact.solve(before.worn, conditions, heat, edge, last, step)
            faces = None if heat is None else heat.faces(conditions, last.pressure)
            worn = before.worn + step * self._contact.rates(conditions)(last.pressure)
            return InterfaceState(worn, last, before.peak, faces, pointwise=edge)

        conditions, found = self_consistent(
            self._model, time, guess, respond, _STEP, closed=guess.pressure > 0
        )
        if self._heat is None or heat is None or before.stored is None or found.faces is None:
            return found
        made = conditions.heating * found.pressure
        stored = self._heat.stored(before.stored, step, heat, found.faces, made)
        return replace(found, stored=stored)

    def conditions(self, state: InterfaceState, time: float) -> InterfaceConditions:
        """Interface conditions in a state at a time [s]."""
        touching = state.pressure > 0
        return self._model.at(time, state.pressure, state.faces, touching, state.worn)

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
        return self._edge.difference(before, one, other)

    def edge_steps(
        self,
        states: tuple[InterfaceState, InterfaceState, InterfaceState],
        step: float,
        time: float,
    ) -> tuple[float, float]:
        last = states[2]

        def rate_slope() -> np.ndarray:
            return self._contact.rates(self.conditions(last, time)).slope(last.pressure).point

        return self._edge.steps(states, step, rate_slope)

    def difference_inside(self, one: InterfaceState, other: InterfaceState) -> float:
        """Largest difference of temperatures inside the bodies [K]; every rank calls."""
        if self._heat is None or one.stored is None or other.stored is None:
            return 0.0
        return self._heat.difference(one.stored, other.stored)

    def restart_data(self) -> tuple | None:
        """Internal state to restart from beside the last interface state; see `restore`."""
        return None if self._heat is None else self._heat.steps.restart_data()

    def restore(self, data: tuple | None) -> None:
        """Restore the internal state from `restart_data`."""
        if self._heat is not None:
            self._heat.steps.restore(data)

    def corners(self, end: float) -> tuple[float, ...]:
        """Times up to an end at which a history has a corner [s]."""
        return self._model.corners(end)

    def first_step(self, state: InterfaceState) -> float:
        """Initial step: wear small against elastic deflection, small penetration of heat [s].

        May be infinite.
        """
        conditions = self.conditions(state, 0.0)
        fastest = float(
            self._contact.rates(conditions)(state.pressure).sum(axis=0).max(initial=0.0)
        )
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
        return self._method.steady(
            steady.wear.pressure, self._contact.rates(conditions), conditions
        )

    def distance(self, state: InterfaceState, steady: np.ndarray | None) -> float:
        """Largest difference to a steady pressure, relative to its maximum; NaN without one."""
        if steady is None:
            return float("nan")
        return float(np.abs(state.pressure - steady).max() / steady.max())

    def _heat_at_end(
        self, before: InterfaceState, step: float, time: float
    ) -> ConductingStep | None:
        if self._heat is None:
            return None
        if before.stored is None:
            return self._heat.steps.steady
        return self._heat.steps.after(before.stored, step, time)

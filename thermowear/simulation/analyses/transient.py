"""Thermal causes that end a running-in: thermal runaway, and jumps of steady temperatures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ...balances import ALLOWED, require
from ...errors import ComputationError, StandstillError
from ...model.analyses import TransientAnalysis
from ...results import ContactRow, HeatRow, HistoryRow, ProbeRow
from ...results.short_names import by_name
from ..geometry_update.outer_loop import OuterLoop
from ..geometry_update.wider_zone import ends_outside_zone
from ..heat.friction_heat import FrictionHeat
from ..heat.probes import probe_rows
from ..interface.interface_problem import interface_problem
from ..interface.sdirk import InterfaceState
from ..interface.steady import SteadyState, steady_state
from ..results.coatings import Face, WearingState, layers, times_since_worn_through
from ..results.friction import contact_rows, friction_rows
from ..results.recording import Snapshot, comparable_pressure, snapshot_at
from ..runtime.history import AnalysisHistory
from ..runtime.observer import Observer
from ..system.conditions import InterfaceConditions
from ..system.system import System
from ..time_loop import ALTERNATES, STEPS, AnySize, FewSizes, Moment, alternates, times_to_hit
from .stability import static_factor
from .static import wear_velocity

_STEEPER = 3.0  # heating rate over mean rate so far; linear rise of load and speed gives 2.5
_UNSTABLE = (
    "thermal runaway: friction heat distorts the bodies, which concentrates pressure and heat "
    "(thermoelastic instability); reduce the speed or the friction"
)
_JUMPS = (
    "with steady temperatures, states may jump beyond the critical speed, here at {:.3g} times it: "
    "reduce the speed, or compute temperatures in time (heat.transient = true)"
)
_REGULAR = (
    "this state is not critical, at {:.3g} times its critical speed: use a finer mesh at the "
    "contact, or another analysis.tolerance"
)
_NEAR = 1.02
"""Critical speed factor of the last state up to which the next one may be beyond it."""


def cause_of(
    reason: ComputationError, heating: Sequence[HistoryRow], critical: float | None
) -> str | None:
    """Thermal cause of an error that ends a running-in; None if it is not known to have one.

    Parameters
    ----------
    reason : ComputationError
    heating : sequence of HistoryRow
        History with temperatures in time; empty without them.
    critical : float or None
        Critical speed factor of the last state in steady temperatures; None if not known.
    """
    if len(heating) > 2 and _runs_away(heating):
        return _UNSTABLE
    if critical is None or not isinstance(reason, StandstillError):
        return None
    return (_JUMPS if critical < _NEAR else _REGULAR).format(1 / critical)


def _runs_away(rows: Sequence[HistoryRow]) -> bool:
    """True if the faces heat up much faster than before."""
    first, before, last = rows[0], rows[-2], rows[-1]
    so_far = (before.max_temperature - first.max_temperature) / before.time
    now = (last.max_temperature - before.max_temperature) / last.step
    return now > _STEEPER * so_far > 0.0


_MELTED = 5000.0  # K, above the melting point of any solid


def _principle(settings: TransientAnalysis, system: System) -> SteadyState | None:
    """Steady state that a transient analysis approaches; None if there is none.

    There is none unless all holder modes are free, for a growing contact, for inputs given over
    time, for wear laws that depend on the depth, or if the principle has no solution. Faces with
    layers approach that of their substrates.
    """
    if not settings.compares and settings.until is None:
        return None
    free, grows = system.holder.free, any(ends_outside_zone(system))
    if not (len(free) and free.all()) or (grows and settings.until is None):
        return None
    if system.model.histories or not system.laws:
        return None
    if any("depth" in law.variables for law in system.worn_through().laws.values()):
        return None
    try:
        return steady_state(system)
    except ComputationError:
        if settings.until == "steady":
            raise
        return None


class TransientHistory(AnalysisHistory[Moment]):
    """History of the accepted moments of a running-in.

    The summary includes the wear velocities of the steady state that is approached.

    Attributes
    ----------
    loop : OuterLoop
        Loop that provides the system and the problem at the last moment.
    """

    def __init__(self, system: System, settings: TransientAnalysis, observer: Observer):
        super().__init__(system, settings, observer)
        problem = interface_problem(system, observer.note)
        sizes = FewSizes(times_to_hit(settings, problem)) if problem.stores_heat else AnySize()
        self.loop = OuterLoop(problem, settings, partial(_principle, settings), sizes, observer)
        self._speed, self._named, self._alternates = 0.0, system.model.named, False
        self._coated = layers(system.model).keys()
        self._lost: dict[Face, tuple[float, float]] = {}
        self._rubbing: tuple[InterfaceConditions, np.ndarray] | None = None

    def restart_data(self) -> tuple:
        """Mean sliding speed [m/s], data of the outer loop and of nonlinear heat, lost layers."""
        heat = self.loop.now.problem.heat
        own = None if heat is None else heat.steps.restart_data()
        return self._speed, self.loop.restart_data(), own, self._lost

    def restore(self, data: tuple) -> None:
        self._speed, loop, own, *lost = data  # checkpoints of earlier versions have no layers
        known = lost[0] if lost else {}  # or those of the only interface, by side
        self._lost = {k if isinstance(k, tuple) else (0, k): each for k, each in known.items()}
        self.loop.restore(loop)
        if self.loop.now.problem.heat is not None and own is not None:
            self.loop.now.problem.heat.steps.restore(own)

    def rows_of(self, state: Moment) -> list[HistoryRow | HeatRow | ContactRow | ProbeRow]:
        problem = self.loop.now.problem
        conditions = problem.conditions(state.state, state.time)
        speed = self._mean(conditions.speed)
        slid = state.step * (self._speed + speed) / 2  # steps end at kinks of the speed
        self._speed = speed
        row = self._row(state, slid, conditions)
        self._note_lost_layers(conditions, state, slid, row)
        each: list[ContactRow | ProbeRow] = self._contact_rows(conditions, state)
        each += self._probe_rows(state)
        if problem.heat is None or not problem.stores_heat:
            return [row, *each]
        rows = self.table(HistoryRow)
        if len(rows) % STEPS == STEPS - 1 and not self._alternates:
            self._alternates = alternates([each.contact_area for each in (*rows, row)])
            if self._alternates:  # told once
                self._observer.note(ALTERNATES)
        heat = self._heat_row(state, conditions, problem.heat)
        if not heat.balance_error <= ALLOWED:
            require(heat_balance_relative_error=heat.balance_error)
        return [row, heat, *each]

    def states(self, last: Moment | None) -> Iterator[Moment]:
        """Accepted moments while the faces are below any melting point.

        Raises
        ------
        ComputationError
            If they are hotter; that of a standstill is extended by its cause.
        """
        try:
            for moment in self.loop.moments(last):
                yield moment
                hottest = self._hottest(moment.state)
                if self.loop.now.problem.stores_heat and hottest > _MELTED:
                    raise ComputationError(
                        f"transient: {hottest:.3g} K at {moment.time:g} s, above the melting point "
                        "of any solid"
                    )
        except ComputationError as reason:
            rows = self.table(HistoryRow)
            cause = cause_of(reason, rows if self.table(HeatRow) else [], self._critical())
            if cause is None:
                raise
            raise ComputationError(f"{reason}; {cause}") from None

    def _critical(self) -> float | None:
        """Critical speed factor of the last state in steady temperatures; None if not known."""
        problem, last = self.loop.now.problem, self._last
        if problem.heat is None or problem.stores_heat or last is None:
            return None
        if len(last.state.pressure) != len(problem.system.weights):  # of the mesh before
            return None
        try:
            return static_factor(problem.system, problem.contact_state(last.state, last.time))
        except ComputationError:
            return None

    def snapshot(self, state: Moment) -> Snapshot:
        return snapshot_at(self.loop.now.problem, state.state, state.time)

    def summary(self) -> dict:
        loop, rows, heat = self.loop, self.table(HistoryRow), self.table(HeatRow)
        steady = loop.now.steady
        result = {
            "steps": len(rows) - 1,
            "time_s": rows[-1].time,
            "distance_from_steady": None if np.isnan(self.last.distance) else self.last.distance,
            **self._lost_layers(),
            **loop.summary(),
            **wear_velocity(loop.now.system, None if steady is None else steady.wear.velocity),
        }
        if not heat:
            return result
        last, peak = heat[-1], max(rows, key=lambda row: row.max_temperature)
        return result | {
            "heat_in_J": last.heat_in,
            "heat_stored_J": last.heat_stored,
            "heat_lost_J": last.heat_lost,
            "peak_temperature_K": peak.max_temperature,
            "peak_temperature_time_s": peak.time,
        }

    def _lost_layers(self) -> dict:
        """Time and distance at which each coated face first lost all layers; None if not yet."""
        model = self._system.model
        found: dict[str, dict] = {}
        for index, side in self._coated:
            time, distance = self._lost.get((index, side), (None, None))
            found.setdefault(model.interfaces[index].name, {}).update(
                {
                    f"worn_through_time_{side + 1}_s": time,
                    f"worn_through_distance_{side + 1}_m": distance,
                }
            )
        return by_name("contacts", found)

    def _row(self, moment: Moment, slid: float, conditions: InterfaceConditions) -> HistoryRow:
        system, rows = self.loop.now.system, self.table(HistoryRow)
        depths = moment.state.by_body(system.laws)
        pressure = moment.state.pressure
        if not depths.any():
            pressure = comparable_pressure(system, pressure, depths)
        force, torque, power = self._friction(moment, conditions)
        in_gap = system.worn_areas * (depths - system.moved)
        volumes = in_gap.sum(axis=1) + system.lost.sum(axis=0)
        return HistoryRow(
            time=moment.time,
            sliding_distance=slid + (rows[-1].sliding_distance if rows else 0.0),
            max_pressure=float(pressure.max()),
            contact_area=float(system.weights[pressure > 0].sum()),
            wear_volume_1=float(volumes[0]),
            wear_volume_2=float(volumes[1]),
            max_temperature=self._hottest(moment.state),
            approach=float(system.approaches @ moment.state.contact.motion),
            step=moment.step,
            error=moment.error,
            max_wear_1=float(depths[0].max()),
            max_wear_2=float(depths[1].max()),
            friction_power=float(power),
            friction_force=float(force),
            friction_torque=float(torque),
        )

    def _friction(self, moment: Moment, conditions: InterfaceConditions) -> np.ndarray:
        """Friction force, torque and power of a contact; of several the power of all."""
        if self._rubbing is None or self._rubbing[0] is not conditions:
            system, count = self.loop.now.system, len(self._system.model.interfaces)
            rows = np.concatenate(
                [friction_rows(system, k, conditions) for k in range(count)], axis=1
            )
            if count > 1:
                rows[:2] = np.nan
            self._rubbing = conditions, rows
        return self._rubbing[1] @ moment.state.pressure

    def _note_lost_layers(self, conditions, moment: Moment, slid: float, row: HistoryRow) -> None:
        """Keep the time and the sliding distance at which a face first lost all its layers."""
        now, known = self.loop.now, self._lost
        if known.keys() >= self._coated:
            return
        end, begin, last = WearingState(moment.state, conditions), None, self._last
        if last is not None and last.state.worn.shape == moment.state.worn.shape:
            begin = WearingState(last.state, now.problem.conditions(last.state, last.time))
        times = times_since_worn_through(now.system, end, begin, moment.step)
        self._lost = {
            index: (moment.time - time, row.sliding_distance - slid * time / moment.step)
            for index, time in times.items()
        } | known

    def _hottest(self, state: InterfaceState) -> float:
        """Highest temperature of both faces [K]; NaN without heat."""
        heat = self.loop.now.problem.heat
        if heat is None or state.faces is None:
            return float("nan")
        return float(np.max(state.faces.rise)) + heat.ambient

    def _heat_row(
        self, moment: Moment, conditions: InterfaceConditions, heat: FrictionHeat
    ) -> HeatRow:
        system, state = self.loop.now.system, moment.state
        assert state.stored is not None
        assert state.faces is not None
        balance, pressure = state.stored.balance(heat.initial.stored, system.comm), state.pressure
        T1, T2 = (rise + heat.ambient for rise in state.faces.rise)
        return HeatRow(
            time=moment.time,
            speed=self._speed,
            normal_force=float(sum(np.linalg.norm(each @ pressure) for each in system.resultants)),
            friction_power=float(system.weights @ (conditions.heating * pressure)),
            heat_in=balance.made,
            heat_stored=balance.stored,
            heat_lost=balance.lost,
            balance_error=balance.error,
            max_temperature_1=float(T1.max()),
            max_temperature_2=float(T2.max()),
            mean_temperature_1=self._mean(T1),
            mean_temperature_2=self._mean(T2),
        )

    def _contact_rows(self, conditions: InterfaceConditions, moment: Moment) -> list:
        """Rows of the contacts that have names."""
        if not self._named:
            return []
        now = self.loop.now
        ambient = float("nan") if now.problem.heat is None else now.problem.heat.ambient
        return contact_rows(now.system, conditions, moment.state, moment.time, ambient)

    def _probe_rows(self, moment: Moment) -> list[ProbeRow]:
        """Rows of the probes; every rank calls."""
        problem, state = self.loop.now.problem, moment.state
        if not problem.system.model.probes:
            return []
        stored = state.stored
        field = problem.contact_state(state, moment.time).temperatures if stored is None else stored
        return [] if field is None else probe_rows(problem.system, field.rise, moment.time)

    def _mean(self, values: np.ndarray) -> float:
        """Area mean over the face; of equal values that value, without rounding."""
        least = values.min()
        return float(least + np.average(values - least, weights=self.loop.now.system.weights))

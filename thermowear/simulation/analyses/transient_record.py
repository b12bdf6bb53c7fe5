"""Record of the accepted moments and outputs of a transient analysis."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...balances import require
from ...errors import ComputationError
from ...laws.motions import RigidMotion, combined
from ...results import HeatRow, HistoryRow, InterfaceFields
from ...serialise import serialisable
from ..geometry_update.outer_loop import OuterLoop
from ..geometry_update.update_counts import UpdateCounts
from ..interface.body_state import BodyState, ContactState
from ..interface.interface_problem import InterfaceProblem
from ..model.conditions import InterfaceConditions
from ..model.rigid_modes import reference_point
from ..model.system import System
from ..model.worn_geometry import WornGeometry
from ..results.recording import interface_at
from ..results.summary import normal_force
from ..runtime.frames import FrameRecorder
from ..runtime.observer import Observer
from ..time.time_loop import Moment

_MELTED = 5000.0  # K, above the melting point of any solid
_STEEPER = 3.0  # heating rate over mean rate so far; linear rise of load and speed gives 2.5
_UNSTABLE = (
    "the temperature runs away: friction heat makes the bodies bulge, so that they press and heat "
    "each other ever more (thermoelastic instability); reduce the speed or the friction"
)


@serialisable
@dataclass(frozen=True)
class RunningIn:
    """Progress of a transient analysis: the data needed to restart it.

    Attributes
    ----------
    moment : Moment
    memory : object
        Internal state of the interface problem.
    speed : float
        Mean sliding speed [m/s].
    rows : list of HistoryRow
    heat : list of HeatRow
    worn : WornGeometry or None
        Worn geometry, if meshes have been moved.
    kept : tuple of float
        See `OuterLoop.kept`.
    zone : tuple of float or None
        Range of x that the mesh was made for [m].
    earlier : UpdateCounts
        Counts of the updates of meshes for narrower zones.
    """

    moment: Moment
    memory: Any
    speed: float
    rows: list[HistoryRow]
    heat: list[HeatRow]
    worn: WornGeometry | None
    kept: tuple[float, float, float]
    zone: tuple[float, float] | None = None
    earlier: UpdateCounts = field(default_factory=UpdateCounts)

    @property
    def time(self) -> float:
        return self.moment.time


class RunningInRecord:
    """Recorder of the rows and outputs so far.

    Parameters
    ----------
    loop : OuterLoop
        Loop that provides the system and the problem at the last moment.
    observer : Observer
    """

    def __init__(self, loop: OuterLoop, observer: Observer):
        self.rows: list[HistoryRow] = []
        self.heat: list[HeatRow] = []
        self.outputs: dict[float, InterfaceFields] = {}
        self._loop = loop
        self._observer = observer
        self._film = FrameRecorder(loop.system.case, observer)
        self._speed = 0.0
        self._last: Moment

    def go_on(self, before: RunningIn) -> Moment:
        """Restore the record of an earlier run; return the moment to restart from."""
        self._last, self._speed = before.moment, before.speed
        self.rows, self.heat = before.rows, before.heat
        self._loop.go_on(before.worn, before.kept, before.zone, before.earlier)
        self._problem.recall(before.memory)
        for rows in (self.rows, self.heat):
            self._observer.resumed(rows)
        return self._last

    def progress(self) -> RunningIn:
        memory = self._problem.memory()
        system, kept = self._system, self._loop.kept
        return RunningIn(
            self._last,
            memory,
            self._speed,
            self.rows,
            self.heat,
            system.worn,
            kept,
            system.inputs.zone,
            self._loop.earlier,
        )

    @property
    def _system(self) -> System:
        return self._loop.system

    @property
    def _problem(self) -> InterfaceProblem:
        return self._loop.problem

    def keep(self, moment: Moment) -> None:
        """Record an accepted step.

        Raises
        ------
        ComputationError
            If its balances do not hold; the step before then remains the last one.
        """
        if self._problem.stores_heat:
            error = self._problem.heat_balance(moment.state).error
            require(heat_balance_relative_error=error)
        interface = None
        if moment.is_output:
            with self._system.phases("output"):
                _, _, state, interface = self.bodies(moment)
            state.require_balance()
        conditions = self._problem.conditions(moment.state, moment.time)
        speed = self._mean(conditions.speed)
        slid = moment.step * (self._speed + speed) / 2  # steps end at kinks of the speed
        self._speed, self._last = speed, moment
        self.rows.append(self._row(moment, slid))
        self._observer.step(self.rows[-1], moment.distance)
        if self._problem.stores_heat:
            self.heat.append(self._heat_row(moment, conditions))
            self._observer.heat(self.heat[-1])
        if interface is not None:
            with self._system.phases("output"):
                self.outputs[moment.time] = interface
                self._observer.output(moment.time, interface)
        number = len(self.rows) - 1
        self._film.take(self._system, number, moment.time, lambda: self.bodies(moment))

    def watched(self, passing: Iterator[Moment]) -> Iterator[Moment]:
        """Pass the moments on while the faces are below any melting point.

        Raises
        ------
        ComputationError
            If they are hotter; that of a step failing in thermal runaway is extended by the cause.
        """
        try:
            for moment in passing:
                yield moment
                hottest = self._problem.hottest(moment.state)
                if self.heat and hottest > _MELTED:
                    raise ComputationError(
                        f"transient: {hottest:.3g} K at {moment.time:g} s, no solid is as hot"
                    )
        except ComputationError as reason:
            if self._runs_away():
                raise ComputationError(f"{reason}; {_UNSTABLE}") from None
            raise

    def bodies(
        self, moment: Moment
    ) -> tuple[ContactState, RigidMotion, BodyState, InterfaceFields]:
        """Contact, motion of the holder, bodies and interface at a moment."""
        contact = self._problem.contact_state(moment.state, moment.time)
        motion = combined(self._system.holder.motions, moment.state.contact.motion)
        worn = self._by_body(moment.state.worn)
        return contact, motion, *interface_at(self._system, contact, motion, worn)

    def extra(self) -> dict:
        """Summary entries of a transient analysis."""
        result = {
            "steps": len(self.rows) - 1,
            "time_s": self.rows[-1].time,
            "distance_from_steady": None if self._loop.steady is None else self._last.distance,
            **self._loop.summary(),
        }
        if not self.heat:
            return result
        last, peak = self.heat[-1], max(self.rows, key=lambda row: row.max_temperature)
        return result | {
            "heat_in_J": last.heat_in,
            "heat_stored_J": last.heat_stored,
            "heat_lost_J": last.heat_lost,
            "peak_temperature_K": peak.max_temperature,
            "peak_temperature_time_s": peak.time,
        }

    def _runs_away(self) -> bool:
        """True if the faces heat up much faster than before (thermal runaway)."""
        if not self.heat or len(self.rows) < 3:
            return False
        first, before, last = self.rows[0], self.rows[-2], self.rows[-1]
        so_far = (before.max_temperature - first.max_temperature) / before.time
        now = (last.max_temperature - before.max_temperature) / last.step
        return now > _STEEPER * so_far > 0.0

    def _row(self, moment: Moment, slid: float) -> HistoryRow:
        system, pressure = self._system, moment.state.pressure
        volumes = system.worn_volumes(self._by_body(moment.state.worn))
        moved = combined(system.holder.motions, moment.state.contact.motion)
        return HistoryRow(
            time=moment.time,
            sliding_distance=slid + (self.rows[-1].sliding_distance if self.rows else 0.0),
            max_pressure=float(pressure.max()),
            contact_area=float(system.weights[pressure > 0].sum()),
            wear_volume_1=float(volumes[0]),
            wear_volume_2=float(volumes[1]),
            max_temperature=self._problem.hottest(moment.state),
            approach=float(moved.at(reference_point(system.case)) @ system.press),
            step=moment.step,
            error=moment.error,
        )

    def _heat_row(self, moment: Moment, conditions: InterfaceConditions) -> HeatRow:
        pressure, balance = moment.state.pressure, self._problem.heat_balance(moment.state)
        T1, T2 = self._problem.face_temperatures(moment.state)
        return HeatRow(
            time=moment.time,
            speed=self._speed,
            normal_force=normal_force(self._system.rubbing(conditions.friction), pressure),
            friction_power=float(self._system.weights @ (conditions.heating * pressure)),
            heat_in=balance.made,
            heat_stored=balance.stored,
            heat_lost=balance.lost,
            balance_error=balance.error,
            max_temperature_1=float(T1.max()),
            max_temperature_2=float(T2.max()),
            mean_temperature_1=self._mean(T1),
            mean_temperature_2=self._mean(T2),
        )

    def _mean(self, values: np.ndarray) -> float:
        """Area mean over the face."""
        return float(np.average(values, weights=self._system.weights))

    def _by_body(self, worn: np.ndarray) -> np.ndarray:
        """Expand rows of the wearing bodies to both bodies, shape (2, n)."""
        both = np.zeros((2, worn.shape[1]))
        both[list(self._system.laws)] = worn
        return both

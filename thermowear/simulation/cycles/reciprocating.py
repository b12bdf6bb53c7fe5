"""Reciprocating sliding wear in time, to an end time or to the steady state."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...case.tables.analyses import Reciprocating
from ...case.tables.schema import Case
from ...laws.motions import RigidMotion, combined
from ...results import HistoryRow, InterfaceFields, Result, TrackHistory, WornTrack
from ...serialise import serialisable
from ..interface.body_state import BodyState, ContactState, contact_state
from ..interface.factory import interface_problem
from ..model.rigid_modes import reference_point
from ..model.system import System
from ..results.recording import FinalState, interface_at
from ..results.summary import conclude
from ..runtime.frames import FrameRecorder
from ..runtime.guarded_loop import go_through
from ..runtime.observer import Observer
from ..time.step_sizes import AnySize, StepSizes
from ..time.time_loop import Moment, moments
from .reciprocating_problem import ReciprocatingProblem
from .stroke import positions


@serialisable
@dataclass(frozen=True)
class Reciprocated:
    """Progress of a reciprocating analysis: the data needed to restart it.

    Attributes
    ----------
    moment : Moment
    rows : list of HistoryRow
    """

    moment: Moment
    rows: list[HistoryRow]

    @property
    def time(self) -> float:
        return self.moment.time


def reciprocating(
    system: System, observer: Observer, before: Reciprocated | None = None
) -> tuple[FinalState, Result]:
    """Follow the cycle-averaged wear in time, from the start or from a checkpoint.

    Results computed before an error or Ctrl-C are kept.
    """
    problem = ReciprocatingProblem(system, positions(system))
    record = _Record(system, problem, observer)
    last = None if before is None else record.go_on(before)
    run = moments(problem, _in_time(system.case), None, _sizes(system.case), last)
    _, stopped = go_through(system, "time stepping", run, record, observer, last)
    with system.phases("bodies"):
        contact, motion, state, interface = record.in_the_middle()
    return conclude(
        FinalState(system, contact, motion, state),
        interface,
        record.extra(),
        history=record.rows,
        outputs=record.outputs,
        track=TrackHistory(record.worn_track(), record.tracks),
        stopped=stopped,
    )


def _in_time(case: Case) -> Reciprocating:
    """Settings of the analysis, with the end time from the number of cycles if given."""
    settings, count = case.analysis, case.cycles
    assert isinstance(settings, Reciprocating)
    if count is None:
        return settings
    return settings.model_copy(update={"end_time": count / _frequency(case)})


def _sizes(case: Case) -> StepSizes:
    """Step sizes limited to the largest allowed jump (``wear.max_jump``)."""
    longest = case.wear.max_jump
    return AnySize() if longest is None else AnySize(longest / _frequency(case))


def _frequency(case: Case) -> float:
    """Frequency of the reciprocating motion [Hz]."""
    assert case.motion is not None  # the case has been checked
    assert case.motion.frequency is not None
    return case.motion.frequency


class _Record:
    """Recorder of the rows and outputs so far."""

    last: Moment

    def __init__(self, system: System, problem: ReciprocatingProblem, observer: Observer):
        self.rows: list[HistoryRow] = []
        self.outputs: dict[float, InterfaceFields] = {}
        self.tracks: dict[float, WornTrack] = {}
        self._system = system
        self._problem = problem
        self._observer = observer
        self._film = FrameRecorder(system.case, observer)

    def go_on(self, before: Reciprocated) -> Moment:
        """Restore the record of an earlier run; return the moment to restart from."""
        self.last, self.rows = before.moment, before.rows
        self._observer.resumed(self.rows)
        return self.last

    def progress(self) -> Reciprocated:
        return Reciprocated(self.last, self.rows)

    def keep(self, moment: Moment) -> None:
        """Record an accepted step."""
        self.last = moment
        self.rows.append(self._row(moment))
        self._observer.step(self.rows[-1], moment.distance)
        if moment.is_output:
            with self._system.phases("output"):
                time = moment.time
                _, _, state, self.outputs[time] = self.in_the_middle()
                state.require_balance()
                self.tracks[time] = self.worn_track()
                self._observer.output(time, self.outputs[time], track=self.tracks[time])
        number, shown = len(self.rows) - 1, self.in_the_middle
        self._film.take(self._system, number, moment.time, shown, self.worn_track)

    def in_the_middle(self) -> tuple[ContactState, RigidMotion, BodyState, InterfaceFields]:
        """Contact, motion of the holder, bodies and interface at mid-stroke of body 1."""
        system, state = self._system, self.last.state
        worn, rates = (self._seen(v) for v in (state.worn, self._problem.rates(state.pressure)))
        found = interface_problem(system).worn(worn.sum(axis=0))
        motion = combined(system.holder.motions, found.motion)
        contact = contact_state(system, found.pressure)
        return contact, motion, *interface_at(system, contact, motion, worn, rates)

    def worn_track(self) -> WornTrack:
        """Worn depths and wear rates along the face of body 2."""
        state, face = self.last.state, self._system.pairing.sides[1].face
        rates = self._problem.rates(state.pressure)
        ends = face.position(np.arange(len(face.nodes)), np.ones(len(face.nodes)))
        x = np.interp(
            self._problem.track.position,
            np.concatenate([[0.0], ends]),
            np.concatenate([face.nodes[:1, 0, 0], face.nodes[:, -1, 0]]),
        )
        return WornTrack(x, self._problem.split(state.worn)[1], self._problem.split(rates)[1])

    def extra(self) -> dict:
        """Summary entries of a reciprocating analysis."""
        row, pressure = self.rows[-1], self.last.state.pressure
        volumes = self._volumes(self._problem.rates(pressure))
        lengths = (area.sum() for area in self._problem.areas)
        means = [float(volume / area) for volume, area in zip(volumes, lengths, strict=True)]
        return {
            "steps": len(self.rows) - 1,
            "time_s": row.time,
            "cycles": row.time * _frequency(self._system.case),
            "sliding_distance_m": row.sliding_distance,
            "distance_from_steady": self.last.distance,
            "max_pressure_of_cycle_Pa": row.max_pressure,
            "wear_volume_1_m3": row.wear_volume_1,
            "wear_volume_2_m3": row.wear_volume_2,
            "mean_wear_rate_1_m_per_s": means[0],
            "mean_wear_rate_2_m_per_s": means[1],
        }

    def _seen(self, depths: np.ndarray) -> np.ndarray:
        """Depths (or rates) of both bodies at the mid-stroke points, shape (2, n)."""
        system, (on_1, on_2) = self._system, self._problem.split(depths)
        hats = self._problem.track.hats(system.pairing)
        return np.array([system.basis @ on_1, hats @ on_2])

    def _volumes(self, depths: np.ndarray) -> list[float]:
        pairs = zip(self._problem.areas, self._problem.split(depths), strict=True)
        return [float(area @ depth) for area, depth in pairs]

    def _row(self, moment: Moment) -> HistoryRow:
        system, state = self._system, moment.state
        volumes = self._volumes(state.worn)
        mean_speed = float(np.average(system.speed, weights=system.weights))
        of_cycle = self._problem.of_cycle(state.contact)
        moved = combined(system.holder.motions, of_cycle.motion)
        return HistoryRow(
            time=moment.time,
            sliding_distance=mean_speed * moment.time,
            max_pressure=of_cycle.max_pressure,
            contact_area=of_cycle.contact_area,
            wear_volume_1=volumes[0],
            wear_volume_2=volumes[1],
            max_temperature=float("nan"),
            approach=float(moved.at(reference_point(system.case)) @ system.press),
            step=moment.step,
            error=moment.error,
        )

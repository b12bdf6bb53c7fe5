"""Reciprocating sliding wear in time, to an end time or to the steady state."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...model.analyses import ReciprocatingAnalysis
from ...results import HistoryRow, WornTrack
from ..interface.body_state import contact_state
from ..interface.interface_problem import interface_problem
from ..interface.sdirk import InterfaceState
from ..results.recording import Snapshot, snapshot
from ..runtime.history import AnalysisHistory
from ..runtime.observer import Observer
from ..system.system import System
from ..time.time_loop import AnySize, Moment, moments
from .reciprocating_problem import ReciprocatingProblem
from .stroke import positions


class ReciprocatingHistory(AnalysisHistory[Moment]):
    """History of cycle-averaged wear in reciprocating sliding."""

    def __init__(self, system: System, settings: ReciprocatingAnalysis, observer: Observer):
        super().__init__(system, settings, observer)
        self._timed = settings
        self._problem = ReciprocatingProblem(system, positions(system, settings))

    def states(self, last: Moment | None) -> Iterator[Moment]:
        sizes = AnySize(self._timed.max_jump / self._timed.frequency)
        return moments(self._problem, self._timed, None, sizes, last)

    def rows_of(self, moment: Moment) -> list[HistoryRow]:
        system, state = self._system, moment.state
        volumes = self._volumes(state.worn)
        mean_speed = float(np.average(system.speed, weights=system.weights))
        largest, area, motion = self._problem.of_cycle(state.contact)
        row = HistoryRow(
            time=moment.time,
            sliding_distance=mean_speed * moment.time,
            max_pressure=largest,
            contact_area=area,
            wear_volume_1=volumes[0],
            wear_volume_2=volumes[1],
            max_temperature=float("nan"),
            approach=float(system.approaches @ motion),
            step=moment.step,
            error=moment.error,
        )
        return [row]

    def snapshot(self, moment: Moment) -> Snapshot:
        """Contact and bodies at mid-stroke of body 1, and the worn track; every rank calls."""
        system, state = self._system, moment.state
        worn, rates = (
            self._at_points(v) for v in (state.worn, self._problem.rates(state.pressure))
        )
        solution = interface_problem(system).worn(worn.sum(axis=0))
        contact = contact_state(system, solution.pressure)
        found = snapshot(system, contact, system.motions(solution.motion), worn, rates)
        return replace(found, track=self._worn_track(state))

    def _worn_track(self, state: InterfaceState) -> WornTrack:
        """Worn depths and wear rates along the face of body 2."""
        face = self._system.pairing.sides[1].face
        rates = self._problem.rates(state.pressure)
        ends = face.position(np.arange(len(face.nodes)), np.ones(len(face.nodes)))
        x = np.interp(
            self._problem.track.position,
            np.concatenate([[0.0], ends]),
            np.concatenate([face.nodes[:1, 0, 0], face.nodes[:, -1, 0]]),
        )
        return WornTrack(x, self._problem.split(state.worn)[1], self._problem.split(rates)[1])

    def summary(self) -> dict:
        rows, pressure = self.table(HistoryRow), self.last.state.pressure
        row = rows[-1]
        volumes = self._volumes(self._problem.rates(pressure))
        lengths = (area.sum() for area in self._problem.areas)
        means = [float(volume / area) for volume, area in zip(volumes, lengths, strict=True)]
        return {
            "steps": len(rows) - 1,
            "time_s": row.time,
            "cycles": row.time * self._timed.frequency,
            "sliding_distance_m": row.sliding_distance,
            "distance_from_steady": self.last.distance,
            "max_pressure_of_cycle_Pa": row.max_pressure,
            "wear_volume_1_m3": row.wear_volume_1,
            "wear_volume_2_m3": row.wear_volume_2,
            "mean_wear_rate_1_m_per_s": means[0],
            "mean_wear_rate_2_m_per_s": means[1],
        }

    def _at_points(self, depths: np.ndarray) -> np.ndarray:
        """Depths (or rates) of both bodies at the mid-stroke points, shape (2, n)."""
        system, (on_1, on_2) = self._system, self._problem.split(depths)
        hats = self._problem.track.hats(system.pairing)
        return np.array([system.basis @ on_1, hats @ on_2])

    def _volumes(self, depths: np.ndarray) -> list[float]:
        pairs = zip(self._problem.areas, self._problem.split(depths), strict=True)
        return [float(area @ depth) for area, depth in pairs]

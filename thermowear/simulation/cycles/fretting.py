"""Fretting analysis: stick, slip and wear along load histories and through their cycles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...model.analyses import FrettingAnalysis
from ...results import CycleRow, LoadRow, TangentialRow
from ..interface.body_state import contact_state
from ..results.recording import Snapshot, snapshot
from ..runtime.history import AnalysisHistory
from ..runtime.observer import AnyRow, Observer
from ..system.system import System
from .fretting_path import FrettingPath
from .fretting_rows import (
    contact_rows,
    contact_summary,
    cycle_row,
    holder_rows,
    holder_summary,
    known,
    load_row,
    stick_rows,
    tangential_rows,
    tangential_summary,
)
from .fretting_state import FrettingState
from .load_path import Increment


class FrettingHistory(AnalysisHistory[Increment]):
    """History of the increments of a load history and of its cycles.

    Raises
    ------
    CaseError
        If the holder has no load history.
    """

    phase = "load steps"

    def __init__(self, system: System, settings: FrettingAnalysis, observer: Observer):
        super().__init__(system, settings, observer)
        self._path = FrettingPath(system, settings, observer.note)
        self._repeats = settings.cycles > 1
        begin, turn = self._path.cycle_of_history or (0.0, np.inf)
        self._duration = turn - begin
        self._cycle: list[Increment] = []  # increments of the current cycle, and that before it
        self._turn: Increment | None = None  # end of the last jump, or of the first pass
        self._per_cycle = np.zeros((2, len(system.weights)))

    def states(self, last: Increment | None) -> Iterator[Increment]:
        return self._path.increments(last)

    def rows_of(self, state: Increment) -> list[AnyRow]:
        if self._cycle and self._cycle[-1].segment.cycle != state.segment.cycle:
            self._cycle = self._cycle[-1:]
        self._cycle.append(state)
        system, path, at = self._system, self._path, self._state(state)
        rows: list[AnyRow] = [load_row(path.loads, at)]
        if not system.model.is_pair:
            before = None if self._last is None else self._state(self._last)
            rows += [*contact_rows(at, before, path.duration(state)), *stick_rows(at)]
            rows += holder_rows(path.loads, at, path.reactions(state.state))
        if at.in_space:
            rows += tangential_rows(path.loads, at, path.reactions(state.state))
        if state.jump is not None:
            assert self._turn is not None  # the first pass ends before the first jump
            start, end = (self._state(i).depths for i in (self._turn, state))
            self._per_cycle = (end - start) / state.jump.cycles
            radii = self._stick_radii()
            radius = radii[0] if system.model.is_pair else np.nan
            rows.append(cycle_row([self._state(i) for i in self._cycle], radius))
        if state.restart is not None:
            self._turn = state
        return rows

    def _state(self, increment: Increment) -> FrettingState:
        return FrettingState(self._system, increment, self._path.frame, self._path.basis)

    def may_restart(self, state: Increment) -> bool:
        """True at the end of a jump and, before cycle 1, of a segment."""
        return state.restart is not None

    def restart_data(self) -> np.ndarray:
        """Worn depth per cycle on both bodies, shape (2, n) [m]."""
        return self._per_cycle

    def restore(self, data: np.ndarray) -> None:
        self._turn, self._cycle, self._per_cycle = self.last, [self.last], data

    def frame_number(self, state: Increment) -> int | None:
        """Number of the computed cycle at its end, or of the increment of a single cycle."""
        if not self._repeats:
            return len(self.table(LoadRow)) - 1
        return None if state.jump is None else len(self.table(CycleRow)) - 1

    def snapshot(self, state: Increment) -> Snapshot:
        """Contact and bodies, with wear rates averaged over the cycle; every rank calls."""
        system, at = self._system, self._state(state)
        moved = self._path.loads.of_holders(state.state.motion)
        rates = self._per_cycle / self._duration
        contact = contact_state(system, at.pressure, at.shear_vectors)
        found = snapshot(system, contact, moved, at.depths, rates)
        gap = found.interface.gap + self._path.basis @ self._slid_along(state)
        interface = replace(found.interface, gap=gap)
        return replace(found, interface=interface, friction=at.friction)

    def summary(self) -> dict:
        last, cycles = self.table(LoadRow)[-1], self.table(CycleRow)
        per_cycle = self._per_cycle @ self._system.weights if cycles else (None, None)
        return {
            "steps": len(self.table(LoadRow)),
            "time_s": last.time,
            "cycles": cycles[-1].cycle if cycles else 0,
            **self._of_parts(last),
            "tangential_force_N": last.tangential_force,
            "tangential_displacement_m": last.tangential_displacement,
            "stick_area_m2": last.stick_area,
            "dissipated_energy_J": last.dissipated,
            "wear_volume_per_cycle_1_m3": per_cycle[0],
            "wear_volume_per_cycle_2_m3": per_cycle[1],
            "wear_volume_error_estimate_relative": self._state(self.last).edge_error(),
        }

    def _of_parts(self, last: LoadRow) -> dict:
        """Forces of a pair; numbers of each contact and holder of several bodies."""
        at, path, model = self._state(self.last), self._path, self._system.model
        cycles = self.table(CycleRow)
        if model.is_pair:
            across = self.table(TangentialRow)
            radius = cycles[-1].stick_radius if cycles else self._stick_radii()[0]
            return {
                "normal_force_N": last.normal_force,
                "friction_force_N": abs(last.tangential_force),
                "stick_radius_m": known(radius),
                "guide_force_N": None,
                **(tangential_summary(across[-1]) if across else {}),
            }
        rows = contact_rows(at), stick_rows(at), self._stick_radii()
        contacts = zip(model.interfaces, map(contact_summary, *rows), strict=True)
        held = holder_rows(path.loads, at, path.reactions(self.last.state))
        holders = zip(model.holders, map(holder_summary, held), strict=True)
        return {
            "contacts": {one.name: found for one, found in contacts},
            "holders": {one.name: found for one, found in holders},
        }

    def _stick_radii(self) -> list[float]:
        """Radii of the stick zones of the current cycle, before the first one at its instant."""
        cycle = self._cycle if self._cycle[-1].segment.cycle else self._cycle[-1:]
        return self._path.stick_radii([each.state for each in cycle])

    def _slid_along(self, increment: Increment) -> np.ndarray:
        """Gap change of the worn profiles by the slip of the first bodies, coefficients [m]."""
        worn, profiles = increment.state.worn, self._path.profiles
        moved, still = self._path.travel(increment.state), 0 * self._path.travel(increment.state)
        parts = (
            (own.interpolation(moved) - own.interpolation(still)) @ depth
            for own, depth in zip(profiles, worn, strict=True)
        )
        return sum(parts, start=np.zeros(self._path.basis.shape[1]))

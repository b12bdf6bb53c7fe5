"""History of a fretting analysis: rows of increments and cycles, stick-slip states."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...contact.friction.slip_wear import WornProfile
from ...contact.friction.stick_slip_state import StickSlipState
from ...laws.motions import translation
from ..interface.body_state import contact_state
from ..model.system import System
from ..results.recording import interface_at
from ..results.rows import CycleRow, LoadRow
from ..runtime.history import AnalysisHistory, Snapshot
from ..runtime.observer import Observer
from .fretting_tables import FrettingTables
from .increments import Increment


class FrettingHistory(AnalysisHistory[Increment]):
    """History of the increments of a load history and of its cycles.

    Parameters
    ----------
    system : System
    observer : Observer
    translations : ndarray, shape (k, 2)
        Unit translations of the holder.
    profiles : tuple of WornProfile
        Worn profiles of the wearing bodies.
    """

    def __init__(
        self,
        system: System,
        observer: Observer,
        translations: np.ndarray,
        profiles: tuple[WornProfile, ...],
    ):
        super().__init__(system, observer)
        self._tables_of = FrettingTables(system)
        self._translations = translations
        self._profiles = profiles
        self._cycle: list[Increment] = []  # increments of the current cycle, and that before it
        self._turn: Increment | None = None  # end of the last jump, or of the first pass
        self._per_cycle = np.zeros((2, len(system.weights)))

    def rows_of(self, state: Increment) -> list[LoadRow | CycleRow]:
        if self._cycle and self._cycle[-1].segment.cycle != state.segment.cycle:
            self._cycle = self._cycle[-1:]
        self._cycle.append(state)
        rows: list[LoadRow | CycleRow] = [self._tables_of.row(state)]
        if state.jump is not None:
            assert self._turn is not None  # the first pass ends before the first jump
            start, end = (self._tables_of.depths(i.state) for i in (self._turn, state))
            self._per_cycle = (end - start) / state.jump.cycles
            rows.append(self._tables_of.cycle(self._cycle, state.jump))
        if state.restart is not None:
            self._turn = state
        return rows

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
        if (self._system.case.cycles or 1) == 1:
            return len(self.table(LoadRow)) - 1
        return None if state.jump is None else len(self.table(CycleRow)) - 1

    def snapshot(self, state: Increment) -> Snapshot:
        """Contact and bodies, with wear rates averaged over the cycle; every rank calls."""
        system, end = self._system, state.state
        pressure, shear = system.basis @ end.pressure, system.basis @ end.shear[:, 0]
        moved = translation(end.motion @ self._translations)
        history = system.case.load.history
        assert history is not None  # the case has been checked
        begin, turn = history.cycle or (0.0, np.inf)
        rates = self._per_cycle / (turn - begin)
        contact = contact_state(system, pressure, shear)
        bodies, found = interface_at(system, contact, moved, self._tables_of.depths(end), rates)
        found = replace(found, gap=found.gap + system.basis @ self._slid_along(end))
        friction = self._tables_of.friction(end)
        return Snapshot(system, contact, moved, bodies, found, friction)

    def summary(self) -> dict:
        last, cycles = self.table(LoadRow)[-1], self.table(CycleRow)
        per_cycle = self._per_cycle @ self._system.weights if cycles else (None, None)
        return {
            "steps": len(self.table(LoadRow)),
            "time_s": last.time,
            "cycles": cycles[-1].cycle if cycles else 0,
            "normal_force_N": last.normal_force,
            "friction_force_N": abs(last.tangential_force),
            "guide_force_N": None,
            "tangential_force_N": last.tangential_force,
            "tangential_displacement_m": last.tangential_displacement,
            "stick_area_m2": last.stick_area,
            "dissipated_energy_J": last.dissipated,
            "wear_volume_per_cycle_1_m3": per_cycle[0],
            "wear_volume_per_cycle_2_m3": per_cycle[1],
        }

    def _slid_along(self, state: StickSlipState) -> np.ndarray:
        """Gap change of the worn profiles by the slip of body 1, coefficients [m]."""
        nothing = np.zeros(self._system.basis.shape[1])
        if len(state.motion) < 2:
            return nothing
        pairs = zip(self._profiles, state.worn, strict=True)
        return sum((own.seen(state.motion[1]) @ ω - ω for own, ω in pairs), start=nothing)

"""Record of the increments, cycles and outputs of a fretting analysis."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...contact.friction.slip_wear import WornProfile
from ...contact.friction.stick_slip_state import StickSlipState
from ...laws.motions import translation
from ...results import CycleRow, FrictionHistory, FrictionInterface, InterfaceFields, LoadRow
from ...serialise import serialisable
from ..interface.body_state import BodyState, ContactState, contact_state
from ..model.system import System
from ..results.recording import interface_at
from ..runtime.frames import FrameRecorder, Shown
from ..runtime.observer import Observer
from .fretting_tables import FrettingTables
from .increments import Increment, Jump


@serialisable
@dataclass(frozen=True)
class Fretted:
    """Progress of a fretting analysis: the data needed to restart it.

    Attributes
    ----------
    last : Increment
        Increment to restart from.
    per_cycle : ndarray, shape (2, n)
        Worn depth per cycle on both bodies [m].
    rows : list of LoadRow
    cycles : list of CycleRow
    """

    last: Increment
    per_cycle: np.ndarray
    rows: list[LoadRow]
    cycles: list[CycleRow]

    @property
    def time(self) -> float:
        return self.last.time


class FrettingRecord:
    """Recorder of the increments, cycles and outputs so far.

    Parameters
    ----------
    system : System
    translations : ndarray, shape (k, 2)
        Unit translations of the holder.
    profiles : tuple of WornProfile
        Worn profiles of the wearing bodies.
    observer : Observer
        Observer notified of each record.
    """

    last: StickSlipState

    def __init__(
        self,
        system: System,
        translations: np.ndarray,
        profiles: tuple[WornProfile, ...],
        observer: Observer,
    ):
        self.outputs: dict[float, InterfaceFields] = {}
        self._system = system
        self._tables = FrettingTables(system)
        self._translations = translations
        self._profiles = profiles
        self._observer = observer
        self._film = FrameRecorder(system.case, observer)
        self._rows: list[LoadRow] = []
        self._cycles: list[CycleRow] = []
        self._frictions: dict[float, FrictionInterface] = {}
        self._now: list[Increment] = []  # increments of the current cycle
        self._turn: Increment | None = None  # end of the last jump
        self._begin: tuple[Increment, int] | None = None  # restart increment, number of rows
        self._per_cycle = np.zeros((2, len(system.weights)))

    def go_on(self, before: Fretted) -> Increment:
        """Restore the record of an earlier run; return the increment to restart from."""
        last = before.last
        self._turn = None if last.jump is None else last
        self._now, self.last, self._begin = [last], last.state, (last, len(before.rows))
        self._rows, self._cycles = before.rows, before.cycles
        self._per_cycle = before.per_cycle
        for rows in (self._rows, self._cycles):
            self._observer.resumed(rows)
        return last

    def progress(self) -> Fretted | None:
        """Progress up to the last restart point (end of a jump or, before cycle 1, a segment)."""
        if self._begin is None:
            return None
        last, count = self._begin
        return Fretted(last, self._per_cycle, self._rows[:count], self._cycles)

    def keep(self, instant: Increment) -> None:
        """Record the end of an increment."""
        leg = instant.leg
        self.last = instant.state
        self._rows.append(self._tables.row(instant))
        self._observer.load_step(self._rows[-1])
        if self._now and self._now[-1].leg.cycle != leg.cycle:
            self._now = self._now[-1:]  # start of the cycle
        self._now.append(instant)
        if instant.behind is not None:
            self._begin = instant, len(self._rows)
        if instant.jump is not None:
            self._cycles.append(self._cycle(instant.jump))
            self._observer.cycle(self._cycles[-1])
        if instant.is_output:
            with self._system.phases("output"):
                self._frictions[leg.end] = self._tables.friction(self.last)
                _, bodies, self.outputs[leg.end] = self.interface()
                bodies.require_balance()
                self._observer.output(leg.end, self.outputs[leg.end], self._frictions[leg.end])
        self._keep_frame(instant)

    def _keep_frame(self, instant: Increment) -> None:
        """Record a frame per jump end, or per increment if there is only one cycle."""
        one = (self._system.case.cycles or 1) == 1
        if one or instant.jump is not None:
            number = len(self._rows if one else self._cycles) - 1
            self._film.take(self._system, number, instant.time, self._shown)

    def _shown(self) -> Shown:
        contact, bodies, interface = self.interface()
        return contact, translation(self.last.motion @ self._translations), bodies, interface

    def interface(self) -> tuple[ContactState, BodyState, InterfaceFields]:
        """Contact, bodies and interface in the last state, wear rates averaged over its cycle."""
        system, state = self._system, self.last
        pressure, shear = system.basis @ state.pressure, system.basis @ state.shear[:, 0]
        moved = translation(state.motion @ self._translations)
        history = system.case.load.history
        assert history is not None  # the case has been checked
        begin, end = history.cycle or (0.0, np.inf)
        rates = self._per_cycle / (end - begin)
        contact = contact_state(system, pressure, shear)
        bodies, found = interface_at(system, contact, moved, self._tables.depths(state), rates)
        return contact, bodies, replace(found, gap=found.gap + system.basis @ self._slid_along())

    def _slid_along(self) -> np.ndarray:
        """Gap change of the worn profiles by the slip of body 1, coefficients [m]."""
        state, nothing = self.last, np.zeros(self._system.basis.shape[1])
        if len(state.motion) < 2:
            return nothing
        pairs = zip(self._profiles, state.worn, strict=True)
        return sum((own.seen(state.motion[1]) @ ω - ω for own, ω in pairs), start=nothing)

    def history(self) -> FrictionHistory:
        """Histories and friction tables recorded so far."""
        return FrictionHistory(
            self._rows, self._cycles, self._tables.friction(self.last), self._frictions
        )

    def extra(self) -> dict:
        """Summary entries of a fretting analysis."""
        last, w = self._rows[-1], self._system.weights
        per_cycle = self._per_cycle @ w if self._cycles else (None, None)
        return {
            "steps": len(self._rows),
            "time_s": last.time,
            "cycles": self._cycles[-1].cycle if self._cycles else 0,
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

    def _cycle(self, jump: Jump) -> CycleRow:
        """Row of the cycle just ended, the last of a jump."""
        turn, last = self._turn or self._now[0], self._now[-1]
        start, end = (self._tables.depths(instant.state) for instant in (turn, last))
        self._per_cycle, self._turn = (end - start) / jump.cycles, last
        return self._tables.cycle(self._now, jump)

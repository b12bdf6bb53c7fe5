"""What a fretting analysis keeps of the increments and cycles that it goes through."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..case.oscillation import cycles
from ..contact.slip_wear import Profile
from ..contact.stick_slip import StickSlipState
from ..laws.motions import translation
from .checkpoint import can_be_packed
from .cycle_jump import Instant, Jump
from .film import Film, Shown
from .observer import Observer
from .recording import interface_at
from .result import CycleRow, FrictionHistory, FrictionInterface, Interface, LoadRow
from .state import BodyState, ContactState, contact_state
from .system import System

_SLIDES = 1 - 1e-6  # of friction's limit


@can_be_packed
@dataclass(frozen=True)
class Fretted:
    """How far a fretting analysis has come: all that it needs to go on.

    Attributes
    ----------
    last : Instant
        From which it can go on.
    per_cycle : ndarray, shape (2, n)
        Depths that a cycle of it wears off both bodies [m].
    rows : list of LoadRow
    cycles : list of CycleRow
    """

    last: Instant
    per_cycle: np.ndarray
    rows: list[LoadRow]
    cycles: list[CycleRow]

    @property
    def time(self) -> float:
        return self.last.time


class FrettingRecord:
    """Increments, cycles and outputs so far.

    Parameters
    ----------
    system : System
    translations : ndarray, shape (k, 2)
        Of the holder.
    profiles : tuple of Profile
        Of the wearing bodies.
    observer : Observer
        Told of each of them.
    """

    last: StickSlipState

    def __init__(
        self,
        system: System,
        translations: np.ndarray,
        profiles: tuple[Profile, ...],
        observer: Observer,
    ):
        self.outputs: dict[float, Interface] = {}
        self._system = system
        self._translations = translations
        self._profiles = profiles
        self._observer = observer
        self._film = Film(system.case, observer)
        self._rows: list[LoadRow] = []
        self._cycles: list[CycleRow] = []
        self._frictions: dict[float, FrictionInterface] = {}
        self._now: list[Instant] = []  # of the cycle that is computed
        self._turn: Instant | None = None  # where the last jump ended
        self._begin: tuple[Instant, int] | None = None  # to go on from, and its number of rows
        self._per_cycle = np.zeros((2, len(system.weights)))

    def go_on(self, before: Fretted) -> Instant:
        """Take up what was kept before."""
        last = before.last
        self._turn = None if last.jump is None else last
        self._now, self.last, self._begin = [last], last.state, (last, len(before.rows))
        self._rows, self._cycles = before.rows, before.cycles
        self._per_cycle = before.per_cycle
        for rows in (self._rows, self._cycles):
            self._observer.resumed(rows)
        return last

    def progress(self) -> Fretted | None:
        """To where it can go on from: not the middle of a leg, or of a jump."""
        if self._begin is None:
            return None
        last, count = self._begin
        return Fretted(last, self._per_cycle, self._rows[:count], self._cycles)

    def keep(self, instant: Instant) -> None:
        """Take up the end of an increment."""
        leg = instant.leg
        self.last = instant.state
        self._rows.append(self._row(instant))
        self._observer.load_step(self._rows[-1])
        if self._now and self._now[-1].leg.cycle != leg.cycle:
            self._now = self._now[-1:]  # where the cycle begins
        self._now.append(instant)
        if instant.behind is not None:
            self._begin = instant, len(self._rows)
        if instant.jump is not None:
            self._cycles.append(self._cycle(instant.jump))
            self._observer.cycle(self._cycles[-1])
        if instant.is_output:
            with self._system.phases("output"):
                self._frictions[leg.end] = self._friction()
                self.outputs[leg.end] = self.interface()[2]
                self._observer.output(leg.end, self.outputs[leg.end], self._frictions[leg.end])
        self._keep_frame(instant)

    def _keep_frame(self, instant: Instant) -> None:
        """Show ends of cycles, or of increments where there is but one cycle."""
        one = (cycles(self._system.case) or 1) == 1
        if one or instant.jump is not None:
            number = len(self._rows if one else self._cycles) - 1
            self._film.take(self._system, number, instant.time, self._shown)

    def _shown(self) -> Shown:
        contact, bodies, interface = self.interface()
        return contact, translation(self.last.motion @ self._translations), bodies, interface

    def interface(self) -> tuple[ContactState, BodyState, Interface]:
        """Contact, bodies and interface in the last state; wear rates are means of its cycle."""
        system, state = self._system, self.last
        pressure, shear = system.basis @ state.pressure, system.basis @ state.shear[:, 0]
        moved = translation(state.motion @ self._translations)
        history = system.case.load.history
        assert history is not None  # the case has been checked
        begin, end = history.cycle or (0.0, np.inf)
        rates = self._per_cycle / (end - begin)
        contact = contact_state(system, pressure, shear)
        bodies, found = interface_at(system, contact, moved, self._depths(state), rates)
        return contact, bodies, replace(found, gap=found.gap + system.basis @ self._slid_along())

    def _slid_along(self) -> np.ndarray:
        """What the profiles open more than in place, as body 1 has slid, coefficients [m]."""
        state, nothing = self.last, np.zeros(self._system.basis.shape[1])
        if len(state.motion) < 2:
            return nothing
        pairs = zip(self._profiles, state.worn, strict=True)
        return sum((own.seen(state.motion[1]) @ ω - ω for own, ω in pairs), start=nothing)

    def history(self) -> FrictionHistory:
        """All of it."""
        return FrictionHistory(self._rows, self._cycles, self._friction(), self._frictions)

    def extra(self) -> dict:
        """What a fretting analysis adds to the summary."""
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

    def _depths(self, state: StickSlipState) -> np.ndarray:
        """Depths worn off both bodies at the points, shape (2, n) [m]."""
        system = self._system
        both = np.zeros((2, len(system.weights)))
        both[list(system.laws)] = state.worn @ system.basis.T
        return both

    def _row(self, instant: Instant) -> LoadRow:
        system, state = self._system, instant.state
        w, pressure = system.weights, system.basis @ state.pressure
        forces, motions = (np.append(v, [0.0, 0.0]) for v in (state.force, state.motion))
        volumes = self._depths(state) @ w
        return LoadRow(
            time=instant.time,
            normal_force=float(forces[0]),
            approach=float(motions[0]),
            tangential_force=float(forces[1]),
            tangential_displacement=float(motions[1]),
            max_pressure=float(pressure.max()),
            contact_area=float(w[pressure > 0].sum()),
            stick_area=float(w[self._sticking(state)].sum()),
            dissipated=float(w @ state.dissipated),
            iterations=state.iterations,
            cycle=instant.leg.cycle,
            wear_volume_1=float(volumes[0]),
            wear_volume_2=float(volumes[1]),
        )

    def _cycle(self, jump: Jump) -> CycleRow:
        """The cycle that has ended just now, the last of a jump."""
        w, last = self._system.weights, self._now[-1]
        turn = self._turn or self._now[0]
        start, end = (self._depths(instant.state) for instant in (turn, last))
        self._per_cycle, self._turn = (end - start) / jump.cycles, last
        pressures = np.array([i.state.pressure for i in self._now]) @ self._system.basis.T
        return CycleRow(
            cycle=last.leg.cycle,
            time=last.time,
            wear_volume_1=float(end[0] @ w),
            wear_volume_2=float(end[1] @ w),
            dissipated=float(w @ last.state.dissipated),
            max_wear_1=float(end[0].max()),
            max_wear_2=float(end[1].max()),
            contact_area=float(w[(pressures > 0).any(axis=0)].sum()),
            max_pressure=float(pressures.max()),
            jump=jump.cycles,
            error=jump.error,
        )

    def _sticking(self, state: StickSlipState) -> np.ndarray:
        """Points whose shear is below friction's limit, shape (n,)."""
        basis = self._system.basis
        pressure, shear = basis @ state.pressure, basis @ state.shear[:, 0]
        return np.abs(shear) < _SLIDES * self._system.friction * pressure

    def _friction(self) -> FrictionInterface:
        """Sticking and slipping in the last state."""
        system, state = self._system, self.last
        points, pressure = system.pairing.points, system.basis @ state.pressure
        status = np.where(pressure > 0, np.where(self._sticking(state), 1, 2), 0)
        return FrictionInterface(
            x=points[:, 0],
            y=points[:, 1],
            s=system.pairing.position,
            weight=system.weights,
            pressure=pressure,
            shear=system.basis @ state.shear[:, 0],
            slip=state.point_slip[:, 0],
            dissipated=state.dissipated,
            status=status,
        )

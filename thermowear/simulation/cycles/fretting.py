"""Fretting analysis: stick, slip and wear along a load history and through its cycles."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...contact.friction.slip_wear import SlipWear, profile
from ...contact.friction.stick_slip import advance, follow
from ...contact.friction.stick_slip_state import Loads, StickSlipState, unloaded
from ...contact.operators.tangential import condense_tangential
from ...errors import CaseError
from ...laws.motions import translation
from ...model.analyses import FrettingAnalysis
from ...results import CycleRow, FrictionInterface, LoadRow
from ..interface.body_state import contact_state
from ..results.recording import Snapshot, snapshot
from ..runtime.history import AnalysisHistory
from ..runtime.observer import Observer
from ..system.system import System
from .cycle_jump import adaptive_jumps, fixed_jumps
from .load_path import Increment, Jump, LoadPath, LoadSegment, RestartPoint

_SLIDES = 1 - 1e-6  # fraction of the friction limit from which a point slips
_ACROSS = (1.0, 0.0)


class FrettingPath:
    """Increments of a contact along its load history and through the cycles.

    Parameters
    ----------
    system : System
    settings : FrettingAnalysis

    Attributes
    ----------
    cycle_of_history : tuple of float or None
        Start and end of the repeated part of the load history [s].
    translations : ndarray, shape (k, 2)
        Unit translations of the holder: along the load, and along x under tangential loads.
    profiles : tuple of WornProfile
        Worn profiles of the wearing bodies.
    areas : ndarray, shape (m,)
        Areas of the basis functions of the depths [m²].

    Raises
    ------
    CaseError
        If the holder has no load history.
    """

    def __init__(self, system: System, settings: FrettingAnalysis):
        history = system.model.holder.history
        if history is None:
            raise CaseError("load.history: missing; required in a fretting analysis")
        self._holder, self._settings = system.model.holder, settings
        self._path = LoadPath(history, settings.output_times)
        self._friction = system.model.interface.nominal_friction
        self._laws = tuple(system.laws.values())
        self.cycle_of_history = history.cycle
        across = [_ACROSS] if history.tangential else []
        self.translations = np.array([system.model.holder.load_direction, *across])
        bodies = system.elastic, system.pairing, system.basis
        with system.phases("condense elasticity"):
            self._contact = condense_tangential(*bodies, self.translations)
        weighted = self._contact.weighted
        self.areas = weighted.sum(axis=0)
        self.profiles = tuple(profile(system.pairing, weighted, body) for body in system.laws)

    def increments(self, last: Increment | None = None) -> Iterator[Increment]:
        """Increments up to the start of the cycles, then through them.

        Either all increments, or the ones after an increment with a restart point.
        """
        restart, passed = RestartPoint(0, unloaded(self._contact, len(self._laws))), -math.inf
        if last is not None:
            assert last.restart is not None
            restart, passed = last.restart, last.segment.end
        if restart.cycle == 0:
            left = (segment for segment in self._path.first_pass() if segment.end > passed)
            for increment in self._along(left, restart.state):
                restart = RestartPoint(0, increment.state)
                yield increment
        if self.cycle_of_history is not None:
            yield from self._cycles_after(restart)

    def _cycles_after(self, restart: RestartPoint) -> Iterator[Increment]:
        """Increments of the cycles after a restart point."""
        settings, count = self._settings, self._settings.cycles
        if settings.jump == "auto":
            stops = self._path.cycles_to_stop_at(count)
            return adaptive_jumps(self, stops, restart, settings.tolerance, settings.max_jump)
        return fixed_jumps(self, self._path.jumped_cycles(count, settings.jump), restart)

    def cycle(self, state: StickSlipState, number: int, repeats: int) -> Iterator[Increment]:
        """See `cycle_jump.Cycles`."""
        return self._along(self._path.cycle(number, repeats), state)

    def equilibrium(self, end: Increment, worn: np.ndarray) -> StickSlipState:
        """See `cycle_jump.Cycles`."""
        state, loads = replace(end.state, worn=worn), self._loads(end.segment.instant)
        found = advance(self._contact, self._friction, state, loads, self._wear(0.0))
        return replace(found, dissipated=state.dissipated)

    def _along(self, segments: Iterator[LoadSegment], state: StickSlipState) -> Iterator[Increment]:
        count = self._settings.increments
        for segment in segments:
            loads, step = self._loads(segment.instant), (segment.end - segment.start) / count
            wear = self._wear(step, segment.repeats)
            states = follow(self._contact, self._friction, [loads], count, state, wear)
            for number, state in enumerate(states, start=1):
                time = segment.end if number == count else segment.start + number * step
                yield Increment(time, segment, number == count, state)

    def _wear(self, duration: float, repeats: int = 1) -> SlipWear:
        return SlipWear(self._laws, self.profiles, self._friction, duration, repeats)

    def _loads(self, instant: float) -> Loads:
        """Loads at a time of the history [s]."""
        given, holder = self._path.history.at(instant), self._holder
        if "force" not in given and "approach" not in given:
            return Loads(normal_force=holder.force, approach=holder.approach, **given)
        return Loads(normal_force=given.pop("force", None), **given)


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
        self._path, self._repeats = FrettingPath(system, settings), settings.cycles > 1
        begin, turn = self._path.cycle_of_history or (0.0, np.inf)
        self._duration = turn - begin
        self._cycle: list[Increment] = []  # increments of the current cycle, and that before it
        self._turn: Increment | None = None  # end of the last jump, or of the first pass
        self._per_cycle = np.zeros((2, len(system.weights)))

    def states(self, last: Increment | None) -> Iterator[Increment]:
        return self._path.increments(last)

    def rows_of(self, state: Increment) -> list[LoadRow | CycleRow]:
        if self._cycle and self._cycle[-1].segment.cycle != state.segment.cycle:
            self._cycle = self._cycle[-1:]
        self._cycle.append(state)
        rows: list[LoadRow | CycleRow] = [self._load_row(state)]
        if state.jump is not None:
            assert self._turn is not None  # the first pass ends before the first jump
            start, end = (self._depths(i.state) for i in (self._turn, state))
            self._per_cycle = (end - start) / state.jump.cycles
            rows.append(self._cycle_row(state.jump))
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
        if not self._repeats:
            return len(self.table(LoadRow)) - 1
        return None if state.jump is None else len(self.table(CycleRow)) - 1

    def snapshot(self, state: Increment) -> Snapshot:
        """Contact and bodies, with wear rates averaged over the cycle; every rank calls."""
        system, end = self._system, state.state
        pressure, shear = system.basis @ end.pressure, system.basis @ end.shear[:, 0]
        moved = translation(end.motion @ self._path.translations)
        rates = self._per_cycle / self._duration
        contact = contact_state(system, pressure, shear)
        found = snapshot(system, contact, (moved,), self._depths(end), rates)
        gap = found.interface.gap + system.basis @ self._slid_along(end)
        interface = replace(found.interface, gap=gap)
        return replace(found, interface=interface, friction=self._friction(end))

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
        zeros = np.zeros(self._system.basis.shape[1])
        if len(state.motion) < 2:
            return zeros
        pairs = zip(self._path.profiles, state.worn, strict=True)
        return sum((own.interpolation(state.motion[1]) @ ω - ω for own, ω in pairs), start=zeros)

    def _load_row(self, increment: Increment) -> LoadRow:
        """Load row at the end of an increment."""
        system, state = self._system, increment.state
        w, pressure = system.weights, system.basis @ state.pressure
        forces, motions = (np.append(v, [0.0, 0.0]) for v in (state.force, state.motion))
        volumes = self._depths(state) @ w
        return LoadRow(
            time=increment.time,
            normal_force=float(forces[0]),
            approach=float(motions[0]),
            tangential_force=float(forces[1]),
            tangential_displacement=float(motions[1]),
            max_pressure=float(pressure.max()),
            contact_area=float(w[pressure > 0].sum()),
            stick_area=float(w[self._sticking(state)].sum()),
            dissipated=float(w @ state.dissipated),
            iterations=state.iterations,
            cycle=increment.segment.cycle,
            wear_volume_1=float(volumes[0]),
            wear_volume_2=float(volumes[1]),
        )

    def _cycle_row(self, jump: Jump) -> CycleRow:
        """Cycle row at the end of a jump, from the increments of its last cycle."""
        w, last = self._system.weights, self._cycle[-1]
        end = self._depths(last.state)
        pressures = np.array([i.state.pressure for i in self._cycle]) @ self._system.basis.T
        return CycleRow(
            cycle=last.segment.cycle,
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

    def _depths(self, state: StickSlipState) -> np.ndarray:
        """Worn depths of both bodies at the contact points, shape (2, n) [m]."""
        system = self._system
        both = np.zeros((2, len(system.weights)))
        both[list(system.laws)] = state.worn @ system.basis.T
        return both

    def _friction(self, state: StickSlipState) -> FrictionInterface:
        """Stick and slip at the contact points in a state."""
        system = self._system
        points, pressure = system.contacts.on_body_1, system.basis @ state.pressure
        status = np.where(pressure > 0, np.where(self._sticking(state), 1, 2), 0)
        return FrictionInterface(
            x=points[:, 0],
            y=points[:, 1],
            s=system.contacts.position,
            weight=system.weights,
            pressure=pressure,
            shear=system.basis @ state.shear[:, 0],
            slip=state.point_slip[:, 0],
            dissipated=state.dissipated,
            status=status,
        )

    def _sticking(self, state: StickSlipState) -> np.ndarray:
        """Mask of points with shear below the friction limit, shape (n,)."""
        basis = self._system.basis
        pressure, shear = basis @ state.pressure, basis @ state.shear[:, 0]
        return np.abs(shear) < _SLIDES * self._system.friction * pressure

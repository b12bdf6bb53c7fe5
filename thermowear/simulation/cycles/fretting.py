"""Fretting analysis: stick, slip and wear along load histories."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ...model.analyses import FrettingAnalysis
from ...results import ContactRow, CycleRow, HolderRow, LoadRow, StickRow, TangentialRow
from ...results.short_names import by_name
from ..interface.body_state import contact_state
from ..results.recording import Snapshot, snapshot
from ..runtime.history import AnalysisHistory
from ..runtime.observer import AnyRow, Observer
from ..system.system import System
from .fretting_path import FrettingPath, FrettingState
from .held_loads import HeldLoads, across, axis_of
from .load_path import Increment


def load_row(loads: HeldLoads, at: FrettingState) -> LoadRow:
    """Row of ``loads.csv``: of all contacts, and of one holder."""
    w, increment, state = at.system.weights, at.increment, at.increment.state
    own = loads.by_holder[loads.shown]
    presses = [k for k in own if loads.motions[k].role == "press"]
    slides = [k for k in own if loads.motions[k].driven == 0]
    press, slide = (
        (state.force[k[0]], state.motion[k[0]]) if k else (0.0, 0.0) for k in (presses, slides)
    )
    volumes = at.depths @ w
    return LoadRow(
        time=increment.time,
        normal_force=float(press[0]),
        approach=float(press[1]),
        tangential_force=float(slide[0]),
        tangential_displacement=float(slide[1]),
        max_pressure=float(at.pressure.max()),
        contact_area=float(w[at.pressure > 0].sum()),
        stick_area=float(w[at.sticking].sum()),
        dissipated=float(w @ state.dissipated),
        iterations=state.iterations,
        cycle=increment.segment.cycle,
        wear_volume_1=float(volumes[0]),
        wear_volume_2=float(volumes[1]),
    )


def contact_rows(
    at: FrettingState, before: FrettingState | None = None, duration: float = 0.0
) -> list[ContactRow]:
    """Rows of ``contacts.csv``; friction power in an increment of a duration [s]."""
    w, nothing = at.system.weights, float("nan")
    power = np.full(len(w), np.nan) if before is None else at.power(before, duration)
    return [
        ContactRow(
            time=at.increment.time,
            contact=number,
            normal_force=float(at.normal_forces[own].sum()),
            friction_power=float(w[own] @ power[own]),
            max_pressure=float(at.pressure[own].max()),
            contact_area=float(w[own][at.pressure[own] > 0].sum()),
            wear_volume_1=float(at.depths[0, own] @ w[own]),
            wear_volume_2=float(at.depths[1, own] @ w[own]),
            max_temperature_1=nothing,
            max_temperature_2=nothing,
        )
        for number, own in enumerate(at.system.contacts.ranges, start=1)
    ]


def stick_rows(at: FrettingState) -> list[StickRow]:
    """Rows of ``sticking.csv``."""
    w, state = at.system.weights, at.increment.state
    return [
        StickRow(
            time=at.increment.time,
            contact=number,
            friction_force=at.friction_force(own),
            stick_area=float(w[own][at.sticking[own]].sum()),
            dissipated=float(w[own] @ state.dissipated[own]),
            cycle=at.increment.segment.cycle,
        )
        for number, own in enumerate(at.system.contacts.ranges, start=1)
    ]


def holder_rows(loads: HeldLoads, at: FrettingState, reactions: np.ndarray) -> list[HolderRow]:
    """Rows of ``holders.csv`` from the reactions of the holders, see `FrettingPath.reactions`."""
    rows = []
    motions = loads.of_holders(at.increment.state.motion)
    each = zip(loads.system.model.holders, motions, reactions, strict=True)
    for number, (holder, motion, (press, pull, *_, moment)) in enumerate(each, start=1):
        pivot = motion.at(np.array(holder.pivot))
        row = HolderRow(
            time=at.increment.time,
            holder=number,
            normal_force=float(press),
            approach=float(pivot @ holder.load_direction),
            tangential_force=float(pull),
            tangential_displacement=float(pivot @ across(holder)[1]),
            moment=float(moment),
            rotation=float(motion.rotation @ axis_of(holder)),
        )
        rows.append(row)
    return rows


def tangential_rows(
    loads: HeldLoads, at: FrettingState, reactions: np.ndarray
) -> list[TangentialRow]:
    """Rows of ``tangential.csv`` of bodies in space; parameters as in `holder_rows`."""
    motions = loads.of_holders(at.increment.state.motion)
    each = zip(loads.system.model.holders, motions, reactions, strict=True)
    rows = []
    for number, (holder, motion, (_, force_x, force_y, torque)) in enumerate(each, start=1):
        x, y, _ = motion.at(np.array(holder.pivot))
        row = TangentialRow(
            time=at.increment.time,
            holder=number,
            force_x=float(force_x),
            force_y=float(force_y),
            displacement_x=float(x),
            displacement_y=float(y),
            torque=float(torque),
            twist=float(motion.rotation @ axis_of(holder)),
        )
        rows.append(row)
    return rows


def cycle_row(cycle: Sequence[FrettingState], stick_radius: float) -> CycleRow:
    """Row of ``cycles.csv`` at the end of a jump, from the states of its last cycle."""
    last = cycle[-1]
    w, increment, end = last.system.weights, last.increment, last.depths
    pressures, jump = np.array([at.pressure for at in cycle]), last.increment.jump
    assert jump is not None  # it ends here
    return CycleRow(
        cycle=increment.segment.cycle,
        time=increment.time,
        wear_volume_1=float(end[0] @ w),
        wear_volume_2=float(end[1] @ w),
        dissipated=float(w @ increment.state.dissipated),
        max_wear_1=float(end[0].max()),
        max_wear_2=float(end[1].max()),
        contact_area=float(w[(pressures > 0).any(axis=0)].sum()),
        max_pressure=float(pressures.max()),
        jump=jump.cycles,
        error=jump.error,
        stick_radius=stick_radius,
    )


def contact_summary(row: ContactRow, stick: StickRow, radius: float) -> dict:
    """Numbers of a contact for the summary."""
    return {
        "normal_force_N": row.normal_force,
        "friction_force_N": abs(stick.friction_force),
        "stick_area_m2": stick.stick_area,
        "stick_radius_m": known(radius),
        "dissipated_energy_J": stick.dissipated,
    }


def known(value: float) -> float | None:
    """Number for the summary; None for NaN."""
    return None if np.isnan(value) else value


def holder_summary(row: HolderRow) -> dict:
    """Numbers of a holder for the summary."""
    return {
        "normal_force_N": row.normal_force,
        "tangential_force_N": row.tangential_force,
        "tangential_displacement_m": row.tangential_displacement,
    }


def tangential_summary(row: TangentialRow) -> dict:
    """Numbers of the tangential loads of a pair in space for the summary."""
    return {
        "friction_force_N": float(np.hypot(row.force_x, row.force_y)),
        "tangential_force_y_N": row.force_y,
        "tangential_displacement_y_m": row.displacement_y,
        "torque_Nm": row.torque,
        "twist_rad": row.twist,
    }


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
        if system.model.named:
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
            radius = radii[0] if len(radii) == 1 else np.nan
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
            **self._of_parts(),
            "tangential_force_N": last.tangential_force,
            "tangential_displacement_m": last.tangential_displacement,
            "stick_area_m2": last.stick_area,
            "dissipated_energy_J": last.dissipated,
            "wear_volume_per_cycle_1_m3": per_cycle[0],
            "wear_volume_per_cycle_2_m3": per_cycle[1],
            "wear_volume_error_estimate_relative": self._state(self.last).edge_error(),
        }

    def _of_parts(self) -> dict:
        """Numbers of each contact and holder."""
        at, path, model = self._state(self.last), self._path, self._system.model
        cycles, reactions = self.table(CycleRow), path.reactions(self.last.state)
        radii = self._stick_radii()
        if cycles and len(radii) == 1:
            radii = [cycles[-1].stick_radius]
        rows = contact_rows(at), stick_rows(at), radii
        contacts = zip(model.interfaces, map(contact_summary, *rows), strict=True)
        held = map(holder_summary, holder_rows(path.loads, at, reactions))
        across = tangential_rows(path.loads, at, reactions) if at.in_space else []
        moved = list(map(tangential_summary, across)) or [{}] * len(model.holders)
        holders = zip(model.holders, held, moved, strict=True)
        driven = {} if model.named else {"guide_force_N": None}  # is the tangential force
        return {
            **by_name("contacts", {one.name: found for one, found in contacts}),
            **by_name("holders", {one.name: found | turned for one, found, turned in holders}),
            **driven,
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

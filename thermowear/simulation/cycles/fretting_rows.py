"""Rows of a state of stick and slip."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...results import (
    ContactRow,
    CycleRow,
    HolderRow,
    LoadRow,
    StickRow,
    TangentialRow,
)
from .fretting_state import FrettingState
from .held_loads import HeldLoads, across, axis_of


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

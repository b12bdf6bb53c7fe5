"""Rows and contact points of a state of stick and slip."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...contact.operators.tangential import forwards, tangents
from ...results import ContactRow, CycleRow, FrictionInterface, HolderRow, LoadRow, StickRow
from ..system.system import System
from .held_loads import HeldLoads, across
from .load_path import Increment

_SLIDES = 1 - 1e-6  # fraction of the friction limit from which a point slips


@dataclass(frozen=True)
class FrettingState:
    """State at the end of an increment, at the contact points of a system.

    Attributes
    ----------
    system : System
    increment : Increment
    """

    system: System
    increment: Increment

    @cached_property
    def pressure(self) -> np.ndarray:
        """Pressure, shape (n,) [Pa]."""
        return self.system.basis @ self.increment.state.pressure

    @cached_property
    def shear(self) -> np.ndarray:
        """Shear traction on the first bodies, shape (n,) [Pa]."""
        return self.system.basis @ self.increment.state.shear[:, 0]

    @cached_property
    def sticking(self) -> np.ndarray:
        """Mask of points with shear below the friction limit, shape (n,)."""
        return np.abs(self.shear) < _SLIDES * self.system.friction * self.pressure

    @cached_property
    def depths(self) -> np.ndarray:
        """Worn depths of the first and of the second faces, shape (2, n) [m]."""
        system = self.system
        both = np.zeros((2, len(system.weights)))
        both[list(system.laws)] = (system.basis @ self.increment.state.worn.T).T
        return both

    @cached_property
    def sense(self) -> np.ndarray:
        """Signs of shear and slip along +x (+y on faces along y), shape (n,)."""
        contacts = self.system.contacts
        means = np.array([each.weights @ each.normals for each in contacts.each])
        return contacts.per_point(forwards(tangents(means)[0]))

    @cached_property
    def forces(self) -> tuple[np.ndarray, np.ndarray]:
        """Forces at the points, shape (n,) each [N].

        On the second bodies along the load direction of the first; and on the first bodies across
        it, along +x (+y where they are pressed along x).
        """
        system, normals = self.system, self.system.contacts.normals
        traction = self.pressure[:, None] * normals - self.shear[:, None] * tangents(normals)[0]
        along = system.load_directions
        turned = tangents(along)[0]
        press, pull = (np.einsum("ni,ni->n", traction, each) for each in (along, turned))
        return system.weights * press, -forwards(turned) * system.weights * pull

    @property
    def friction(self) -> FrictionInterface:
        """Stick and slip at the contact points."""
        system, state = self.system, self.increment.state
        points = system.contacts.on_body_1
        return FrictionInterface(
            x=points[:, 0],
            y=points[:, 1],
            s=system.contacts.position,
            weight=system.weights,
            pressure=self.pressure,
            shear=self.sense * self.shear,
            slip=self.sense * state.point_slip[:, 0],
            dissipated=state.dissipated,
            status=np.where(self.pressure > 0, np.where(self.sticking, 1, 2), 0),
        )

    def power(self, before: FrettingState, duration: float) -> np.ndarray:
        """Friction power per area in the increment, shape (n,) [W/m²]; NaN without duration."""
        slid = self.increment.state.point_slip - before.increment.state.point_slip
        return -self.shear * slid[:, 0] / (duration or np.nan)


def load_row(loads: HeldLoads, at: FrettingState) -> LoadRow:
    """Row of ``loads.csv``: of all contacts, and of one holder."""
    w, increment, state = at.system.weights, at.increment, at.increment.state
    own = loads.by_holder[loads.shown]
    roles = {loads.motions[k].role: k for k in reversed(own)}
    press, slide = (
        (0.0, 0.0) if k is None else (state.force[k], state.motion[k])
        for k in map(roles.get, ("press", "slide"))
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
            normal_force=float(at.forces[0][own].sum()),
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
            friction_force=float(at.forces[1][own].sum()),
            stick_area=float(w[own][at.sticking[own]].sum()),
            dissipated=float(w[own] @ state.dissipated[own]),
            cycle=at.increment.segment.cycle,
        )
        for number, own in enumerate(at.system.contacts.ranges, start=1)
    ]


def holder_rows(loads: HeldLoads, at: FrettingState, reactions: np.ndarray) -> list[HolderRow]:
    """Rows of ``holders.csv`` from the reactions of the holders, shape (n_holders, 3) [N, N m]."""
    rows = []
    motions = loads.of_holders(at.increment.state.motion)
    each = zip(loads.system.model.holders, motions, reactions, strict=True)
    for number, (holder, motion, (press, pull, moment)) in enumerate(each, start=1):
        pivot = motion.at(np.array(holder.pivot))
        row = HolderRow(
            time=at.increment.time,
            holder=number,
            normal_force=float(press),
            approach=float(pivot @ holder.load_direction),
            tangential_force=float(pull),
            tangential_displacement=float(pivot @ across(holder)[1]),
            moment=float(moment),
            rotation=float(motion.rotation[2]),
        )
        rows.append(row)
    return rows


def cycle_row(cycle: Sequence[FrettingState]) -> CycleRow:
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
    )


def contact_summary(rows: tuple[ContactRow, StickRow]) -> dict:
    """Numbers of a contact for the summary."""
    row, stick = rows
    return {
        "normal_force_N": row.normal_force,
        "friction_force_N": abs(stick.friction_force),
        "stick_area_m2": stick.stick_area,
        "dissipated_energy_J": stick.dissipated,
    }


def holder_summary(row: HolderRow) -> dict:
    """Numbers of a holder for the summary."""
    return {
        "normal_force_N": row.normal_force,
        "tangential_force_N": row.tangential_force,
        "tangential_displacement_m": row.tangential_displacement,
    }

"""Motions of the holders in stick-slip, their loads, and the frictional contact under them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...contact.friction.frictional_contact import FrictionalContact, condense_tangential
from ...contact.friction.stick_slip_state import Loads
from ...contact.full.full_friction import full_friction
from ...contact.operators.rigid_motion import HeldMotion
from ...errors import CaseError
from ...laws.histories import TANGENTIAL, LoadHistories
from ...laws.motions import RigidMotion, combined, rotation, translation
from ...model.conditions import Holder
from ..interface.full_method import contact_stiffness
from ..system.rigid_modes import applied
from ..system.system import System


def frictional_contact_of(
    system: System,
    held: Sequence[HeldMotion],
    frame: np.ndarray,
    note: Callable[[str], None] | None = None,
) -> FrictionalContact:
    """Frictional contact of a system. Every rank calls.

    Parameters
    ----------
    system : System
    held : sequence of HeldMotion
        Motions of the holders.
    frame : ndarray, shape (t, n, gdim)
        Tangential directions, see `tangential_frame`.
    note : callable, optional
        Receives a warning about parameters of the method out of range.

    Raises
    ------
    CaseError
        If the method knows no stick and slip.
    """
    method = system.model.method
    if method == "pointwise":
        raise CaseError('contact.method: "pointwise" does not support a fretting analysis')
    operators = system.elastic, system.contacts, system.basis, held, frame
    if method == "condensed":
        with system.phases("condense elasticity"):
            return condense_tangential(*operators)
    theta = system.model.interface.method.theta if method == "nitsche" else None
    stiffness = contact_stiffness(system, note)
    return full_friction(*operators, stiffness, theta)


_PARALLEL = 1.0 - 1e-9
"""Cosine between load direction and x from which they are parallel."""


def across(holder: Holder) -> tuple[str, np.ndarray]:
    """Name and direction of the motion under tangential loads: x; y if pressed along x."""
    along_x = abs(holder.load_direction[0]) > _PARALLEL
    name = "y" if along_x else "x"
    return name, np.eye(len(holder.load_direction))["xy".index(name)]


def axis_of(holder: Holder) -> np.ndarray:
    """Axis of moments and rotations: z in a plane, in space against the load direction, (3,)."""
    plane = len(holder.load_direction) == 2
    return np.array([0.0, 0.0, 1.0]) if plane else -np.array(holder.load_direction)


def tangential_motions(holder: Holder) -> dict[str, RigidMotion]:
    """Motions under tangential loads by name, in the order of `laws.histories.TANGENTIAL`.

    One in a plane; in space along x and y, and about the axis through the pivot against the load
    direction.

    Raises
    ------
    CaseError
        If a holder in space is pressed along x or y.
    """
    if len(holder.load_direction) == 2:
        name, direction = across(holder)
        return {name: translation(direction)}
    axis = axis_of(holder)
    if np.abs(axis[:2]).max() > _PARALLEL:
        which = f"holders.{holder.name}.direction" if holder.name else "geometry"
        raise CaseError(
            f"{which}: tangential loads in space act along x and y; the holder must not be pressed "
            "along one of them"
        )
    turn = rotation(axis, np.array(holder.pivot))
    return {"x": translation(np.eye(3)[0]), "y": translation(np.eye(3)[1]), "twist": turn}


@dataclass(frozen=True)
class DrivenMotion:
    """Motion of a holder with its load or amount over time.

    Attributes
    ----------
    holder : Holder
    index : int
        Index of the holder.
    name : str
        Name of the motion, see `Holder.free` and `tangential_motions`.
    motion : RigidMotion
    driven : int or None
        Number in `TANGENTIAL` of the loads of the history that move it; None if there are none.
    """

    holder: Holder
    index: int
    name: str
    motion: RigidMotion
    driven: int | None = None

    @property
    def role(self) -> str:
        """``"press"`` along the load, ``"slide"`` under tangential loads, else ``"other"``."""
        if self.driven is not None:
            return "slide"
        presses = self.name == "z" or self.holder.free == ("rotation",)
        return "press" if presses else "other"

    @property
    def held(self) -> HeldMotion:
        """Motion for the contact operators."""
        name = self.holder.name
        subject = f"holders.{name}: the holder" if name else "contact: body 1"
        return HeldMotion(self.motion, self.holder.bodies, self.role, subject)

    def at(self, instant: float) -> tuple[float, float]:
        """Generalised force and amount at a time of the history [s]; one of them is NaN."""
        holder, history = self.holder, self.holder.history
        given: dict[str, float | None] = {}
        given |= {} if history is None else history.at(instant)
        slid = None if self.driven is None else given.get(TANGENTIAL[self.driven][1])
        if slid is not None:
            return np.nan, slid
        if "force" not in given and "approach" not in given:
            given |= {"force": holder.force, "approach": holder.approach}
        approach = given.get("approach")
        if self.name == "z" and approach is not None:
            return np.nan, approach
        if holder.closing_moment is not None:
            return holder.closing_moment, np.nan
        moment = given.get("moment")
        turning = holder.moments if moment is None else (0.0, 0.0, moment)
        held = replace(holder, force=given.get("force"), moments=turning)
        return applied(held, self.motion) + self._pulled(given), np.nan

    def _pulled(self, given: Mapping[str, float | None]) -> float:
        """Generalised force of the tangential loads of a history on the motion."""
        turn, point = 0.0, np.array(self.holder.point)
        pull = np.zeros_like(point)
        pairs = zip(TANGENTIAL, tangential_motions(self.holder).values(), strict=False)
        for (key, _), motion in pairs:
            amount = given.get(key) or 0.0
            pull = pull + amount * motion.translation[: len(pull)]
            turn += amount * float(motion.rotation @ self.motion.rotation)
        return float(pull @ self.motion.at(point)) + turn


@dataclass(frozen=True)
class HeldLoads:
    """Holders of a system in stick-slip.

    Attributes
    ----------
    system : System

    Raises
    ------
    CaseError
        If no holder has a load history.
    """

    system: System

    def __post_init__(self):
        if not any(holder.history for holder in self.system.model.holders):
            which = "holders.NAME.history" if self.system.model.named else "load.history"
            raise CaseError(f"{which}: missing; required in a fretting analysis")
        for holder in self.system.model.holders:
            only = () if holder.history is None else holder.history.in_space
            if only and len(holder.load_direction) == 2:
                raise CaseError(f"load history: {only[0]} requires a 3d model")

    @cached_property
    def history(self) -> LoadHistories:
        """Load histories of all holders that have one."""
        each = (holder.history for holder in self.system.model.holders)
        return LoadHistories(tuple(history for history in each if history is not None))

    @cached_property
    def motions(self) -> tuple[DrivenMotion, ...]:
        """Motions by holder: its free ones, then the one of tangential loads."""
        system, found = self.system, list[DrivenMotion]()
        for index, holder in enumerate(system.model.holders):
            own = system.holder.rigid_modes[system.modes_of_holders[index]]
            driven = _driven(holder)
            found += [
                DrivenMotion(holder, index, name, mode.motion, driven.get(name))
                for name, mode in zip(holder.free, own, strict=True)
            ]
            moved = tangential_motions(holder) if driven else {}
            found += [
                DrivenMotion(holder, index, name, moved[name], number)
                for name, number in driven.items()
                if name not in holder.free
            ]
        return tuple(found)

    @property
    def held(self) -> tuple[HeldMotion, ...]:
        """Motions for the contact operators."""
        return tuple(each.held for each in self.motions)

    @property
    def reactions(self) -> tuple[HeldMotion, ...]:
        """Motions of each holder conjugate to its reactions.

        Along and across its load direction, and about its pivot; two directions across in space.
        """
        found: list[HeldMotion] = []
        for holder in self.system.model.holders:
            moved = _reacting(holder)
            found += [HeldMotion(motion, holder.bodies) for motion in moved]
        return tuple(found)

    @cached_property
    def shown(self) -> int:
        """Index of the holder in ``loads.csv``: the first with tangential loads, else a history."""
        histories = [holder.history for holder in self.system.model.holders]
        ranks = [0 if one is None else 2 if one.tangential else 1 for one in histories]
        return int(np.argmax(ranks))

    def at(self, instant: float) -> Loads:
        """Loads at a time of the histories [s]."""
        forces, motions = np.array([each.at(instant) for each in self.motions], dtype=float).T
        return Loads(forces, motions)

    def of_holders(self, amounts: np.ndarray) -> tuple[RigidMotion, ...]:
        """Motion of each holder by the amounts of all motions, shape (k,)."""
        return tuple(
            combined([self.motions[k].motion for k in own], amounts[own]) for own in self.by_holder
        )

    @cached_property
    def by_holder(self) -> tuple[np.ndarray, ...]:
        """Indices of the motions of each holder."""
        owners = np.array([each.index for each in self.motions], dtype=int)
        return tuple(
            np.flatnonzero(owners == index) for index in range(len(self.system.model.holders))
        )


def _driven(holder: Holder) -> dict[str, int]:
    """Names of the motions that a history moves, with their numbers in `TANGENTIAL`."""
    history = holder.history
    if history is None or not history.tangential:
        return {}
    return {
        name: number
        for number, name in enumerate(tangential_motions(holder))
        if history.drives(number)
    }


def _reacting(holder: Holder) -> tuple[RigidMotion, ...]:
    """Motions conjugate to the reactions of a holder."""
    pivot, dim = np.array(holder.pivot), len(holder.pivot)
    along = [across(holder)[1]] if dim == 2 else np.eye(3)[:2]
    turn = rotation(axis_of(holder), pivot)
    return translation(holder.load_direction), *map(translation, along), turn

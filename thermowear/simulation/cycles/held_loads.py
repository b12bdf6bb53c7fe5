"""Motions of the holders in stick-slip, and their loads along the load histories."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...contact.friction.stick_slip_state import Loads
from ...contact.operators.tangential import HeldMotion
from ...errors import CaseError
from ...laws.motions import RigidMotion, combined, rotation, translation
from ...laws.time_course import LoadHistories
from ...model.conditions import Holder
from ..system.rigid_modes import applied
from ..system.system import System

_PARALLEL = 1.0 - 1e-9
"""Cosine between load direction and x from which they are parallel."""


def across(holder: Holder) -> tuple[str, np.ndarray]:
    """Name and direction of the motion under tangential loads: x; y if pressed along x."""
    along_x = abs(holder.load_direction[0]) > _PARALLEL
    return ("y", np.array([0.0, 1.0])) if along_x else ("x", np.array([1.0, 0.0]))


@dataclass(frozen=True)
class DrivenMotion:
    """Motion of a holder with its load or amount over time.

    Attributes
    ----------
    holder : Holder
    index : int
        Index of the holder.
    name : str
        Name of the motion, see `Holder.free`.
    motion : RigidMotion
    """

    holder: Holder
    index: int
    name: str
    motion: RigidMotion

    @property
    def role(self) -> str:
        """``"press"`` along the load, ``"slide"`` under tangential loads, else ``"other"``."""
        if self.slides:
            return "slide"
        presses = self.name == "z" or self.holder.free == ("rotation",)
        return "press" if presses else "other"

    @property
    def slides(self) -> bool:
        """True for the motion that tangential loads of a history move."""
        history = self.holder.history
        return history is not None and history.tangential and self.name == across(self.holder)[0]

    def held(self, is_pair: bool) -> HeldMotion:
        """Motion for the contact operators."""
        subject = "contact: body 1" if is_pair else f"holders.{self.holder.name}: the holder"
        return HeldMotion(self.motion, self.holder.bodies, self.role, subject)

    def at(self, instant: float) -> tuple[float, float]:
        """Generalised force and amount at a time of the history [s]; one of them is NaN."""
        holder, history = self.holder, self.holder.history
        given: dict[str, float | None] = {}
        given |= {} if history is None else history.at(instant)
        slid, pulled = (given.get(f"tangential_{kind}") for kind in ("displacement", "force"))
        if self.slides and slid is not None:
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
        load = applied(held, self.motion)
        pull = (pulled or 0.0) * across(holder)[1]
        return load + float(pull @ self.motion.at(np.array(holder.point))), np.nan


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
            which = "load.history" if self.system.model.is_pair else "holders.NAME.history"
            raise CaseError(f"{which}: missing; required in a fretting analysis")

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
            free = zip(holder.free, own, strict=True)
            found += [DrivenMotion(holder, index, name, mode.motion) for name, mode in free]
            name, direction = across(holder)
            tangential = holder.history is not None and holder.history.tangential
            if tangential and name not in holder.free:
                found.append(DrivenMotion(holder, index, name, translation(direction)))
        return tuple(found)

    @property
    def held(self) -> tuple[HeldMotion, ...]:
        """Motions for the contact operators."""
        return tuple(each.held(self.system.model.is_pair) for each in self.motions)

    @property
    def reactions(self) -> tuple[HeldMotion, ...]:
        """Motions of each holder conjugate to its reactions.

        Along and across its load direction, and about its pivot.
        """
        found: list[HeldMotion] = []
        for holder in self.system.model.holders:
            turn = rotation((0.0, 0.0, 1.0), np.array(holder.pivot))
            shifts = translation(holder.load_direction), translation(across(holder)[1])
            found += [HeldMotion(motion, holder.bodies) for motion in (*shifts, turn)]
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

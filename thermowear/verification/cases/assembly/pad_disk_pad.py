"""Disk between two pads: against the model of one half, balances, and a disk that floats.

If both pads are equal and pressed alike, the mid-plane of the disk is a plane of symmetry: each
half is a pad on half a disk whose mid-plane has no axial displacement. With unequal pads, forces
and heat balance. A disk that is free along its axis transmits the force from one pad to the other;
if its hub is fixed, the hub takes the difference.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ....case import load
from ....results import InterfaceFields, Result
from ...check import Check, compare, compare_worst, computed

MIRRORED = "model of one half, with rollers on the mid-plane of the disk"
BALANCE = "equilibrium of each body, and of the whole"
AMBIENT, FORCE, FRICTION, SPEED = 293.15, 500.0, 0.4, 0.5
"""[K], [N], coefficient of friction, angular velocity of the disk [rad/s]."""
_LINING = {
    "young_modulus": "0.3 GPa",
    "poisson_ratio": 0.25,
    "conductivity": "2 W/(m K)",
    "expansion": "1e-5 1/K",
    "density": "2000 kg/m^3",
    "specific_heat": "900 J/(kg K)",
}
_DISK = {
    "young_modulus": "1.2 GPa",
    "poisson_ratio": 0.27,
    "conductivity": "48 W/(m K)",
    "expansion": "1.1e-5 1/K",
    "density": "7200 kg/m^3",
    "specific_heat": "460 J/(kg K)",
}
"""Much softer than iron, so that the disk bends visibly."""
_FACES = {"left": ["left_bottom", "disk_top"], "right": ["right_top", "disk_bottom"]}
"""Each pad first: the partition of heat refers to it."""
_WEAR = {"coefficient": "1e-7 1/MPa", "per": "friction-stress"}
DURATION = "8000 s"
ANALYSES: dict[str, dict[str, Any]] = {
    "unworn": {"type": "initial"},
    "steady": {"type": "steady"},
    "after running-in": {"type": "transient", "end_time": DURATION, "tolerance": 1e-3},
}


@dataclass(frozen=True)
class Brake:
    """Case of a disk between two pads, or of one of its halves.

    Attributes
    ----------
    disk : str
        ``"half"``: a pad on half a disk; ``"clamped"``: both pads pressed on a disk that is
        clamped at its inner radius; ``"floating"``, ``"fixed"``: the left pad is pressed, the right
        one is fixed, and the disk has a hub that slides along its axis, or does not.
    right : float
        Height of the right pad, that of the left one is 15 [mm].
    worn : bool
        False: nothing wears.
    heated : bool
    transient : bool
        True: temperatures in time.
    elements : int
        Along the disk.
    """

    disk: str
    right: float = 15.0
    worn: bool = True
    heated: bool = False
    transient: bool = False
    elements: int = 8

    def run(self, state: str, **tables: Any) -> Result:
        """Compute one of `ANALYSES`, with other tables on request."""
        return computed(load(self.tables(state) | tables))

    def tables(self, state: str) -> dict[str, Any]:
        """Tables of the case."""
        pads = ("left",) if self.disk == "half" else ("left", "right")
        result: dict[str, Any] = {
            "model": "axisymmetric",
            "geometry": {"type": "stack", "layers": self._layers(pads)},
            "mesh": {"degree": 3, "elements": self.elements, "grading": 0.3},
            "bodies": {"disk": dict(_DISK)} | {pad: dict(_LINING) for pad in pads},
            "contact": {"friction": FRICTION},
            "contacts": {pad: {"between": _FACES[pad]} for pad in pads},
            "holders": {pad: self._holder(pad) for pad in pads},
            "motions": {"disk": {"angular_velocity": f"{SPEED} rad/s"}},
            "wear": {"update": "never"} | (dict.fromkeys(pads, _WEAR) if self.worn else {}),
            "analysis": dict(ANALYSES[state]),
        }
        if self.disk in ("half", "clamped"):
            result["bodies"]["disk"]["fixed"] = "disk_inside"
        else:
            free = ["z"] if self.disk == "floating" else []
            result["holders"]["hub"] = {"surface": "disk_inside", "free": free}
        if self.disk == "half":
            result["bodies"]["disk"]["rollers"] = "disk_bottom"
        if self.heated:
            result["heat"] = self._heat(pads)
        return result

    def _layers(self, pads: tuple[str, ...]) -> dict[str, Any]:
        heights = {"left": 15.0, "right": self.right}
        pad = {name: {"x": ["80 mm", "130 mm"], "height": f"{heights[name]} mm"} for name in _FACES}
        disk = {"x": ["50 mm", "135 mm"], "height": "12 mm"}
        if self.disk == "half":
            return {"left": pad["left"], "disk": disk | {"height": "6 mm"}}
        return {"left": pad["left"], "disk": disk, "right": pad["right"]}

    def _holder(self, pad: str) -> dict[str, Any]:
        surface = "left_top" if pad == "left" else "right_bottom"
        if pad == "right" and self.disk in ("floating", "fixed"):
            return {"surface": surface, "free": []}
        return {"surface": surface, "force": f"{FORCE} N"}

    def _heat(self, pads: tuple[str, ...]) -> dict[str, Any]:
        backs = {"left": "left_top", "right": "right_bottom"}
        cooling = {backs[pad]: "20 W/(m^2 K)" for pad in pads}
        return {
            "conductance": "1e4 W/(m^2 K)",
            "partition": 0.05,
            "ambient": f"{AMBIENT} K",
            "cooling": cooling | {"disk_outside": "60 W/(m^2 K)"},
            "transient": self.transient,
        }


def at_contact(result: Result, name: str) -> InterfaceFields:
    """Fields at the points of one contact; of the only one in a model of two bodies."""
    fields = result.interface
    own = result.contacts.get(name, slice(None))
    return InterfaceFields(**{key: values[own] for key, values in vars(fields).items()})


def pad_disk_pad() -> Iterator[Check]:
    """Symmetric brakes against their half, then balances of unequal pads and the free disk."""
    for heated in (False, True):
        for state in ANALYSES:
            yield from halves_agree(state, heated)
    yield from halves_agree("after running-in", heated=True, transient=True)
    for disk in ("floating", "fixed", "clamped"):
        for state, transient in (("unworn", False), ("after running-in", True)):
            yield from balances(Brake(disk, 9.0, heated=True, transient=transient), state)
    yield from free_disk()


def halves_agree(
    state: str, heated: bool, transient: bool = False, elements: int = 8
) -> Iterator[Check]:
    """Fields at both contacts of a symmetric brake, and those of the half model."""
    one = Brake("half", heated=heated, transient=transient, elements=elements)
    half = one.run(state).interface
    for disk in ("clamped", "floating"):
        result = replace(one, disk=disk).run(state)
        note = _note(state, heated, transient, disk)
        for side in _FACES:
            yield from _agree(at_contact(result, side), half, f"{side} of {note}")


def _agree(found: InterfaceFields, half: InterfaceFields, note: str) -> Iterator[Check]:
    names = {"pressure": "Pa", "wear_1": "m", "shape": "m"}
    for name, unit in names.items():
        exact = getattr(half, name)
        if np.isfinite(exact).all() and exact.any():
            quantity = f"{name.replace('_', ' ')}, {note}, largest deviation [{unit}]"
            yield compare_worst(quantity, getattr(found, name), exact, 1e-9, MIRRORED)
    if np.isnan(half.temperature_1).all():
        return
    for side in (1, 2):
        rise, flux = (getattr(half, f"{key}_{side}") for key in ("temperature", "heat_flux"))
        computed = getattr(found, f"temperature_{side}") - AMBIENT
        quantity = f"temperature rise {side}, {note}, largest deviation [K]"
        yield compare_worst(quantity, computed, rise - AMBIENT, 1e-9, MIRRORED)
        quantity = f"heat flux {side}, {note}, largest deviation [W/m²]"
        computed = getattr(found, f"heat_flux_{side}")
        yield compare_worst(quantity, computed, flux, 1e-9, MIRRORED)


def balances(brake: Brake, state: str) -> Iterator[Check]:
    """Forces and heat of a brake with unequal pads."""
    result = brake.run(state)
    summary = result.summary
    note = _note(state, brake.heated, brake.transient, f"unequal pads, {brake.disk}")
    contacts, holders, bodies = (summary[key] for key in ("contacts", "holders", "bodies"))
    left, right = (contacts[name]["normal_force_N"] for name in _FACES)
    yield compare(f"force at the left, {note} [N]", left, FORCE, 1e-9, BALANCE)
    if brake.disk == "fixed":
        hub = holders["hub"]["guide_force_z_N"]
        yield compare(f"force of the hub, {note} [N]", hub, left - right, 1e-9, BALANCE, FORCE)
    else:
        yield compare(f"force at the right, {note} [N]", right, FORCE, 1e-9, BALANCE)
    if brake.disk != "clamped":
        back = holders["right"]["guide_force_z_N"]
        yield compare(f"force of the right holder, {note} [N]", back, right, 1e-9, BALANCE)
    power = summary["friction_power_W"]
    heat = sum(body["contact_heat_W"] for body in bodies.values())
    yield compare(f"heat into all bodies, {note} [W]", heat, power, 1e-9, "friction power")
    work = SPEED * sum(found["friction_torque_Nm"] for found in contacts.values())
    yield compare(f"power of the torques, {note} [W]", work, power, 1e-9, "friction power")
    fields = result.interface
    lost = sum(body["wear_volume_m3"] for body in bodies.values())
    if lost:
        known = float(fields.weight @ (fields.wear_1 + fields.wear_2))
        yield compare(f"volume lost by all bodies, {note} [m³]", lost, known, 1e-9, "wear depths")
    for key, text in (("equilibrium", "equilibrium"), ("heat_balance", "heat balance")):
        error = summary[f"{key}_relative_error"]
        yield compare(f"error of {text}, {note} [1]", error, 0.0, 1e-9, BALANCE, scale=1.0)


def free_disk() -> Iterator[Check]:
    """Place that a floating disk finds: a disk held there transmits the same pressures."""
    brake = Brake("floating", 9.0, heated=True)
    free = brake.run("unworn")
    fixed = Brake("fixed", 9.0, heated=True).run("unworn")
    place = free.summary["holders"]["hub"]["approach_m"]
    hub = {"surface": "disk_inside", "direction": [0, math.copysign(1, -place)]}
    hub |= {"approach": f"{abs(place)!r} m"}
    held = brake.run("unworn", holders=brake.tables("unworn")["holders"] | {"hub": hub})
    for side in _FACES:
        quantity = f"pressure at the {side} of a disk held where a free one floats [Pa]"
        exact = at_contact(free, side).pressure
        yield compare_worst(quantity, at_contact(held, side).pressure, exact, 1e-9, BALANCE)
    right = fixed.summary["contacts"]["right"]["normal_force_N"]
    quantity = "force of the hub of a fixed disk: at least 1 % of that of the pad [1]"
    share = min(abs(right / FORCE - 1), 0.01)
    yield compare(quantity, share, 0.01, 1e-9, "bending of the disk between its hub and the pads")


def _note(state: str, heated: bool, transient: bool, disk: str) -> str:
    heat = "temperatures in time" if transient else "hot" if heated else "cold"
    return f"{state}, {heat}, {disk}"

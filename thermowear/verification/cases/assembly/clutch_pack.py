"""Pack of clutch disks: torque of uniform wear, temperatures of the faces, balances.

In the steady state all faces wear uniformly, so that ``p v`` and hence ``p r`` is constant: each of
n faces between the radii r_i and r_o transmits the whole force F and the torque
``mu F (r_o + r_i) / 2`` (Shigley, Mechanical Engineering Design, disk clutches, uniform wear).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from ....case import load
from ....results import Result
from ...check import Check, compare, compare_worst, computed
from .pad_disk_pad import at_contact

SHIGLEY = "closed form: uniform wear, T = n mu F (r_o + r_i) / 2"
BALANCE = "equilibrium of each body, and of the whole"
INNER, OUTER = 0.055, 0.075
"""Radii of the friction faces [m]."""
FORCE, FRICTION, SPEED, AMBIENT = 2000.0, 0.12, 2.0, 353.15
"""[N], coefficient of friction, slip [rad/s], temperature of the oil [K]."""
_STEEL = {
    "young_modulus": "205 GPa",
    "poisson_ratio": 0.3,
    "conductivity": "46 W/(m K)",
    "expansion": "1.2e-5 1/K",
    "density": "7800 kg/m^3",
    "specific_heat": "470 J/(kg K)",
}
_FRICTION = {
    "young_modulus": "0.6 GPa",
    "poisson_ratio": 0.25,
    "conductivity": "0.9 W/(m K)",
    "expansion": "1.5e-5 1/K",
    "density": "1500 kg/m^3",
    "specific_heat": "1200 J/(kg K)",
}


@dataclass(frozen=True)
class Pack:
    """Case of a pack of plates in turn of steel, at rest, and of friction material, driven.

    Attributes
    ----------
    faces : int
        Number n of friction faces, even; there are n + 1 plates.
    heated : bool
    elements : int
        Along the widest plate.
    degree : int
    """

    faces: int
    heated: bool = True
    elements: int = 8
    degree: int = 3

    def run(self, **tables: Any) -> Result:
        """Compute the steady state, or another case with other tables."""
        return computed(load(self.tables() | tables))

    @property
    def plates(self) -> list[str]:
        """Names of the plates from the pressure plate downwards."""
        return [f"{('plate', 'disk')[k % 2]}_{k // 2 + 1}" for k in range(self.faces + 1)]

    @property
    def contacts(self) -> list[str]:
        """Names of the contacts from the pressure plate downwards."""
        return [f"{a}-{b}" for a, b in pairwise(self.plates)]

    def tables(self) -> dict[str, Any]:
        """Tables of the case."""
        steel, disks = self.plates[::2], self.plates[1::2]
        result: dict[str, Any] = {
            "model": "axisymmetric",
            "geometry": {"type": "stack", "layers": self._layers()},
            "mesh": {"degree": self.degree, "elements": self.elements, "grading": 0.3},
            "bodies": dict.fromkeys(steel, _STEEL) | dict.fromkeys(disks, _FRICTION),
            "contact": {"friction": FRICTION},
            "holders": self._holders(),
            "motions": {name: {"angular_velocity": f"{SPEED} rad/s"} for name in disks},
            "wear": {name: {"coefficient": "1e-8 1/MPa"} for name in disks},
            "analysis": {"type": "steady"},
        }
        if self.heated:
            result["heat"] = self._heat()
        return result

    def _layers(self) -> dict[str, Any]:
        ends = {self.plates[0]: "6 mm", self.plates[-1]: "6 mm"}
        inner, outer = f"{INNER} m", f"{OUTER} m"
        return {
            name: {"x": [inner, "80 mm"], "height": ends.get(name, "2 mm")}
            if name.startswith("plate")
            else {"x": ["50 mm", outer], "height": "1.5 mm"}
            for name in self.plates
        }

    def _holders(self) -> dict[str, Any]:
        """Pressure plate, plates that slide along their splines, and the fixed end plate."""
        first, *inside, last = self.plates
        splines = {
            name: {"surface": f"{name}_{'outside' if name.startswith('plate') else 'inside'}"}
            for name in inside
        }
        pressed = {"surface": f"{first}_top", "force": f"{FORCE} N"}
        return {first: pressed, **splines, last: {"surface": f"{last}_bottom", "free": []}}

    def _heat(self) -> dict[str, Any]:
        ends = {
            f"{self.plates[0]}_top": "500 W/(m^2 K)",
            f"{self.plates[-1]}_bottom": "500 W/(m^2 K)",
        }
        rims = {
            f"{name}_{side}": "300 W/(m^2 K)"
            for name in self.plates
            for side in ("inside", "outside")
        }
        heat = {"conductance": "2e4 W/(m^2 K)", "partition": 0.5, "ambient": f"{AMBIENT} K"}
        return heat | {"cooling": ends | rims}


def clutch_pack() -> Iterator[Check]:
    """Torque and steady wear of packs of two to sixteen faces."""
    for faces in (2, 4, 8, 16):
        yield from pack_checks(Pack(faces))
    yield from pack_checks(Pack(4, heated=False))


def pack_checks(pack: Pack) -> Iterator[Check]:
    """Torque, pressures, forces, heat balance, and temperatures of the faces of a pack."""
    result = pack.run()
    summary, contacts = result.summary, result.summary["contacts"]
    note = f"{pack.faces} faces, {'hot' if pack.heated else 'cold'}"
    torque = sum(found["friction_torque_Nm"] for found in contacts.values())
    known = pack.faces * FRICTION * FORCE * (OUTER + INNER) / 2
    yield compare(f"torque, {note} [N m]", torque, known, 1e-6, SHIGLEY)
    exact = FORCE / (2 * math.pi * (OUTER - INNER)) / result.interface.x
    quantity = f"pressure at the point of largest deviation, {note} [Pa]"
    yield compare_worst(quantity, result.interface.pressure, exact, 1e-6, SHIGLEY)
    forces = [contacts[name]["normal_force_N"] for name in pack.contacts]
    quantity = f"force at the face of largest deviation, {note} [N]"
    yield compare_worst(quantity, forces, FORCE, 1e-9, BALANCE)
    back = summary["holders"][pack.plates[-1]]["guide_force_z_N"]
    yield compare(f"force of the end plate, {note} [N]", back, FORCE, 1e-9, BALANCE)
    error = summary["equilibrium_relative_error"]
    yield compare(f"error of equilibrium, {note} [1]", error, 0.0, 1e-9, BALANCE, scale=1.0)
    if pack.heated:
        yield from _heat_checks(pack, result, note)


def _heat_checks(pack: Pack, result: Result, note: str) -> Iterator[Check]:
    summary = result.summary
    power = SPEED * pack.faces * FRICTION * FORCE * (OUTER + INNER) / 2
    heat = sum(body["contact_heat_W"] for body in summary["bodies"].values())
    yield compare(f"heat into all plates, {note} [W]", heat, power, 1e-6, SHIGLEY)
    error = summary["heat_balance_relative_error"]
    yield compare(f"error of heat balance, {note} [1]", error, 0.0, 1e-9, BALANCE, scale=1.0)
    if pack.faces < 4:
        return
    means = face_temperatures(pack, result)
    quantity = f"faces from the end to the middle, each hotter than the one before, {note} [1]"
    hotter = sum(b > a for a, b in pairwise(means[: pack.faces // 2]))
    hotter += sum(b > a for a, b in pairwise(means[: pack.faces // 2 - 1 : -1]))
    yield compare(quantity, hotter, pack.faces - 2, 1e-12, "heat flows to the cooled end plates")


def face_temperatures(pack: Pack, result: Result) -> np.ndarray:
    """Mean temperature of each face, of both bodies, shape (n,) [K]."""
    each = (at_contact(result, name) for name in pack.contacts)
    return np.array(
        [np.average((f.temperature_1 + f.temperature_2) / 2, weights=f.weight) for f in each]
    )

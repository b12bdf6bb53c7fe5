"""Glued bodies whose meshes do not match: uniform states, heat in series, and a bent ring."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from ....case import load
from ....results import Result
from ...check import Check, compare, compare_worst, computed

UNIFORM = "closed form: uniform axial stress, p = F/A and u = p Σ h/E"
IN_SERIES = "closed form: conduction in series, q = ΔT/Σ(h/k + 1/h_c)"
ONE_MESH = "one mesh without a joint"
RADIUS, FORCE, MODULUS, CONDUCTIVITY = 0.02, 800.0, 2e9, 15.0
HEIGHTS = {"upper": 0.01, "lower": 0.015, "base": 0.02}
ELEMENTS = {"upper": 5, "lower": 7, "base": 6}
HOT, CONTACT, JOINT = 60.0, 4e3, 1e3
"""Temperature difference [K], conductances of the contact and of the joint [W/(m² K)]."""


def glued_blocks() -> Iterator[Check]:
    """Patch of uniform stress, heat through a joint, and a ring of two layers bent by heat."""
    for degree in (1, 2, 4):
        yield from _patch(degree)
    for conductance in (None, JOINT):
        yield from _heat(conductance)
    yield from _bent()


def _patch(degree: int) -> Iterator[Check]:
    """Two cylinders glued on each other and pressed on a third one."""
    result = _initial({"mesh.degree": degree})
    pressure, note = FORCE / (math.pi * RADIUS**2), f"patch, degree {degree}: "
    moved = pressure * sum(HEIGHTS.values()) / MODULUS
    interface, holder = result.interface, result.summary["holders"]["top"]
    # rounding at single points: 3e-10 on some processors
    yield compare_worst(f"{note}pressure [Pa]", interface.pressure, pressure, 1e-9, UNIFORM)
    yield compare(f"{note}approach [m]", holder["approach_m"], moved, 1e-10, UNIFORM)


def _heat(conductance: float | None) -> Iterator[Check]:
    """Heat through these cylinders between two temperatures."""
    heat = {
        "conductance": f"{CONTACT} W/(m^2 K)",
        "ambient": "300 K",
        "temperature": {"upper_top": f"{300 + HOT} K", "base_bottom": "300 K"},
    }
    joint = {} if conductance is None else {"conductance": f"{conductance} W/(m^2 K)"}
    result = _initial({"mesh.degree": 2}, heat=heat, joint=joint)
    resistance = sum(HEIGHTS.values()) / CONDUCTIVITY + 1 / CONTACT + 1 / (conductance or math.inf)
    flux = HOT / resistance
    below = 300.0 + flux * HEIGHTS["base"] / CONDUCTIVITY
    note = "perfect joint: " if conductance is None else "joint with a conductance: "
    found = result.interface
    yield compare_worst(f"{note}heat flux [W/m²]", found.heat_flux_2, flux, 1e-10, IN_SERIES)
    yield compare_worst(
        f"{note}temperature of the base [K]", found.temperature_2, below, 1e-10, IN_SERIES, HOT
    )
    above = below + flux / CONTACT
    yield compare_worst(
        f"{note}temperature above it [K]", found.temperature_1, above, 1e-10, IN_SERIES, HOT
    )


def _bent() -> Iterator[Check]:
    """Steady worn shape of a hot ring of two glued layers, and of one layer of both."""
    shapes = []
    for layers in ({"back": 0.006, "pad": 0.006}, {"pad": 0.012}):
        case = load(_ring(layers))
        found = computed(case).interface
        order = np.argsort(found.x, kind="stable")
        shapes.append(found.shape[order])
    glued, whole = shapes
    yield compare_worst("bent ring: steady worn shape [m]", glued, whole, 1e-4, ONE_MESH)


def _ring(layers: dict[str, float]) -> dict[str, Any]:
    """Tables of a ring of layers of one material that turns on a plate."""
    names = [*layers, "plate"]
    top = names[0]
    ties = {
        f"joint_{one}": {"between": [f"{one}_bottom", f"{other}_top"], "tie": True}
        for one, other in pairwise(names[:-1])
    }
    steel = {"young_modulus": "200 GPa", "poisson_ratio": 0.3} | _CONDUCTS
    return {
        "model": "axisymmetric",
        "geometry": {
            "type": "stack",
            "layers": {
                name: {"x": ["20 mm", "40 mm"], "height": f"{layers.get(name, 0.02)} m"}
                for name in names
            },
        },
        "mesh": {"degree": 6, "elements": 10, "bodies": {top: {"elements": 8 + 2 * len(layers)}}},
        "bodies": {"plate": steel | {"fixed": "plate_bottom"}}
        | {name: dict(steel) for name in layers},
        "contacts": ties | {"face": {"between": ["pad_bottom", "plate_top"]}},
        "contact": {"friction": 0.3},
        "holders": {"holder": {"surface": f"{top}_top", "force": "5 kN"}},
        "motions": {"plate": {"angular_velocity": "3 rad/s"}},
        "wear": {"pad": {"coefficient": "1e-8 1/MPa", "per": "pressure"}},
        "heat": {
            "conductance": "1e4 W/(m^2 K)",
            "cooling": {"plate_bottom": "500 W/(m^2 K)", f"{top}_top": "500 W/(m^2 K)"},
        },
        "analysis": {"type": "steady"},
    }


_CONDUCTS = {"conductivity": f"{CONDUCTIVITY} W/(m K)", "expansion": "1.2e-5 1/K"}


def _initial(
    mesh: dict[str, Any],
    heat: dict[str, Any] | None = None,
    joint: dict[str, Any] | None = None,
) -> Result:
    """Contact of two glued cylinders with a base, without strain by heat."""
    solid = {"young_modulus": f"{MODULUS} Pa", "poisson_ratio": 0.3}
    if heat is not None:
        solid |= _CONDUCTS | {"expansion": "0 1/K"}
    tables: dict[str, Any] = {
        "model": "axisymmetric",
        "geometry": {
            "type": "stack",
            "layers": {
                name: {"x": ["0 m", f"{RADIUS} m"], "height": f"{height} m"}
                for name, height in HEIGHTS.items()
            },
        },
        "mesh": {
            "degree": mesh["mesh.degree"],
            "bodies": {name: {"elements": count} for name, count in ELEMENTS.items()},
        },
        "bodies": {
            "upper": solid | {"rollers": "upper_top"},
            "lower": dict(solid),
            "base": solid | {"rollers": "base_bottom"},
        },
        "contacts": {
            "joint": {"between": ["upper_bottom", "lower_top"], "tie": True} | (joint or {}),
            "face": {"between": ["lower_bottom", "base_top"]},
        },
        "holders": {"top": {"surface": "upper_top", "force": f"{FORCE} N"}},
        "analysis": {"type": "initial"},
    }
    return computed(load(tables if heat is None else tables | {"heat": heat}))

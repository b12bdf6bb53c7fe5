"""Thermoelastic instability of a layer that slides between two insulating half-planes.

A quarter of a wave, from its crest (a plane of symmetry) to where displacement along the normal and
temperature vanish, which also holds for waves of a third, a fifth, … of the length.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import pi
from typing import Any

import numpy as np

from ....case import load
from ....reference.instability import LayerBetweenInsulators
from ....results import Result
from ...check import Check, compare, compare_worst, computed

SOURCE = "harmonic temperatures and stress functions of a layer (Timoshenko and Goodier, sec. 24)"
WAVE, THICKNESS, SOFT = 0.02, 0.0064, 1e-14
"""Wave length and thickness of the layer [m], compliance between the faces [m/Pa]."""
YOUNG_MODULUS, RATIO, EXPANSION, CONDUCTIVITY, FRICTION = 2.1e11, 0.3, 1.2e-5, 50.0, 0.3
HALF_PLANES = {"rigid": (1e20, 0.0), "elastic": (1e11, 0.2)}
"""Young's modulus [Pa] and Poisson's ratio of the insulators."""
_COLD = "20 degC"
_NEARLY_INSULATING = "1e-4 W/(m^2 K)"
_CONDUCTING = 1e5
"""Conductivity of the insulators, which take no friction heat [W/(m K)]."""


def layer_instability() -> Iterator[Check]:
    """Critical speeds and modes, symmetric and antisymmetric, of one and of three quarter waves."""
    for half_planes in HALF_PLANES:
        yield from layer_checks(half_planes)


def layer_checks(half_planes: str) -> Iterator[Check]:
    """Checks of a layer between half-planes of `HALF_PLANES`."""
    result = layer(half_planes)
    known = [speed for quarters in (1, 3) for speed in critical_speeds(half_planes, quarters)]
    found = result.summary["static_speed_factors"]
    names = "symmetric", "antisymmetric", "symmetric, 3 m", "antisymmetric, 3 m"
    for name, one, exact in zip(names, found, known, strict=True):
        quantity = f"critical speed, {half_planes} half-planes, {name} [m/s]"
        yield compare(quantity, one, exact, 1e-5, SOURCE)
    quantity = f"least critical speed, {half_planes} half-planes [m/s]"
    yield compare(quantity, result.summary["critical_speed_factor"], known[0], 1e-5, SOURCE)
    yield from _shapes(result, half_planes)


def _shapes(result: Result, half_planes: str) -> Iterator[Check]:
    """Shapes of the first two modes at both contacts."""
    upper, lower = (result.columns(f"mode_{name}") for name in ("upper", "lower"))
    factors = result.summary["static_speed_factors"]
    for factor, sign, name in zip(factors, (1, -1), ("symmetric", "antisymmetric"), strict=False):
        own = (upper["speed_factor"] == factor) & (upper["growth_rate_per_s"] == 0.0)
        one, other = upper["pressure"][own], lower["pressure"][own]
        wave = np.sign(one[0]) * np.cos(2 * pi * upper["x_m"][own] / WAVE)
        for face, pressure in (("upper", one), ("lower", sign * other)):
            quantity = f"{name} mode, {half_planes} half-planes, {face} face, largest deviation [1]"
            yield compare_worst(quantity, pressure, wave, 1e-3, SOURCE)


def critical_speeds(half_planes: str, quarters: int) -> tuple[float, float]:
    """Exact speeds of symmetric and antisymmetric modes of a number of quarter waves [m/s].

    The compliance between the faces adds to that of the half-planes.
    """
    modulus, ratio = HALF_PLANES[half_planes]
    soft = (1 - ratio**2) / modulus + SOFT * pi * quarters / WAVE
    steel = YOUNG_MODULUS, RATIO, EXPANSION, CONDUCTIVITY, FRICTION
    exact = LayerBetweenInsulators(WAVE / quarters, THICKNESS, *steel, soft)
    return exact.symmetric, exact.antisymmetric


def layer(half_planes: str) -> Result:
    """Stability of a layer that slides across the section with 1 m/s, pressed from both sides."""
    insulator, depth = (*HALF_PLANES[half_planes], _CONDUCTING, 1e-12), 1.5 * WAVE
    layers = {"upper": depth, "layer": THICKNESS, "lower": depth}
    x = ["0 mm", f"{WAVE / 4!r} m"]
    tables: dict[str, Any] = {
        "title": "A layer between two insulators",
        "model": "plane-strain",
        "geometry": {
            "type": "stack",
            "thickness": "10 mm",
            "layers": {name: {"x": x, "height": f"{h!r} m"} for name, h in layers.items()},
        },
        "mesh": {"degree": 5, "elements": 5, "grading": 0.5},
        "bodies": {
            "upper": _body("upper", *insulator),
            "layer": _body("layer", YOUNG_MODULUS, RATIO, CONDUCTIVITY, EXPANSION),
            "lower": _body("lower", *insulator),
        },
        "contact": {"friction": FRICTION, "compliance": f"{SOFT} m/Pa"},
        "contacts": {
            "upper": {"between": ["upper_bottom", "layer_top"], "partition": 0.0},
            "lower": {"between": ["lower_top", "layer_bottom"], "partition": 0.0},
        },
        "holders": {
            "upper": {"surface": "upper_top", "approach": "1 um"},
            "lower": {"surface": "lower_bottom", "approach": "1 um"},
            "layer": {"surface": "layer_outside", "free": []},
        },
        "motions": {"layer": {"velocity": "1 m/s", "across": True}},
        "heat": {
            "conductance": _NEARLY_INSULATING,
            "ambient": _COLD,
            "temperature": dict.fromkeys(("layer_outside", "upper_top", "lower_bottom"), _COLD),
        },
        "analysis": {"type": "stability"},
    }
    return computed(load(tables))


def _body(
    name: str, modulus: float, ratio: float, conductivity: float, expansion: float
) -> dict[str, Any]:
    return {
        "young_modulus": f"{modulus} Pa",
        "poisson_ratio": ratio,
        "conductivity": f"{conductivity} W/(m K)",
        "expansion": f"{expansion} 1/K",
        "density": "1000 kg/m^3",
        "specific_heat": "3700 J/(kg K)",
        "symmetry": f"{name}_inside",
        "rollers": f"{name}_outside",
    }

"""Verification of hot spots: a layer between two half-planes, and a ring of finite width."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache
from math import pi
from typing import Any

import numpy as np

from ....case import load
from ....reference.hot_spots import LayerBetweenHalfPlanes, WaveMaterial
from ....results import Result
from ...check import Check, compare, computed

SOURCE = "K. Lee and J. R. Barber, J. Tribol. 115 (1993) 607"
DISK = WaveMaterial(125e9, 0.25, 12e-6, 54.0, 12.98e-6)
PADS = WaveMaterial(0.53e9, 0.25, 30e-6, 0.5, 0.269e-6)
FRICTION, THICKNESS = 0.4, 0.01
WEAR = 1e-11
"""Wear of the disk [1/Pa]."""
_GIVEN = 20.0, 40.0, 80.0, 160.0
_THICKNESSES = 0.005, 0.01, 0.02, 0.05
_BESIDE = np.array([0.92, 0.96, 1.0, 1.04, 1.08])
"""Wave numbers beside that of the first hot spots, relative to it."""
_DEEP = 10.0
"""Thickness of the pads times the wave number."""
_ALLOWED = 1e-3


def tei_layer_antisymmetric() -> Iterator[Check]:
    """Hot spots that alternate on both faces of a layer between two half-planes."""
    exact = reference(THICKNESS)
    for m in _GIVEN:
        mode = critical(THICKNESS, [m])["antisymmetric"][0]
        speed, drift = exact.critical(m, False)
        where = f"antisymmetric, wave number {m:g} /m"
        yield _compared(f"{where}, critical speed [m/s]", mode[0], speed)
        yield _compared(f"{where}, drift [m/s]", mode[1], drift)
    yield from _first(THICKNESS, False)
    yield from _similar()
    yield from _worn()


def tei_layer_symmetric() -> Iterator[Check]:
    """Hot spots opposite each other on both faces of a layer between two half-planes."""
    yield from _first(THICKNESS, True)


def _first(thickness: float, symmetric: bool) -> Iterator[Check]:
    name = "symmetric" if symmetric else "antisymmetric"
    speed, m, drift = reference(thickness).first(symmetric)
    found = critical(thickness, m * _BESIDE)[name]
    least, number = lowest(m * _BESIDE, [one[0] for one in found])
    yield _compared(f"{name}, first hot spots, critical speed [m/s]", least, speed)
    yield _compared(f"{name}, first hot spots, wave number [1/m]", number, m)
    yield _compared(f"{name}, first hot spots, drift [m/s]", found[2][1], drift)


def _similar() -> Iterator[Check]:
    """Products of the critical speed and wave number with the thickness, of several thicknesses."""
    speed, m, _ = reference(THICKNESS).first(False)
    for thickness in _THICKNESSES:
        numbers = m * THICKNESS / thickness * _BESIDE
        found = critical(thickness, numbers)["antisymmetric"]
        least, number = lowest(numbers, [one[0] for one in found])
        where = f"antisymmetric, thickness {1e3 * thickness:g} mm"
        a = thickness / 2
        yield _compared(f"{where}, V a [m²/s]", least * a, speed * THICKNESS / 2)
        yield _compared(f"{where}, m a [1]", number * a, m * THICKNESS / 2)


def _worn() -> Iterator[Check]:
    m = reference(THICKNESS).first(False)[1]
    result = layer(THICKNESS, [m], WEAR)
    rows = {row.symmetry: row for row in rows_of(result)}
    exact = reference(THICKNESS, WEAR).critical(m, False)[0]
    quantity = "antisymmetric, with wear of the layer, critical speed [m/s]"
    yield _compared(quantity, rows[-1].speed_factor_with_wear, exact)


def _compared(quantity: str, found: float, exact: float) -> Check:
    return compare(quantity, found, exact, _ALLOWED, SOURCE)


def reference(thickness: float, wear: float = 0.0) -> LayerBetweenHalfPlanes:
    """Closed form of the layer."""
    return LayerBetweenHalfPlanes(DISK, PADS, thickness, FRICTION, wear)


def lowest(numbers: Sequence[float] | np.ndarray, speeds: Sequence[float]) -> tuple[float, float]:
    """Lowest speed, and its wave number, by a polynomial in the logarithms."""
    middle = float(np.median(numbers))
    x = np.log(np.asarray(numbers) / middle)
    curve = np.polynomial.Polynomial.fit(x, np.log(speeds), len(x) - 1)
    inside = [r.real for r in curve.deriv().roots() if abs(r.imag) < 1e-9 and abs(r) <= x[-1]]
    best = min(inside, key=curve, default=0.0)
    return float(np.exp(curve(best))), float(middle * np.exp(best))


def critical(
    thickness: float, numbers: Sequence[float] | np.ndarray
) -> dict[str, list[tuple[float, float]]]:
    """Critical speeds and drifts by symmetry, at wave numbers."""
    rows = rows_of(layer(thickness, list(map(float, numbers))))
    found: dict[str, list[tuple[float, float]]] = {"symmetric": [], "antisymmetric": []}
    for row in rows:
        name = "symmetric" if row.symmetry > 0 else "antisymmetric"
        found[name].append((row.speed_factor, row.drift))
    return found


def rows_of(result: Result) -> list:
    """Rows of critical speeds."""
    assert result.hot_spots is not None
    return result.hot_spots.rows


def layer(thickness: float, numbers: list[float], wear: float = 0.0) -> Result:
    """Stability of half a layer under a pad that slides across the section with 1 m/s."""
    return _layer(thickness, tuple(numbers), wear)


@cache
def _layer(thickness: float, numbers: tuple[float, ...], wear: float) -> Result:
    depth, width = _DEEP / min(numbers), 0.01 * thickness
    x = ["0 mm", f"{width!r} m"]
    tables: dict[str, Any] = {
        "title": "Hot spots on a layer between two half-planes",
        "model": "plane-strain",
        "geometry": {
            "type": "stack",
            "thickness": "10 mm",
            "layers": {
                "pad": {"x": x, "height": f"{depth!r} m"},
                "layer": {"x": x, "height": f"{thickness / 2!r} m"},
            },
        },
        "mesh": {"degree": 6, "elements": 2, "grading": 0.3, "skin": f"{thickness / 2000!r} m"},
        "bodies": {
            "pad": _body("pad", PADS),
            "layer": _body("layer", DISK) | {"rollers": ["layer_bottom"]},
        },
        "contact": {"friction": FRICTION},
        "holders": {"pad": {"surface": "pad_top", "approach": "1 um"}},
        "motions": {"pad": {"velocity": "1 m/s", "across": True}},
        "heat": {"ambient": "0 degC", "temperature": {"pad_top": "0 degC"}},
        "analysis": {
            "type": "stability",
            "wave_lengths": [f"{2 * pi / m!r} m" for m in numbers],
            "mirror": "layer_bottom",
        },
    }
    if wear:
        tables["wear"] = {"layer": {"coefficient": f"{wear!r} 1/Pa", "per": "pressure"}}
    return computed(load(tables))


def _body(name: str, material: WaveMaterial) -> dict[str, Any]:
    capacity = material.conductivity / material.diffusivity
    return {
        "young_modulus": f"{material.young_modulus!r} Pa",
        "poisson_ratio": material.poisson_ratio,
        "conductivity": f"{material.conductivity!r} W/(m K)",
        "expansion": f"{material.expansion!r} 1/K",
        "density": "1000 kg/m^3",
        "specific_heat": f"{capacity / 1000!r} J/(kg K)",
        "symmetry": [f"{name}_inside", f"{name}_outside"],
    }

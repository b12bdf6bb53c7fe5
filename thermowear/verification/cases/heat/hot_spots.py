"""Verification of hot spots: a layer between two half-planes, and a ring of finite width."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from math import pi
from typing import Any

import numpy as np

from ....case import load
from ....reference.instability import LayerBetweenHalfPlanes, WaveMaterial
from ....results import Result
from ....simulation.analyses.run import run
from ....simulation.from_case.analysis import analysis_of, model_of
from ...check import Check, compare, computed

SOURCE = "K. Lee and J. R. Barber, J. Tribol. 115 (1993) 607"
DISK = WaveMaterial(125e9, 0.25, 12e-6, 54.0, 12.98e-6)
PADS = WaveMaterial(0.53e9, 0.25, 30e-6, 0.5, 0.269e-6)
FRICTION, THICKNESS = 0.4, 0.01
WEAR = 1e-11
"""Wear of the disk [1/Pa]."""
_GIVEN = 20.0, 40.0, 80.0, 160.0
_THICKNESSES = 0.005, 0.01, 0.02, 0.05, 0.1
_BESIDE = np.array([0.92, 0.96, 1.0, 1.04, 1.08])
"""Wave numbers beside that of the first hot spots, relative to it."""
_RADIUS, _NUMBER = 10.0, 400
"""Mean radius of rings whose curvature does not matter [m], and number of hot spots."""
_WIDTHS = (0.005, 2), (0.02, 2), (0.05, 3), (0.1, 4)
"""Widths of rings [m], and numbers of elements along them."""
_RADII = 0.5, 1.0, 2.0
_DEEP = 10.0
"""Thickness of the pads times the wave number."""
_ALLOWED = 1e-3


def tei_layer_antisymmetric() -> Iterator[Check]:
    """Hot spots that alternate on both faces of a layer between two half-planes."""
    yield from _at(_GIVEN, False)
    yield from _first(THICKNESS, False)
    yield from _similar()
    yield from _worn()


def tei_layer_symmetric() -> Iterator[Check]:
    """Hot spots opposite each other on both faces of a layer between two half-planes."""
    yield from _at((100.0, 160.0), True)
    yield from _first(THICKNESS, True)


def _at(numbers: Sequence[float], symmetric: bool) -> Iterator[Check]:
    name = "symmetric" if symmetric else "antisymmetric"
    for m in numbers:
        mode = critical(THICKNESS, [m])[name][0]
        speed, drift = reference(THICKNESS).critical(m, symmetric)
        where = f"{name}, wave number {m:g} /m"
        yield _compared(f"{where}, critical speed [m/s]", mode[0], speed)
        yield _compared(f"{where}, drift [m/s]", mode[1], drift)


def tei_ring() -> Iterator[Check]:
    """Hot spots round rings of finite width, between plane stress and plane strain."""
    m = _NUMBER / _RADIUS
    stress = replace(reference(THICKNESS), layer=DISK.plane_stress, pads=PADS.plane_stress)
    least, most = (one.critical(m, False)[0] for one in (reference(THICKNESS), stress))
    narrow, *others = (_ring_speed(width, elements) for width, elements in _WIDTHS)
    yield _compared("narrow ring, critical speed of plane stress [m/s]", narrow, most)
    guided = _ring_speed(0.02, 2, guided=True)
    yield _compared("ring with guided sides, critical speed of plane strain [m/s]", guided, least)
    falling = float(np.all(np.diff([narrow, *others]) < 0) and least < min(others))
    yield compare(
        "wider rings, critical speed falls towards plane strain [1]", falling, 1.0, 1e-9, SOURCE
    )
    for radius in _RADII:
        numbers = tuple(round(stress.first(False)[1] * radius) + k for k in (-4, -2, 0, 2, 4))
        rows = [row for row in rows_of(ring(0.01, radius, numbers)) if row.symmetry < 0]
        _, number = lowest(np.array(numbers) / radius, [row.speed_factor for row in rows])
        quantity = f"first hot spots round a radius of {radius:g} m, number per radius [1/m]"
        yield compare(quantity, number, stress.first(False)[1], 0.02, SOURCE)


def _ring_speed(width: float, elements: int, guided: bool = False) -> float:
    """Critical speed of antisymmetric modes of a ring at its mean radius [m/s]."""
    rows = rows_of(ring(width, _RADIUS, (_NUMBER,), elements, guided))
    return next(row.speed_factor for row in rows if row.symmetry < 0)


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
    roots = np.asarray(curve.deriv().roots(), dtype=complex)
    inside = roots[(np.abs(roots.imag) < 1e-9) & (np.abs(roots) <= x[-1])].real
    values = np.asarray(curve(inside))
    best = int(np.argmin(values))
    return float(np.exp(values[best])), float(middle * np.exp(inside[best]))


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
    return computed(load(tables_of_layer(thickness, numbers, wear)))


def tables_of_layer(
    thickness: float, numbers: tuple[float, ...], wear: float = 0.0
) -> dict[str, Any]:
    """Tables of the case of a layer, see `layer`."""
    tables = _stack((0.0, 0.01 * thickness), thickness, min(numbers)) | {
        "model": "plane-strain",
        "motions": {"pad": {"velocity": "1 m/s", "across": True}},
        "analysis": {
            "type": "stability",
            "wave_lengths": [f"{2 * pi / m!r} m" for m in numbers],
            "mirror": "layer_bottom",
        },
    }
    tables["geometry"]["thickness"] = "10 mm"
    if wear:
        tables["wear"] = {"layer": {"coefficient": f"{wear!r} 1/Pa", "per": "pressure"}}
    for name, body in tables["bodies"].items():
        body["symmetry"] = [f"{name}_inside", f"{name}_outside"]
    return tables


def ring(
    width: float, radius: float, numbers: tuple[int, ...], elements: int = 2, guided: bool = False
) -> Result:
    """Stability of half a ring under a pad of its width that turns with 1 m/s."""
    ends = radius - width / 2, radius + width / 2
    tables = _stack(ends, THICKNESS, min(numbers) / radius) | {
        "model": "axisymmetric",
        "motions": {"pad": {"angular_velocity": f"{1 / radius!r} rad/s"}},
        "analysis": {"type": "stability", "hot_spots": list(numbers), "mirror": "layer_bottom"},
    }
    tables["mesh"] |= {"degree": 4, "elements": elements}
    case = load(tables)
    model = model_of(case)
    if guided:  # as between rigid rings without friction
        sides = [f"{body}_{side}" for body in ("pad", "layer") for side in ("inside", "outside")]
        model = replace(model, symmetry=tuple(sides))
    return run(model, analysis_of(case))


def _stack(ends: tuple[float, float], thickness: float, wave_number: float) -> dict[str, Any]:
    """Half a layer under a pad that is deep for a wave number."""
    x = [f"{end!r} m" for end in ends]
    heights = {"pad": _DEEP / wave_number, "layer": thickness / 2}
    return {
        "title": "Hot spots on a layer between two half-planes",
        "geometry": {
            "type": "stack",
            "layers": {name: {"x": x, "height": f"{h!r} m"} for name, h in heights.items()},
        },
        "mesh": {"degree": 6, "elements": 2, "grading": 0.3, "skin": f"{thickness / 2000!r} m"},
        "bodies": {"pad": _body(PADS), "layer": _body(DISK) | {"rollers": ["layer_bottom"]}},
        "contact": {"friction": FRICTION},
        "holders": {"pad": {"surface": "pad_top", "approach": "1 um"}},
        "heat": {"ambient": "0 degC", "temperature": {"pad_top": "0 degC"}},
    }


def _body(material: WaveMaterial) -> dict[str, Any]:
    capacity = material.conductivity / material.diffusivity
    return {
        "young_modulus": f"{material.young_modulus!r} Pa",
        "poisson_ratio": material.poisson_ratio,
        "conductivity": f"{material.conductivity!r} W/(m K)",
        "expansion": f"{material.expansion!r} 1/K",
        "density": "1000 kg/m^3",
        "specific_heat": f"{capacity / 1000!r} J/(kg K)",
    }

"""Mechanical face seal: coning by friction heat, parallel worn faces, openings after other speeds.

Two rings with insulated sides, held at their far ends, where they have the ambient temperature.
Their height is many times the length at which a ring forgets how it is held, about ``(r_m b)^0.5``,
so that their faces turn like those of free rings. Wear makes the hot, loaded faces parallel: where
they part by heat, less is worn. At a higher speed they then open outside, at a lower one inside.
A fluid between the faces opens them against the spring, and deflects the rings.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ....case import load
from ....reference import heat as reference
from ....results import Result
from ...check import Check, compare, compare_worst, computed

RING_FORMULA = "free ring with a uniform axial gradient: rotation alpha (dT/h) r_m"
INNER, OUTER, HEIGHT = 0.025, 0.032, 0.08
"""Radii and height of both rings [m]."""
FORCE, FRICTION, SPEED, AMBIENT = 300.0, 0.1, 350.0, 293.15
"""[N], coefficient of friction, [rad/s], [K]."""
CONDUCTIVITY = 100.0
EXPANSIONS = {"ring": 5e-6, "seat": 4e-6}
"""[W/(m K)] of both rings, which share the heat equally, and [1/K]."""
AFTER = {"outside": 2.0, "inside": 0.5}
"""Side on which the faces open after a change to so many times the speed."""
SEALED = 0.1e6
"""Pressure of the fluid at the outer radius [Pa]."""
_RUN_IN, _CHANGE = 2e5, 1.0
"""Duration of the running-in, and of the change of speed after it [s]."""


def tables(
    speed: float | None = SPEED, elements: int = 8, fluid: str | None = None
) -> dict[str, Any]:
    """Tables of the steady state; without heat if the speed is None; with a fluid pressure."""
    ring = {"x": [f"{INNER} m", f"{OUTER} m"], "height": f"{HEIGHT} m"}
    result: dict[str, Any] = {
        "model": "axisymmetric",
        "geometry": {"type": "stack", "layers": {"ring": ring, "seat": ring}},
        "mesh": {"degree": 4, "elements": elements, "grading": 0.3},
        "bodies": {
            name: {
                "young_modulus": "20 GPa",
                "poisson_ratio": 0.2,
                "conductivity": f"{CONDUCTIVITY} W/(m K)",
                "expansion": f"{expansion} 1/K",
            }
            for name, expansion in EXPANSIONS.items()
        },
        "contact": {"friction": FRICTION} | ({} if fluid is None else {"fluid_pressure": fluid}),
        "holders": {
            "spring": {"surface": "ring_top", "force": f"{FORCE} N"},
            "housing": {"surface": "seat_bottom", "free": []},
        },
        "motions": {"ring": {"angular_velocity": f"{speed or SPEED} rad/s"}},
        "wear": {"update": "never", "ring": {"coefficient": "1e-10 1/MPa"}},
        "analysis": {"type": "steady"},
    }
    if speed is not None:
        ends = {"ring_top": f"{AMBIENT} K", "seat_bottom": f"{AMBIENT} K"}
        result["heat"] = {"ambient": f"{AMBIENT} K", "temperature": ends, "partition": 0.5}
    return result


def running_in(factor: float, elements: int = 8) -> Result:
    """State just after a change to a multiple of the speed, at the end of the running-in."""
    found = tables(elements=elements)
    history = {"time": ["0 s", f"{_RUN_IN} s", f"{_RUN_IN + _CHANGE} s"], "factor": [1, 1, factor]}
    found["motions"]["ring"]["history"] = history
    found["analysis"] = {
        "type": "transient",
        "end_time": f"{_RUN_IN + _CHANGE} s",
        "output_times": [f"{_RUN_IN} s"],
        "tolerance": 1e-3,
    }
    return computed(load(found))


def face_seal() -> Iterator[Check]:
    """Coning by heat, fluid, parallel faces at the end of the running-in, openings after it."""
    yield from coning()
    yield from fluid()
    for side in AFTER:
        yield from opening(side)


def coning(elements: int = 8) -> Iterator[Check]:
    """Worn shape due to heat, against the deflections of free rings."""
    hot, cold = (computed(load(tables(speed, elements))) for speed in (SPEED, None))
    r = hot.interface.x
    flux = reference.steady_heat(INNER, OUTER, FRICTION, FORCE, SPEED) / 2
    for side in (1, 2):
        found = getattr(hot.interface, f"heat_flux_{side}")
        quantity = f"heat flux into body {side} at the point of largest deviation [W/m²]"
        yield compare_worst(quantity, found, flux, 1e-6, "closed form: uniform wear")
        rise = getattr(hot.interface, f"temperature_{side}") - AMBIENT
        quantity = f"temperature rise of body {side} at the point of largest deviation [K]"
        exact = flux * HEIGHT / CONDUCTIVITY
        yield compare_worst(quantity, rise, exact, 1e-6, "conduction along the ring")
    gradient = flux / CONDUCTIVITY  # towards the face: against z in the ring above it
    up, down = (sign * gradient for sign in (-1, 1))
    upper, lower = EXPANSIONS.values()
    gap = reference.face_deflection(r, upper, up) - reference.face_deflection(r, lower, down)
    worn = hot.interface.shape - cold.interface.shape
    scale = float(np.ptp(gap))
    quantity = "worn shape due to heat at the point of largest deviation [m]"
    height = worn - worn.mean() - (gap - gap.mean())
    yield compare_worst(quantity, height, np.zeros(len(r)), 1e-2, RING_FORMULA, scale)
    slope = (worn[-1] - worn[0]) / (r[-1] - r[0])
    turned = reference.rotation(INNER, OUTER, upper, up)
    turned -= reference.rotation(INNER, OUTER, lower, down)
    yield compare("relative rotation of the faces by heat [rad]", slope, turned, 1e-2, RING_FORMULA)


def fluid(elements: int = 4) -> Iterator[Check]:
    """Steady states with a fluid between the faces: forces, pressure, and shape.

    A fluid with the distribution of the contact pressure, 1/r, deflects the rings as the part of
    the contact pressure that it replaces: the worn shape is that without it.
    """
    width, area = OUTER - INNER, np.pi * (OUTER**2 - INNER**2)
    linear = 2 * np.pi * SEALED * ((OUTER**3 - INNER**3) / 3 - INNER * area / (2 * np.pi)) / width
    given = {
        "uniform": (f"{SEALED} Pa", SEALED * area),
        "falling to 0 inside": (f"{SEALED} Pa * (r - {INNER} m) / ({width} m)", linear),
        "1/r": (f"{SEALED} Pa * {OUTER} m / r", 2 * np.pi * SEALED * OUTER * width),
    }
    dry = computed(load(tables(None, elements)))
    for name, (pressure, opening_force) in given.items():
        wet = computed(load(tables(None, elements, pressure)))
        numbers, note = wet.summary["contacts"]["ring-seat"], f"fluid pressure {name}"
        quantity = f"force of the fluid, {note} [N]"
        yield compare(quantity, numbers["fluid_force_N"], opening_force, 1e-9, "closed form")
        rest = (FORCE - opening_force) / (2 * np.pi * width) / wet.interface.x
        quantity = f"contact pressure at the point of largest deviation, {note} [Pa]"
        source = "uniform wear, closing less opening force"
        yield compare_worst(quantity, wet.interface.pressure, rest, 1e-9, source)
    quantity = "worn shape with a fluid pressure 1/r at the point of largest deviation [m]"
    shape, same = wet.interface.shape, dry.interface.shape
    yield compare_worst(quantity, shape, same, 1e-9, "without fluid", float(np.ptp(same)))


def opening(side: str, elements: int = 8) -> Iterator[Check]:
    """Faces at the end of the running-in, and the side that opens after a change of speed."""
    result = running_in(AFTER[side], elements)
    worn, after = result.outputs[_RUN_IN], result.interface
    exact = FORCE / (2 * np.pi * (OUTER - INNER)) / worn.x
    note = f"before the speed changes to {AFTER[side]:g} times"
    quantity = f"pressure at the point of largest deviation, {note} [Pa]"
    yield compare_worst(quantity, worn.pressure, exact, 2e-3, "closed form: uniform wear")
    flux = reference.steady_heat(INNER, OUTER, FRICTION, FORCE, SPEED) / 2
    turned = sum(EXPANSIONS.values()) * flux / CONDUCTIVITY * (INNER + OUTER) / 2
    coned = turned * (OUTER - INNER)
    quantity = f"faces parallel: range of the gap, {note} [m]"
    yield compare(quantity, np.ptp(worn.gap), 0.0, 1e-3, "steady state", scale=coned)
    inside, outside = after.gap[0], after.gap[-1]
    opened = float(np.sign(outside - inside))
    quantity = f"side that opens at {AFTER[side]:g} times the speed: 1 outside, -1 inside"
    expected = 1.0 if side == "outside" else -1.0
    yield compare(quantity, opened, expected, 1e-12, "more heat lifts the outer edges")
    closed = after.pressure[-1 if side == "inside" else 0]
    other = after.pressure[0 if side == "inside" else -1]
    quantity = f"pressure at the edge that opens, relative to the other, {AFTER[side]:g} times [1]"
    yield compare(quantity, other / closed, 0.0, 1e-12, "open contact", scale=1.0)

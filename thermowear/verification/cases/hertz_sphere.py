"""Hertz's point contact: a half sphere on a cylindrical block."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...reference.elastic_sphere import sphere_on_half_space
from ...reference.hertz import point_contact
from ...results import Result
from ..check import Check, compare
from ..starter import run_starter
from .hertz import MODULUS, STEEL, half_width

JOHNSON = "Johnson, Contact Mechanics (1985), section 4.2"
LURE = "Lur'e, Theory of Elasticity (1964), ch. 6"
RADIUS = 10e-3

MESHES = {
    "unpositioned, degree 2": (
        "contact.positioning=false",
        "mesh.degree=2",
        "mesh.elements=80",
        "mesh.grading=1.0",
    ),
    "positioned, degree 6": (),
}


def checks() -> Iterator[Check]:
    """Peak pressure against Hertz and the finite sphere, radius and pressures of the contact."""
    for name, overrides in MESHES.items():
        yield from _against_formula(pressed(*overrides), name)


def pressed(*overrides: str) -> Result:
    """Starter case: R = 10 mm under 500 N."""
    return run_starter("sphere-on-block", *overrides)


def _against_formula(result: Result, name: str) -> Iterator[Check]:
    exact = point_contact(result.summary["normal_force_N"], RADIUS, MODULUS)
    peak = result.summary["max_pressure_Pa"]
    yield compare(f"peak pressure, {name} [Pa]", peak, exact.peak, 5e-3, JOHNSON)
    finite = sphere_on_half_space(result.summary["normal_force_N"], RADIUS, STEEL, STEEL)
    quantity = f"peak pressure of a sphere of finite size, {name} [Pa]"
    yield compare(quantity, peak, finite.peak, 5e-4, LURE)
    found = half_width(result)
    yield compare(f"contact radius, {name} [m]", found, exact.half_width, 5e-3, JOHNSON)
    for part in (0.5, 0.8):
        r = part * exact.half_width
        pressure = np.interp(r, result.interface.x, result.interface.pressure)
        quantity = f"pressure at {part:g} of the contact radius, {name} [Pa]"
        known = float(exact.pressure(np.array(r)))
        yield compare(quantity, float(pressure), known, 5e-3, JOHNSON)

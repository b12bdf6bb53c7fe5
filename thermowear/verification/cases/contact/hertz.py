"""Cylinder, sphere and flat punch pressed on a block, against closed forms."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi, sqrt

import numpy as np

from ....reference.elastic_contact import hertz as reference
from ....reference.elastic_contact.hertz import (
    contact_modulus,
    line_contact,
    point_contact,
    sphere_on_half_space,
)
from ....results import Result
from ...check import Check, along, compare, compare_each, run_starter

JOHNSON = "Johnson, Contact Mechanics (1985), section 4.2"
PUNCH = "Johnson, Contact Mechanics (1985), section 2.8"
LURE = "Lur'e, Theory of Elasticity (1964), ch. 6"
OWN = "converged value of the program (degree 8, 24 elements in the zone)"
STEEL = (210e9, 0.3)
MODULUS = contact_modulus(STEEL, STEEL)
RADIUS, THICKNESS = 10e-3, 1e-3

SMALL = ("geometry.radius=6 mm", "bodies.cylinder.young_modulus=200 GPa", 'load={force="120 N"}')
"""Line load of 120 N/mm on a cylinder of 6 mm: the contact is small relative to the bodies."""
UNPOSITIONED = ("contact.positioning=false", "mesh.degree=2", "mesh.grading=1.0")
LINE_MESHES = {
    "unpositioned, degree 2": (*UNPOSITIONED, "mesh.elements=90"),
    "positioned, degree 6": ("mesh.bodies.block.elements=6",),
    "converged": ("mesh.degree=8", "mesh.elements=24"),
}
SPHERE_MESHES = {
    "unpositioned, degree 2": (*UNPOSITIONED, "mesh.elements=80"),
    "positioned, degree 6": (),
}
PLACES = np.array([0.0, 0.3, 0.6, 0.8, 0.9, 0.95])
"""Positions under the flat punch, relative to its half-width."""


def hertz_line() -> Iterator[Check]:
    """Cylinder under a force against the formula; under an approach also converged values."""
    small = run_starter("cylinder-on-block", *SMALL)
    exact = line_contact(120e3, 6e-3, contact_modulus((200e9, 0.3), (200e9, 0.3)))
    peak, note = small.summary["max_pressure_Pa"], "120 N/mm on R = 6 mm"
    yield compare(f"half-width, {note} [m]", half_width(small), exact.half_width, 5e-3, JOHNSON)
    yield compare(f"peak pressure, {note} [Pa]", peak, exact.peak, 3e-3, JOHNSON)
    results = {name: run_starter("cylinder-on-block", *keys) for name, keys in LINE_MESHES.items()}
    for name, result in results.items():
        note = f"0.05 mm on R = 10 mm, {name}"
        quantity = f"peak over the formula, {note} [1]"
        yield compare(quantity, _over_formula(result), 1.0, 3e-3, JOHNSON)
        exact = line_contact(result.summary["normal_force_N"] / THICKNESS, RADIUS, MODULUS)
        found = half_width(result)
        yield compare(f"half-width, {note} [m]", found, exact.half_width, 5e-3, JOHNSON)
    chosen, converged = results["positioned, degree 6"], _over_formula(results["converged"])
    quantity = "peak over the formula, positioned, degree 6 [1]"
    yield compare(quantity, _over_formula(chosen), converged, 1e-4, OWN)
    dofs = chosen.summary["dofs_displacement"]
    yield Check("displacement values, positioned, degree 6", dofs, 5000, dofs / 5000, 1.0, "limit")


def _over_formula(result: Result) -> float:
    """Peak pressure over ``√(F E*/(π R))`` with the computed force."""
    force = result.summary["normal_force_N"] / THICKNESS
    return result.summary["max_pressure_Pa"] / sqrt(force * MODULUS / (pi * RADIUS))


def half_width(result: Result) -> float:
    """Distance from the middle to the edge of the contact [m]."""
    interface = result.interface
    (zone,) = result.summary["contact_zones_m"]
    ends = np.interp(zone, interface.s, interface.x)
    return float(np.abs(ends).max())


def hertz_sphere() -> Iterator[Check]:
    """Peak pressure against Hertz and the finite sphere, radius and pressures of the contact."""
    for name, overrides in SPHERE_MESHES.items():
        result = run_starter("sphere-on-block", *overrides)
        i, force = result.interface, result.summary["normal_force_N"]
        exact, peak = point_contact(force, RADIUS, MODULUS), result.summary["max_pressure_Pa"]
        yield compare(f"peak pressure, {name} [Pa]", peak, exact.peak, 5e-3, JOHNSON)
        finite = sphere_on_half_space(force, RADIUS, STEEL, STEEL)
        quantity = f"peak pressure of a sphere of finite size, {name} [Pa]"
        yield compare(quantity, peak, finite.peak, 5e-4, LURE)
        found = half_width(result)
        yield compare(f"contact radius, {name} [m]", found, exact.half_width, 5e-3, JOHNSON)
        places = np.array([0.5, 0.8])
        pressures = np.interp(places * exact.half_width, i.x, i.pressure)
        known = exact.pressure(places * exact.half_width)
        quantity = f"pressure at {{:g}} of the contact radius, {name} [Pa]"
        yield from compare_each(quantity, places, pressures, known, 5e-3, JOHNSON)


def flat_punch() -> Iterator[Check]:
    """Rigid flat punch: pressure up to 5 % of the half-width from its edge."""
    half = 5e-3
    for model in ("plane-strain", "plane-stress"):
        rigid = "bodies.punch.young_modulus=1e6 GPa"
        result = run_starter("punch-on-block", f"model={model}", rigid)
        exact = reference.flat_punch(
            half * PLACES, result.summary["normal_force_N"] / THICKNESS, half
        )
        found = along(result.interface, half * PLACES, result.interface.pressure)
        quantity = f"pressure at x = {{:g}} of the half-width, {model} [Pa]"
        yield from compare_each(quantity, PLACES, found, exact, 1e-2, PUNCH)

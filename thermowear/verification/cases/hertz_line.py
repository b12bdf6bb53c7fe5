"""Hertz's line contact: half cylinders on blocks, under a force and under an approach."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi, sqrt

from ...reference.hertz import contact_modulus, line_contact
from ...results import Result
from ..check import Check, compare
from ..starter import run_starter
from .hertz import MODULUS, half_width

JOHNSON = "Johnson, Contact Mechanics (1985), section 4.2"
OWN = "converged value of the program (degree 8, 24 elements in the zone)"
RADIUS, THICKNESS = 10e-3, 1e-3

SMALL = ("geometry.radius=6 mm", "bodies.cylinder.young_modulus=200 GPa", 'load={force="120 N"}')
"""Line load of 120 N/mm on a cylinder of 6 mm: the contact is small relative to the bodies."""

MESHES = {
    "unpositioned, degree 2": (
        "contact.positioning=false",
        "mesh.degree=2",
        "mesh.elements=90",
        "mesh.grading=1.0",
    ),
    "positioned, degree 6": ("mesh.bodies.block.elements=6",),
    "converged": ("mesh.degree=8", "mesh.elements=24"),
}


def checks() -> Iterator[Check]:
    """Under a force against the formula; under an approach also against converged values."""
    small = run_starter("cylinder-on-block", *SMALL)
    modulus = contact_modulus((200e9, 0.3), (200e9, 0.3))
    exact = line_contact(120e3, 6e-3, modulus)
    found = half_width(small)
    yield compare("half-width, 120 N/mm on R = 6 mm [m]", found, exact.half_width, 5e-3, JOHNSON)
    peak = small.summary["max_pressure_Pa"]
    yield compare("peak pressure, 120 N/mm on R = 6 mm [Pa]", peak, exact.peak, 3e-3, JOHNSON)
    results = {name: pressed(*overrides) for name, overrides in MESHES.items()}
    converged = results["converged"]
    for name, result in results.items():
        yield from _against_formula(result, name)
    quantity = "peak over the formula, positioned, degree 6 [1]"
    result = results["positioned, degree 6"]
    yield compare(quantity, over_formula(result), over_formula(converged), 1e-4, OWN)
    dofs = result.summary["dofs_displacement"]
    yield Check("displacement values, positioned, degree 6", dofs, 5000, dofs / 5000, 1.0, "limit")


def pressed(*overrides: str) -> Result:
    """Starter case: R = 10 mm, approach 0.05 mm."""
    return run_starter("cylinder-on-block", *overrides)


def over_formula(result: Result) -> float:
    """Peak pressure over ``√(F E*/(π R))`` with the computed force."""
    force = result.summary["normal_force_N"] / THICKNESS
    return result.summary["max_pressure_Pa"] / sqrt(force * MODULUS / (pi * RADIUS))


def _against_formula(result: Result, name: str) -> Iterator[Check]:
    quantity = f"peak over the formula, 0.05 mm on R = 10 mm, {name} [1]"
    yield compare(quantity, over_formula(result), 1.0, 3e-3, JOHNSON)
    force = result.summary["normal_force_N"] / THICKNESS
    exact = line_contact(force, RADIUS, MODULUS)
    quantity = f"half-width, 0.05 mm on R = 10 mm, {name} [m]"
    yield compare(quantity, half_width(result), exact.half_width, 5e-3, JOHNSON)

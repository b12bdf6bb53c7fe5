"""Steady principle: no admissible change of the pressure lowers the wear dissipation power.

For q = 1 the steady state of each special case is the minimum of D_w; for other q each of the
three functionals has a minimum of its own. Every minimum is compared with random pressures of the
same resultants, close to it and far away.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ....laws.principle.minimum import (
    Minimum,
    PowerFunctional,
    admissible_changes,
    friction_dissipation,
    least_wear_dissipation,
    minimise,
    wear_dissipation,
    wear_volume_rate,
)
from ....laws.wear import PowerWear
from ....reference.rigid_faces import ArcBlock, DrumBrakeShoe, LeverBlock
from ...check import Check, compare
from ...closed_forms import patches
from ...closed_forms.patches import SpecialCase

CHANGES = 1000
CONTROLS = (0.8, 2.0, 5.0)
"""Values of q other than 1."""
CONTROLS_OF_OWN = (0.8, 2.0)
"""Values of q for which D_w has a minimum consistent with its own wear velocity in all cases."""
FRICTION = 0.3
PRINCIPLE = "Páczelt and Mróz, Int. J. Solids Struct. 44 (2007) 895, minimum of D_w"
CONVEX = "unique minimum of a convex functional"


def special_cases() -> dict[str, SpecialCase]:
    """One per case, with both senses, one or two wearing bodies, full and partial contact."""
    r, w = patches.along(0.02, 0.12)
    α, v = patches.along(0.6, 1.5)
    arc, turned = (ArcBlock(0.02, 0.01, -0.2, 0.7, friction) for friction in (FRICTION, -FRICTION))
    lever = LeverBlock(0.05, 0.15, 0.04, 0.01, FRICTION)
    shoe = DrumBrakeShoe(0.15, 0.125, 0.04, 0.3, 2.1, -FRICTION)
    cone = patches.annular_punch(2.0, 1.0, 1e5, r, 2 * np.pi * r * w, 1.1, FRICTION, 0.2)
    torus = patches.annular_punch(
        1.0, 0.5, 1e5, 0.1 + 0.02 * np.cos(α), 2 * np.pi * (0.1 + 0.02 * np.cos(α)) * 0.02 * v, α,
        FRICTION, 0.2,
    )  # fmt: skip
    block = (1000.0, (0.1, 0.2), 0.1, 0.03, 0.01, FRICTION)
    return {
        "case 1": patches.punch(2.0, 1e4, 0.06, 0.08, 5e-3),
        "case 2": patches.tilting_punch(0.5),
        "case 3, +": patches.block_on_disk(arc, 1000.0),
        "case 3, -": patches.block_on_disk(replace(turned, b=2.0), 1000.0),
        "case 4": _with_second_body(patches.ring_segment(replace(arc, b=0.5), 1000.0), a=0.5),
        "case 5, +": patches.brake_block(replace(lever, b=2.0), 200.0),
        "case 5, -": patches.brake_block(replace(lever, b=0.5, friction=-FRICTION), 200.0),
        "case 6": patches.tilting_block(1.5, 1, block[0], 62.0, *block[1:]),
        "case 6, parting": patches.tilting_block(1.0, 1, block[0], 82.0, *block[1:]),
        "case 7, leading": patches.drum_brake(shoe, 476.0),
        "case 8, cone": _with_second_body(cone, a=2.0),
        "case 8, torus": torus,
        "case 9": patches.disk_brake(
            2.0, 1.0, 5e3, (0.06, 0.1), 1.0, (0.0765, -0.003), FRICTION, 0.01
        ),
    }


def _with_second_body(case: SpecialCase, a: float) -> SpecialCase:
    """Case with a second body that wears, with another velocity exponent."""
    (first,) = case.laws
    second = PowerWear(0.5 * first.coefficient, first.pressure_exponent, a)
    return SpecialCase(case.patch, case.load, (first, second))


def minimality() -> Iterator[Check]:
    """Numbers of random admissible pressures whose functional is at most the minimum."""
    rng = np.random.default_rng(0)
    for name, case in special_cases().items():
        steady = case.steady()
        there = _approaching(case, steady.velocity)
        functional = _inclined(there, steady.velocity, 1.0)
        pressure = steady.pressure[steady.approach > 0]
        yield _count(rng, f"{name}: D_w, steady state", there, functional, pressure, PRINCIPLE)
        for what, there, functional, minimum in own_minima(case):
            yield _count(rng, f"{name}: {what}", there, functional, minimum.pressure, CONVEX)


def own_minima(case: SpecialCase) -> Iterator[tuple[str, SpecialCase, PowerFunctional, Minimum]]:
    """Functional, its points and its minimum, for all q for which it has one."""
    velocity = case.steady().velocity
    pressed = _approaching(case, velocity)
    for q in CONTROLS:
        for what, there, functional in (
            ("D_w", pressed, _inclined(pressed, velocity, q)),
            ("D_F", case, friction_dissipation(case.patch.weights, FRICTION, case.patch.speed, q)),
            ("W", case, wear_volume_rate(case.patch.weights, case.laws, case.patch.speed, q)),
        ):
            if functional.defined:
                minimum = minimise(functional, there.patch.force_modes, case.load)
                yield f"{what}, q = {q:g}", there, functional, minimum
    for q in CONTROLS_OF_OWN:
        patch = case.patch
        least = least_wear_dissipation(
            patch.weights, patch.normal_modes, patch.force_modes, case.load, case.laws,
            patch.speed, q,
        )  # fmt: skip
        there = _approaching(case, least.multipliers)
        least = replace(least, pressure=least.pressure[_approach(case, least.multipliers) > 0])
        functional = _inclined(there, least.multipliers, q)
        yield f"D_w with its own χ, q = {q:g}", there, functional, least


def _approach(case: SpecialCase, velocity: np.ndarray) -> np.ndarray:
    return case.patch.normal_modes @ velocity


def _approaching(case: SpecialCase, velocity: np.ndarray) -> SpecialCase:
    """Restrict a case to the points where the bodies approach: D_w is undefined elsewhere."""
    return replace(case, patch=case.patch.part(_approach(case, velocity) > 0))


def _inclined(case: SpecialCase, velocity: np.ndarray, q: float) -> PowerFunctional:
    """Functional ``D_w^(q)`` with χ of a rigid-body wear velocity."""
    patch = case.patch
    factor = (patch.force_modes @ velocity) / _approach(case, velocity)
    return wear_dissipation(patch.weights, case.laws, patch.speed, q, factor)


def _count(
    rng: np.random.Generator,
    what: str,
    case: SpecialCase,
    functional: PowerFunctional,
    pressure: np.ndarray,
    source: str,
) -> Check:
    patch = case.patch
    changes = admissible_changes(rng, CHANGES, patch.weights, patch.force_modes, pressure)
    lower = np.count_nonzero(functional(pressure + changes) <= functional(pressure))
    quantity = f"{what}: lower ones among {CHANGES} admissible pressures [1]"
    return compare(quantity, lower, 0, 0.0, source, scale=CHANGES)

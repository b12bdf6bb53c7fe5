"""Faces on a pivot: a block against a strip (case 5) and a shoe in a drum (case 7)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...laws.principle.solvability import SelfLocking
from ...reference import brake_block as lever
from ...reference.drum_brake import DrumBrakeShoe
from ..check import Check, compare
from . import patches as cases
from .rows import CLOSED_FORM, EXPONENTS, MPA, dissipation, printed, worst

SHIGLEY = "Budynas and Nisbett, Shigley's Mechanical Engineering Design, long-shoe law"


def case_5() -> Iterator[Check]:
    """Block on a lever; self-locking in the sense of minus from a known friction on."""
    data = (lever.INNER, lever.OUTER, lever.OFFSET, lever.WIDTH)
    for (b, sense), ends in lever.ENDS.items():
        case = cases.brake_block(
            b, sense, lever.MOMENT, *data, lever.FRICTION, probes=(lever.INNER, lever.OUTER)
        )
        for place, p, known in zip(("inner", "outer"), case.pressure(2) / MPA, ends, strict=True):
            quantity = f"pressure at the {place} end, b = {b:g}, sense {sense:+d} [MPa]"
            yield printed(quantity, p, known)
    rng = np.random.default_rng(5)
    for sense in (1, -1, 1, -1):
        b, friction, moment = rng.uniform((0.3, 0.0, 10), (4.0, 0.6, 1e3))
        inner, span, offset, width = rng.uniform((0.02, 0.02, 0.0, 0.005), (0.1, 0.1, 0.05, 0.05))
        size = (inner, inner + span, offset, width)
        case = cases.brake_block(b, sense, moment, *size, friction)
        steady, name = case.steady(), f", b = {b:.3g}, mu = {sense * friction:.3g}"
        z = case.patch.points[:, 2]
        exact = lever.steady_pressure(z, moment, *size, sense * friction, b)
        yield worst(f"pressure{name} [Pa]", steady.pressure, exact)
        integral = lever.bearing_integral(*size, sense * friction, b)
        rate = case.laws[0].factor(case.patch.speed) * (moment / integral) ** b * z
        yield worst(f"normal wear rate{name} [m/s]", steady.rates[0], rate)
        yield dissipation(case, name)
    for b in EXPONENTS:
        limit = lever.locking_friction(lever.INNER, lever.OUTER, lever.OFFSET, b)
        found = _self_locking_friction(b, data, 0.99 * limit, 1.01 * limit)
        quantity = f"least friction of self-locking, b = {b:g} [1]"
        yield compare(quantity, found, limit, 1e-6, CLOSED_FORM)


def _self_locking_friction(
    b: float, data: tuple[float, float, float, float], free: float, locked: float
) -> float:
    """Least friction for which the solver reports self-locking, by bisection."""
    while locked - free > 1e-6 * free:
        friction = (free + locked) / 2
        try:
            cases.brake_block(b, -1, lever.MOMENT, *data, friction).steady()
        except SelfLocking:
            locked = friction
        else:
            free = friction
    return (free + locked) / 2


def case_7() -> Iterator[Check]:
    """Shoe in a drum: the long-shoe law, leading and trailing, and other exponents."""
    size, ends, friction = (0.15, 0.125, 0.04), (0.0, np.radians(120)), 0.28
    moment = 2.2e3 * 2 * 0.125 * np.cos(np.radians(30))
    torques, tops = {}, {}
    for sense, shoe in ((-1, "leading"), (1, "trailing")):
        law = DrumBrakeShoe(*size, *ends, sense * friction)
        case = cases.drum_brake(1.0, sense, moment, *size, ends, friction, probes=(np.pi / 2,))
        steady = case.steady()
        tops[shoe] = steady.pressure[-1]
        θ = np.arctan2(case.patch.points[:, 1], case.patch.points[:, 0])
        exact = tops[shoe] * np.sin(θ)
        yield worst(f"long-shoe law, {shoe} [Pa]", steady.pressure, exact)
        actuating = law.actuating_moment(tops[shoe])
        quantity = f"actuating moment, {shoe} [N m]"
        yield compare(quantity, moment, actuating, 1e-9, SHIGLEY)
        torques[shoe] = -sense * case.patch.moment(steady.pressure, (0.0, 0.0, 0.0))[2]
        quantity = f"torque, {shoe} [N m]"
        yield compare(quantity, torques[shoe], law.torque(tops[shoe]), 1e-9, SHIGLEY)
    ratio = DrumBrakeShoe(*size, *ends, friction).leading_over_trailing()
    for what, values in (("pressures", tops), ("torques", torques)):
        found = values["leading"] / values["trailing"]
        yield compare(f"leading over trailing, {what} [1]", found, ratio, 1e-9, SHIGLEY)
    quantity = "largest pressure, leading, problem 16-1 [kPa]"
    yield compare(quantity, tops["leading"] / 1e3, 734, 1e-3, SHIGLEY)
    yield from _random_shoes()


def _random_shoes() -> Iterator[Check]:
    rng = np.random.default_rng(7)
    for sense in (1, -1, 1, -1):
        b, friction, moment = rng.uniform((0.3, 0.05, 50), (4.0, 0.35, 1e3))
        radius, near, width = rng.uniform((0.1, 0.6, 0.02), (0.2, 0.9, 0.06))
        start, end = rng.uniform((0.2, 1.8), (0.6, 2.4))
        size = (radius, near * radius, width)
        law = DrumBrakeShoe(*size, start, end, sense * friction, b)
        case = cases.drum_brake(b, sense, moment, *size, (start, end), friction)
        θ = np.arctan2(case.patch.points[:, 1], case.patch.points[:, 0])
        name = f", b = {b:.3g}, mu = {sense * friction:.3g}"
        found = case.steady().pressure
        yield worst(f"pressure{name} [Pa]", found, law.pressure(θ, moment))
        yield dissipation(case, name)

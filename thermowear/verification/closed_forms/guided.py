"""Faces with one free motion: arcs (cases 3 and 4), a block (5) and a shoe (7) on pivots."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...laws.principle.patch import wear_vectors
from ...laws.principle.steady import SelfLocking
from ...reference import rigid_faces as reference
from ...reference.rigid_faces import ArcBlock, DrumBrakeShoe, LeverBlock
from ..check import Check, compare, printed
from . import patches as cases
from .patches import CLOSED_FORM, EXPONENTS, MPA, dissipation, worst

SHIGLEY = "Budynas and Nisbett, Shigley's Mechanical Engineering Design, long-shoe law"
_SYMMETRIC = ArcBlock(reference.RADIUS, reference.WIDTH, -0.5, 0.5, 0.0)
_ASYMMETRIC = ArcBlock(reference.RADIUS, reference.WIDTH, -0.2, 0.7, reference.FRICTION)


def case_3() -> Iterator[Check]:
    """Block above a disk rotating in either sense."""
    force, mu = reference.FORCE, reference.FRICTION
    for b, peak in reference.SYMMETRIC.items():
        face = replace(_SYMMETRIC, b=b)
        without = cases.block_on_disk(face, force, probes=(0.0,)).steady()
        for friction in (0.0, mu, -mu, 0.9):
            case = cases.block_on_disk(replace(face, friction=friction), force, probes=(0.0,))
            steady, name = case.steady(), f", b = {b:g}, mu = {friction:g}"
            yield printed(f"largest pressure{name} [MPa]", steady.pressure[-1] / MPA, peak)
            quantity = f"pressure against the one without friction{name} [Pa]"
            yield worst(quantity, steady.pressure, without.pressure, 1e-10)
            guide, quantity = case.patch.force(steady.pressure)[0], f"force of the guide{name} [N]"
            yield compare(quantity, guide, friction * force, 1e-10, CLOSED_FORM, scale=force)
        if b == 1:
            quantity, found = "largest pressure, formula of b = 1 [Pa]", without.pressure[-1]
            yield compare(quantity, found, face.symmetric_peak(force), 1e-10, CLOSED_FORM)
    yield from _arcs(cases.block_on_disk)


def case_4() -> Iterator[Check]:
    """Segment inside a ring: the block on a disk with its normal reversed."""
    yield from _arcs(cases.ring_segment)


def _arcs(build) -> Iterator[Check]:
    """Tabulated pressures, and pressures and rates on random arcs."""
    for sense, peak in reference.ASYMMETRIC.items():
        face = replace(_ASYMMETRIC, friction=sense * _ASYMMETRIC.friction)
        case = build(face, reference.FORCE, probes=(0.0,))
        quantity = f"largest pressure, asymmetric, sense {sense:+d} [MPa]"
        yield printed(quantity, case.steady().pressure[-1] / MPA, peak)
    rng = np.random.default_rng(3)
    for sense in (1, -1, 1, -1):
        b, friction = rng.uniform(0.3, 4.0), rng.uniform(0.0, 0.8)
        start, end = rng.uniform(-1.0, 0.0), rng.uniform(0.1, 1.0)
        force, radius, width = rng.uniform((100, 0.01, 0.005), (5e3, 0.1, 0.05))
        face = ArcBlock(radius, width, start, end, sense * friction, b)
        case = build(face, force)
        steady, name = case.steady(), f", b = {b:.3g}, mu = {face.friction:.3g}"
        α = np.arctan2(case.patch.points[:, 0], case.patch.points[:, 1])
        yield worst(f"pressure{name} [Pa]", steady.pressure, face.pressure(α, force))
        vertical = face.rate(force, case.laws[0].factor(case.patch.speed))
        yield worst(f"normal wear rate{name} [m/s]", steady.rates[0], vertical * np.cos(α))
        vectors = wear_vectors(case.patch, steady)
        yield worst(f"vertical wear rate{name} [m/s]", abs(vectors.rates[0][:, 1]), vertical)
        yield worst(f"inclination χ{name} [rad]", vectors.inclination, np.abs(α))
        yield dissipation(case, name)


def case_5() -> Iterator[Check]:
    """Block on a lever; self-locking with negative friction from a known one on."""
    lever, moment = reference.LEVER, reference.LEVER_MOMENT
    for (b, sense), ends in reference.LEVER_ENDS.items():
        face = replace(lever, b=b, friction=sense * lever.friction)
        case = cases.brake_block(face, moment, probes=(lever.inner, lever.outer))
        pressures = case.steady().pressure[-2:] / MPA
        for place, p, known in zip(("inner", "outer"), pressures, ends, strict=True):
            quantity = f"pressure at the {place} end, b = {b:g}, sense {sense:+d} [MPa]"
            yield printed(quantity, p, known)
    rng = np.random.default_rng(5)
    for sense in (1, -1, 1, -1):
        b, friction, load = rng.uniform((0.3, 0.0, 10), (4.0, 0.6, 1e3))
        inner, span, offset, width = rng.uniform((0.02, 0.02, 0.0, 0.005), (0.1, 0.1, 0.05, 0.05))
        face = LeverBlock(inner, inner + span, offset, width, sense * friction, b)
        case = cases.brake_block(face, load)
        steady, name = case.steady(), f", b = {b:.3g}, mu = {face.friction:.3g}"
        z = case.patch.points[:, 2]
        yield worst(f"pressure{name} [Pa]", steady.pressure, face.pressure(z, load))
        rate = face.rate(load, case.laws[0].factor(case.patch.speed)) * z
        yield worst(f"normal wear rate{name} [m/s]", steady.rates[0], rate)
        yield dissipation(case, name)
    for b in EXPONENTS:
        limit = replace(lever, b=b).locking_friction()
        found = _self_locking_friction(b, 0.99 * limit, 1.01 * limit)
        quantity = f"least friction of self-locking, b = {b:g} [1]"
        yield compare(quantity, found, limit, 1e-6, CLOSED_FORM)


def _self_locking_friction(b: float, free: float, locked: float) -> float:
    """Least friction for which the solver reports self-locking, by bisection."""
    while locked - free > 1e-6 * free:
        friction = (free + locked) / 2
        face = replace(reference.LEVER, b=b, friction=-friction)
        try:
            cases.brake_block(face, reference.LEVER_MOMENT).steady()
        except SelfLocking:
            locked = friction
        else:
            free = friction
    return (free + locked) / 2


def case_7() -> Iterator[Check]:
    """Shoe in a drum: the long-shoe law, leading and trailing, and other exponents."""
    trailing = DrumBrakeShoe(0.15, 0.125, 0.04, 0.0, np.radians(120), 0.28)
    moment = 2.2e3 * 2 * 0.125 * np.cos(np.radians(30))
    torques, tops = {}, {}
    for sense, shoe in ((-1, "leading"), (1, "trailing")):
        law = replace(trailing, friction=sense * trailing.friction)
        case = cases.drum_brake(law, moment, probes=(np.pi / 2,))
        steady = case.steady()
        tops[shoe] = steady.pressure[-1]
        exact = tops[shoe] * np.sin(_angles(case))
        yield worst(f"long-shoe law, {shoe} [Pa]", steady.pressure, exact)
        actuating = law.actuating_moment(tops[shoe])
        yield compare(f"actuating moment, {shoe} [N m]", moment, actuating, 1e-9, SHIGLEY)
        torques[shoe] = -sense * case.patch.moment(steady.pressure, (0.0, 0.0, 0.0))[2]
        exact = law.torque(tops[shoe])
        yield compare(f"torque, {shoe} [N m]", torques[shoe], exact, 1e-9, SHIGLEY)
    ratio = trailing.leading_over_trailing()
    for what, values in (("pressures", tops), ("torques", torques)):
        found = values["leading"] / values["trailing"]
        yield compare(f"leading over trailing, {what} [1]", found, ratio, 1e-9, SHIGLEY)
    quantity = "largest pressure, leading, problem 16-1 [kPa]"
    yield compare(quantity, tops["leading"] / 1e3, 734, 1e-3, SHIGLEY)
    rng = np.random.default_rng(7)
    for sense in (1, -1, 1, -1):
        b, friction, moment = rng.uniform((0.3, 0.05, 50), (4.0, 0.35, 1e3))
        radius, near, width = rng.uniform((0.1, 0.6, 0.02), (0.2, 0.9, 0.06))
        start, end = rng.uniform((0.2, 1.8), (0.6, 2.4))
        law = DrumBrakeShoe(radius, near * radius, width, start, end, sense * friction, b)
        case, name = cases.drum_brake(law, moment), f", b = {b:.3g}, mu = {law.friction:.3g}"
        exact = law.pressure(_angles(case), moment)
        yield worst(f"pressure{name} [Pa]", case.steady().pressure, exact)
        yield dissipation(case, name)


def _angles(case: cases.SpecialCase) -> np.ndarray:
    """Angles θ of the points of a shoe [rad]."""
    return np.arctan2(case.patch.points[:, 1], case.patch.points[:, 0])

"""Flat face that translates (case 1) and tilts (cases 2 and 6)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...reference import flat_face
from ..check import Check, compare, printed
from . import patches as cases
from .patches import CLOSED_FORM, EXPONENTS, MPA, dissipation, worst


def case_1() -> Iterator[Check]:
    """Punch that translates without tilting."""
    rng = np.random.default_rng(1)
    for b in (*EXPONENTS, *rng.uniform(0.3, 4.0, 2)):
        force, length, width, speed = rng.uniform((1e2, 0.01, 0.01, 0.01), (1e5, 0.1, 0.1, 1.0))
        case = cases.punch(b, force, length, width, speed)
        steady, name = case.steady(), f", b = {b:.3g}"
        exact = flat_face.centred_pressure(force, length * width)
        yield worst(f"pressure{name} [Pa]", steady.pressure, exact)
        factor = float(case.laws[0].factor(np.array([speed]))[0])
        exact = flat_face.volume_rate(force, length * width, factor, b)
        volume = case.patch.weights @ steady.rates[0]
        yield compare(f"volume rate{name} [m³/s]", volume, exact, 1e-9, CLOSED_FORM)
        yield dissipation(case, name)


def case_2() -> Iterator[Check]:
    """Rectangular punch that translates and tilts about both axes."""
    for b, (constant, slope, *pressures) in flat_face.TILTING_PUNCH.items():
        case = cases.tilting_punch(b, probes=(0.0, 0.03, 0.06))
        found = case.pressure(3) / MPA
        rate = found**b
        name = f", b = {b:g}"
        yield printed(f"p^b in the middle{name} [MPa^b]", rate[1], constant)
        fall = (rate[0] - rate[2]) / (2 * rate[1])
        yield printed(f"fall of p^b to the edge{name} [1]", fall, slope)
        for place, p, known in zip((0, 30, 60), found, pressures, strict=True):
            yield printed(f"pressure at x = {place} mm{name} [MPa]", p, known)
        x = case.patch.points[:, 0] - 0.03
        exact = flat_face.tilted_pressure(x, 10e3, -50.0, 0.06, 0.08, b)
        yield worst(f"pressure{name} [Pa]", case.steady().pressure, exact)
        yield dissipation(case, name)


def case_6() -> Iterator[Check]:
    """Block that translates and tilts about a joint, with full and partial contact."""
    rng = np.random.default_rng(6)
    for eccentricity in (-0.12, 0.05, 0.15, -0.25, 0.4):  # of the length; partial from 1/6 on
        for b in EXPONENTS:
            sense = int(rng.choice((-1, 1)))
            force, start, length, width = rng.uniform((500, 0.0, 0.05, 0.01), (5e3, 0.1, 0.2, 0.05))
            joint, height, friction = rng.uniform((-0.1, 0.01, 0.1), (0.1, 0.05, 0.5))
            middle, offset = start + length / 2, eccentricity * length * force
            moment = force * (middle - joint) + sense * friction * height * force + offset
            zone = flat_face.contact_length(force, offset, length, b)
            end = start + (zone if offset < 0 else length - zone)
            case = cases.tilting_block(
                b, sense, force, moment, (start, start + length), joint, height, width, friction,
                split=(end,) if zone < length else (),
            )  # fmt: skip
            steady = case.steady()
            state = "partial contact" if zone < length else "full contact"
            name = f", b = {b:g}, mu = {sense * friction:.3g}, {state}"
            ζ = case.patch.points[:, 2] - middle
            exact = flat_face.tilted_pressure(ζ, force, offset, length, width, b)
            smooth = zone == length or b <= 1  # else the root at the edge limits the quadrature
            allowed = 1e-9 if smooth else 1e-4
            yield worst(f"pressure{name} [Pa]", steady.pressure, exact, allowed)
            if b == 1 and zone == length:
                exact = flat_face.linear_pressure(ζ, force, offset, length, width)
                yield worst(f"linear pressure{name} [Pa]", steady.pressure, exact)
            yield dissipation(case, name)

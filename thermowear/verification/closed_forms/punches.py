"""Faces that translate and tilt: punches and a block (cases 1, 2, 6), a ring (8), and a pad (9)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...laws import LocalState
from ...reference import annular_punch as ring
from ...reference import rigid_faces
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
        exact = rigid_faces.centred_pressure(force, length * width)
        yield worst(f"pressure{name} [Pa]", steady.pressure, exact)
        factor = float(case.laws[0].factor(np.array([speed]))[0])
        exact = rigid_faces.volume_rate(force, length * width, factor, b)
        volume = case.patch.weights @ steady.rates[0]
        yield compare(f"volume rate{name} [m³/s]", volume, exact, 1e-9, CLOSED_FORM)
        yield dissipation(case, name)


def case_2() -> Iterator[Check]:
    """Rectangular punch that translates and tilts about both axes."""
    for b, (constant, slope, *pressures) in rigid_faces.TILTING_PUNCH.items():
        case = cases.tilting_punch(b, probes=(0.0, 0.03, 0.06))
        found = case.steady().pressure[-3:] / MPA
        rate = found**b
        name = f", b = {b:g}"
        yield printed(f"p^b in the middle{name} [MPa^b]", rate[1], constant)
        fall = (rate[0] - rate[2]) / (2 * rate[1])
        yield printed(f"fall of p^b to the edge{name} [1]", fall, slope)
        for place, p, known in zip((0, 30, 60), found, pressures, strict=True):
            yield printed(f"pressure at x = {place} mm{name} [MPa]", p, known)
        x = case.patch.points[:, 0] - 0.03
        exact = rigid_faces.tilted_pressure(x, 10e3, -50.0, 0.06, 0.08, b)
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
            zone = rigid_faces.contact_length(force, offset, length, b)
            end = start + (zone if offset < 0 else length - zone)
            case = cases.tilting_block(
                b, sense, force, moment, (start, start + length), joint, height, width, friction,
                split=(end,) if zone < length else (),
            )  # fmt: skip
            steady = case.steady()
            state = "partial contact" if zone < length else "full contact"
            name = f", b = {b:g}, mu = {sense * friction:.3g}, {state}"
            ζ = case.patch.points[:, 2] - middle
            exact = rigid_faces.tilted_pressure(ζ, force, offset, length, width, b)
            smooth = zone == length or b <= 1  # else the root at the edge limits the quadrature
            allowed = 1e-9 if smooth else 1e-4
            yield worst(f"pressure{name} [Pa]", steady.pressure, exact, allowed)
            if b == 1 and zone == length:
                exact = rigid_faces.linear_pressure(ζ, force, offset, length, width)
                yield worst(f"linear pressure{name} [Pa]", steady.pressure, exact)
            yield dissipation(case, name)


def case_8() -> Iterator[Check]:
    """Ring rotating on a plate, with flat, conical and toroidal faces."""
    inner, outer = 0.02, 0.12
    force = 100e6 * np.pi * (outer**2 - inner**2)
    places = np.array([0.02, 0.04, 0.07, 0.12])
    for b, (power, constant, pressures, torque) in ring.STEADY_PRESSURE.items():
        r, w = cases.along(inner, outer, probes=places)
        case = cases.annular_punch(b, 1.0, force, r, 2 * np.pi * r * w, friction=0.25)
        steady, name = case.steady(), f", b = {b:g}"
        found = steady.pressure[-len(places) :] / MPA
        product = found[0] * (1e3 * places[0]) ** power
        yield printed(f"p r^{power:g}{name} [MPa mm^{power:g}]", product, constant)
        for place, p, known in zip(places, found, pressures, strict=True):
            yield printed(f"pressure at r = {1e3 * place:g} mm{name} [MPa]", p, known)
        turned = case.patch.moment(steady.pressure, (0.0, 0.0, 0.0))[2] / 0.25
        yield printed(f"torque over mu{name} [N mm]", 1e3 * turned, torque)
        exact = ring.torque(force, inner, outer, 1.0, b, 1.0)
        yield compare(f"torque over mu{name} [N m]", turned, exact, 1e-9, CLOSED_FORM)
        yield dissipation(case, name)
    yield from _cones()
    yield from _tori()


def _cones() -> Iterator[Check]:
    rng = np.random.default_rng(8)
    for _ in range(4):
        b, a, α, mu, mu_d = rng.uniform((0.3, 0.5, 0.5, 0.0, 0.0), (4.0, 2.0, np.pi / 2, 0.5, 0.5))
        inner, span, force = rng.uniform((0.01, 0.02, 1e3), (0.05, 0.1, 1e6))
        r, w = cases.along(inner, inner + span)
        area = 2 * np.pi * r * w / np.sin(α)
        case = cases.annular_punch(b, a, force, r, area, α, mu, mu_d)
        steady, name = case.steady(), f", cone, b = {b:.3g}, a = {a:.3g}, mu_d = {mu_d:.3g}"
        exact = ring.conical_pressure(r, force, inner, inner + span, α, mu_d, b, a)
        yield worst(f"pressure{name} [Pa]", steady.pressure, exact)
        vertical = case.laws[0].value(LocalState(exact, case.patch.speed)) / np.sin(α)
        yield worst(f"vertical wear rate{name} [m/s]", steady.velocity[0], vertical)
        yield dissipation(case, name)


def _tori() -> Iterator[Check]:
    rng = np.random.default_rng(18)
    for _ in range(4):
        b, a, mu, mu_d = rng.uniform((0.3, 0.5, 0.0, 0.0), (4.0, 2.0, 0.5, 0.5))
        centre, rounding, force = rng.uniform((0.05, 0.005, 1e3), (0.1, 0.04, 1e5))
        start, end = rng.uniform((0.3, 1.2), (0.8, np.pi / 2))
        α, w = cases.along(start, end)
        r = centre + rounding * np.cos(α)
        case = cases.annular_punch(b, a, force, r, 2 * np.pi * r * rounding * w, α, mu, mu_d)
        name = f", torus, b = {b:.3g}, a = {a:.3g}, mu_d = {mu_d:.3g}"
        exact = ring.toroidal_pressure(α, force, centre, rounding, start, end, mu_d, b, a)
        yield worst(f"pressure{name} [Pa]", case.steady().pressure, exact)
        yield dissipation(case, name)


def case_9() -> Iterator[Check]:
    """Pad on a disk, without and with free tilting."""
    rng = np.random.default_rng(9)
    for same in (True, True, False, False):
        b, a, angle, force = rng.uniform((0.3, 0.5, 0.3, 100), (3.0, 2.0, 2.0, 1e4))
        a = b if same else a
        inner, span, friction = rng.uniform((0.05, 0.03, 0.1), (0.1, 0.08, 0.5))
        radii = (inner, inner + span)
        case = cases.disk_brake(b, a, force, radii, angle, friction=friction)
        steady, name = case.steady(), f", b = {b:.3g}, a = {a:.3g}"
        r = np.hypot(case.patch.points[:, 0], case.patch.points[:, 1])
        exact = ring.steady_pressure(r, force, *radii, b, a, angle)
        yield worst(f"pressure{name} [Pa]", steady.pressure, exact)
        yield dissipation(case, name)
        if same:
            largest = float(np.mean(steady.pressure * r / inner))
            carried = ring.uniform_wear_force(largest, *radii, angle)
            quantity = f"force θ p_a ri (ro - ri){name} [N]"
            yield compare(quantity, force, carried, 1e-9, CLOSED_FORM)
            torque = case.patch.moment(steady.pressure, (0.0, 0.0, 0.0))[2]
            known = ring.uniform_wear_torque(force, friction, *radii)
            yield compare(f"torque{name} [N m]", torque, known, 1e-9, CLOSED_FORM)
    for height in (0.0, 0.01, 0.02):
        a, angle, force, friction = rng.uniform((0.5, 0.8, 100, 0.1), (2.0, 1.5, 1e4, 0.5))
        lift = friction * height
        centre = (rng.uniform(0.074, 0.078), rng.uniform(-0.002, 0.002) - lift)
        case = cases.disk_brake(1.0, a, force, (0.06, 0.1), angle, centre, friction, height)
        name = f", tilting, a = {a:.3g}, mu = {friction:.3g}, height {1e3 * height:g} mm"
        x, y = case.patch.points[:, 0], case.patch.points[:, 1]
        exact = ring.tilted_pressure(x, y, force, centre, 0.06, 0.1, angle, a, lift)
        yield worst(f"pressure{name} [Pa]", case.steady().pressure, exact)
        yield dissipation(case, name)

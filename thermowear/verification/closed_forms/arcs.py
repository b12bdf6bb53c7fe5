"""Block on a disk (case 3) and segment inside a ring (case 4)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...laws.principle.patch import wear_vectors
from ...reference import block_on_disk as arc
from ..check import Check, compare
from . import patches as cases
from .rows import CLOSED_FORM, MPA, dissipation, printed, worst


def case_3() -> Iterator[Check]:
    """Block above a disk rotating in either sense."""
    data = (arc.FORCE, arc.RADIUS, arc.WIDTH)
    for b, peak in arc.SYMMETRIC.items():
        without = cases.block_on_disk(b, (-0.5, 0.5), *data, 0.0, 1, probes=(0.0,)).steady()
        for friction, sense in ((0.0, 1), (arc.FRICTION, 1), (arc.FRICTION, -1), (0.9, 1)):
            case = cases.block_on_disk(b, (-0.5, 0.5), *data, friction, sense, probes=(0.0,))
            steady, name = case.steady(), f", b = {b:g}, mu = {sense * friction:g}"
            quantity = f"largest pressure{name} [MPa]"
            yield printed(quantity, steady.pressure[-1] / MPA, peak)
            quantity = f"pressure against the one without friction{name} [Pa]"
            yield worst(quantity, steady.pressure, without.pressure, 1e-10)
            guide = case.patch.force(steady.pressure)[0]
            exact = sense * friction * arc.FORCE
            quantity = f"force of the guide{name} [N]"
            yield compare(quantity, guide, exact, 1e-10, CLOSED_FORM, scale=arc.FORCE)
        if b == 1:
            exact = arc.symmetric_peak(*data, 0.5)
            quantity = "largest pressure, formula of b = 1 [Pa]"
            yield compare(quantity, without.pressure[-1], exact, 1e-10, CLOSED_FORM)
    for sense, peak in arc.ASYMMETRIC.items():
        case = cases.block_on_disk(1.0, (-0.2, 0.7), *data, arc.FRICTION, sense, probes=(0.0,))
        quantity = f"largest pressure, asymmetric, sense {sense:+d} [MPa]"
        yield printed(quantity, case.pressure(1)[0] / MPA, peak)
    yield from _random_arcs(cases.block_on_disk)


def case_4() -> Iterator[Check]:
    """Segment inside a ring: the block on a disk with its normal reversed."""
    data = (arc.FORCE, arc.RADIUS, arc.WIDTH)
    for sense, peak in arc.ASYMMETRIC.items():
        case = cases.ring_segment(1.0, (-0.2, 0.7), *data, arc.FRICTION, sense, probes=(0.0,))
        quantity = f"largest pressure, asymmetric, sense {sense:+d} [MPa]"
        yield printed(quantity, case.pressure(1)[0] / MPA, peak)
    yield from _random_arcs(cases.ring_segment)


def _random_arcs(build) -> Iterator[Check]:
    """Pressures and rates on random arcs."""
    rng = np.random.default_rng(3)
    for sense in (1, -1, 1, -1):
        b, friction = rng.uniform(0.3, 4.0), rng.uniform(0.0, 0.8)
        start, end = rng.uniform(-1.0, 0.0), rng.uniform(0.1, 1.0)
        force, radius, width = rng.uniform((100, 0.01, 0.005), (5e3, 0.1, 0.05))
        case = build(b, (start, end), force, radius, width, friction, sense)
        steady, name = case.steady(), f", b = {b:.3g}, mu = {sense * friction:.3g}"
        α = np.arctan2(case.patch.points[:, 0], case.patch.points[:, 1])
        exact = arc.steady_pressure(α, force, radius, width, start, end, sense * friction, b)
        yield worst(f"pressure{name} [Pa]", steady.pressure, exact)
        integral = arc.bearing_integral(radius, width, start, end, sense * friction, b)
        factor = case.laws[0].factor(case.patch.speed)
        vertical = arc.vertical_rate(force, integral, factor, b)
        yield worst(f"normal wear rate{name} [m/s]", steady.rates[0], vertical * np.cos(α))
        vectors = wear_vectors(case.patch, steady)
        yield worst(f"vertical wear rate{name} [m/s]", abs(vectors.rates[0][:, 1]), vertical)
        yield worst(f"inclination χ{name} [rad]", vectors.inclination, np.abs(α))
        yield dissipation(case, name)

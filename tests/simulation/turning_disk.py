"""Brake disk in space at given Péclet numbers and constant friction power, and its face."""

from __future__ import annotations

import math

import numpy as np

import thermowear as tw

from ..case.starter import changed, tables

AMBIENT, POWER, FRICTION = 293.15, 350.0, 0.38
CONDUCTIVITY, CAPACITY = 48.0, 7200.0 * 460.0
INNER, OUTER, ANGLE = 0.080, 0.125, math.radians(56)
MEAN = (INNER + OUTER) / 2
LENGTH = ANGLE * MEAN


def turning_case(peclet, elements=6, advection="resolved", **changes):
    """Half of the disk of the starter at ``Pe = v L/κ``, L the length of the pad at mean radius."""
    speed = peclet * CONDUCTIVITY / CAPACITY / LENGTH
    case = {
        "geometry.half": True,
        "mesh": {"degree": 2, "elements": elements, "grading": 0.7, "solver": "direct"},
        "load": {"force": f"{POWER / FRICTION / speed} N"},
        "motion": {"angular_velocity": f"{speed / MEAN} rad/s"},
        "heat.power": None,
        "heat.cooling.disk_back": None,
        "heat.advection": advection,
        "wear.disk": None,
    }
    return changed(changed(tables("disk-brake-3d"), case), changes)


def turning(peclet, elements=6, advection="resolved", **changes):
    """Results of `turning_case`."""
    return tw.run(tw.load(turning_case(peclet, elements, advection, **changes)))


def disk(result) -> tuple[np.ndarray, np.ndarray]:
    """Points of the disk, shape (n, 3) [m], and temperature rises there [K]."""
    fields = result.fields
    own = fields.body == 2
    return fields.points[own].reshape(-1, 3), fields.temperature[own].ravel() - AMBIENT


def circles(result) -> dict[float, tuple[np.ndarray, np.ndarray]]:
    """Angles [rad] and rises [K] at nodes of the rubbed face, in the order of θ, by radius [m]."""
    points, rise = disk(result)
    on_face = np.abs(points[:, 2]) < 1e-9
    x, y, _ = points[on_face].T
    rise, radius, angle = rise[on_face], np.round(np.hypot(x, y), 9), np.arctan2(y, x)
    found = {}
    for r in np.unique(radius):
        _, first = np.unique(np.round(angle[radius == r], 6), return_index=True)
        at = angle[radius == r][first]
        if len(first) > 30 and np.diff(at).max() < 0.6:  # others lie inside of cells
            found[float(r)] = at, rise[radius == r][first]
    return found


def wiggles(rise: np.ndarray) -> float:
    """Variation round a circle beyond that of one rise and one fall [K]."""
    return float(np.abs(np.diff(rise, append=rise[0])).sum() / 2 - np.ptp(rise))

"""Holder, loads and motion of a case."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...case.tables.schema import Case
from ...model.holder import Holder, Motion


def holder(case: Case) -> Holder:
    """Holder of body 1 and the loads on it."""
    load, geometry, free = case.load, case.geometry, case.holder.free
    dim = len(geometry.press_direction)
    pivot = np.array(case.holder.pivot or geometry.pivot_point or np.zeros(dim), dtype=float)
    point = pivot + (load.lever or 0.0) * np.eye(dim)[0]
    if load.point is not None:
        point[: len(load.point)] = load.point
    about_x, about_y = load.moments or (0.0, 0.0)
    return Holder(
        load_direction=geometry.press_direction,
        pivot=tuple(map(float, pivot)),
        point=tuple(map(float, point)),
        free=free,
        force=case.force(),
        approach=case.approach(),
        tangential_force=load.tangential_force or 0.0,
        moments=(about_x, about_y, load.moment or 0.0),
        closing_moment=load.moment if free == ("rotation",) else None,
        history=None if load.history is None else load.history.loads,
        surface_forces=load.surfaces,
        surface_pressures=load.pressure,
    )


def motion(case: Case) -> Motion:
    """Sliding motion; the mean speed along +x where it reciprocates."""
    geometry, given = case.geometry, case.motion
    still = Motion(
        center=geometry.rotation_center,
        across=geometry.slides_across,
        passes=geometry.passes,
    )
    if given is None:
        return still
    velocity, history = given.velocity, given.history
    if given.amplitude is not None and given.frequency is not None:
        velocity = 4 * given.amplitude * given.frequency
    return replace(
        still,
        velocity=velocity,
        angular_velocity=given.angular_velocity,
        history=None if history is None else history.function,
    )

"""Sliding at an interface from the motions of its two bodies."""

from __future__ import annotations

from dataclasses import replace

from ..errors import CaseError
from .conditions import Motion


def relative_motion(first: Motion | None, second: Motion | None, axisymmetric: bool) -> Motion:
    """Sliding of the first body of an interface over the second one.

    Parameters
    ----------
    first, second : Motion or None
        Motions of the bodies: along x, across a section, about the axis of an axisymmetric model,
        anticlockwise about a centre, or about an axis in space in place. None: at rest.
    axisymmetric : bool

    Raises
    ------
    CaseError
        If both bodies move other than along or about the same axis.
    """
    if first is None and second is None:
        return Motion()
    if first is None:
        return _over_moving(second, axisymmetric)
    if second is None:
        return _over_resting(first, axisymmetric)
    if first.axis is not None or second.axis is not None:
        raise CaseError(
            "motions: a body that turns about an axis in place must slide on one at rest"
        )
    one, other = _moving(first, axisymmetric), _over_moving(second, axisymmetric)
    turn = one.angular_velocity is not None, other.angular_velocity is not None
    if turn[0] != turn[1] or one.across != other.across or one.history != other.history:
        raise CaseError(
            "motions: two bodies that slide on each other must both translate, or both rotate "
            "about the axis of the model, with one history"
        )
    velocity = _sum(one.velocity, other.velocity)
    angular_velocity = _sum(one.angular_velocity, other.angular_velocity)
    if not velocity and not angular_velocity:  # both move alike
        return Motion()
    return replace(other, velocity=velocity, angular_velocity=angular_velocity)


def _over_resting(motion: Motion, axisymmetric: bool) -> Motion:
    """Motion of a moving first body over one at rest: the opposite one of the second body."""
    if motion.axis is not None:
        return replace(motion, center=None)
    found = _over_moving(motion, axisymmetric).faster(-1.0)
    return replace(found, moving_side=0) if found.passes else found


def _moving(motion: Motion, axisymmetric: bool) -> Motion:
    """Motion of the first body, of two that move."""
    if motion.velocity is None and not axisymmetric:
        raise CaseError("motions: two bodies in contact cannot both rotate about a centre")
    return replace(motion, center=None)


def _over_moving(motion: Motion | None, axisymmetric: bool) -> Motion:
    """Motion of a first body at rest over a moving one."""
    assert motion is not None
    if motion.axis is not None:
        assert motion.angular_velocity is not None
        return replace(motion, angular_velocity=-motion.angular_velocity, center=None)
    if motion.velocity is not None:
        passes = not motion.across and not axisymmetric
        return replace(motion, velocity=-motion.velocity, center=None, passes=passes)
    if axisymmetric:
        assert motion.angular_velocity is not None
        return replace(motion, angular_velocity=-motion.angular_velocity, center=None)
    return replace(motion, passes=True)


def _sum(one: float | None, other: float | None) -> float | None:
    return None if one is None or other is None else one + other

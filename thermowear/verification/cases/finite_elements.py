"""Special cases by finite elements: running-in to the pressure and shape of the steady principle.

A steady pressure needs no finite elements, only the worn shape does. The check is therefore a
running-in from unworn faces, whose final pressure and shape must be the steady ones.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...case.tables.schema import Case
from ...laws.motions import RigidMotion, rotation, translation
from ...results import Result
from ...simulation.from_case import model_of
from ..check import Check, compare
from ..starter import computed, starter

PRINCIPLE = "steady state from the principle of minimum wear dissipation power"
EDGE = 2e-3
"""Distance from the ends of a face that is excluded, as corner stresses are singular [m]."""

_UNWORN = "wear.update=never"
"""The steady state refers to the unworn bodies, so the running-in must not thin them."""
_TRANSIENT = "analysis={type='transient', until='steady', steady_tolerance=1e-3, tolerance=1e-3}"


def running_in(
    label: str, name: str, *overrides: str, without: tuple[str, ...] = ()
) -> Iterator[Check]:
    """Pressure and worn shape at the end of a running-in from unworn faces.

    Parameters
    ----------
    label : str
        Label of the run in the output.
    name, *overrides, without
        See `starter`.
    """
    case = starter(name, *overrides, without=without)
    direct = computed(case)
    reached = computed(starter(name, *overrides, _TRANSIENT, _UNWORN, without=without))
    name = f"{name}, {label}" if label else name
    inner = away_from_ends(case, direct)
    steady = direct.interface
    off = reached.interface.pressure - steady.pressure
    found, size = (_mean_square(direct, p, inner) for p in (off, steady.pressure))
    quantity = f"{name}: pressure after running-in minus the steady one, root mean square [Pa]"
    yield compare(quantity, found, 0.0, 0.01, PRINCIPLE, size)
    off = _without_motion(case, direct, reached.interface.shape - steady.shape, inner)
    size = float(np.ptp(steady.shape[inner]))
    for measure, found, allowed in (
        ("root mean square", _mean_square(direct, off, inner), 0.01),
        ("largest", float(np.abs(off[inner]).max()), 0.02),
    ):
        quantity = f"{name}: worn shape after running-in minus the steady one, {measure} [m]"
        yield compare(quantity, found, 0.0, allowed, PRINCIPLE, size)


def away_from_ends(case: Case, result: Result) -> np.ndarray:
    """Mask of points away from the ends of the face, shape (n,); faces in space have four sides."""
    i, center = result.interface, case.geometry.rotation_center
    lengths = [i.s] if case.model != "3d" else [i.x, i.y]
    if case.model == "3d" and center is not None:
        radius = np.hypot(i.x - center[0], i.y - center[1])
        lengths = [radius, radius * np.arctan2(i.y - center[1], i.x - center[0])]
    inside = [(x > x.min() + EDGE) & (x < x.max() - EDGE) for x in lengths]
    return np.all(inside, axis=0)


def _mean_square(result: Result, values: np.ndarray, inner: np.ndarray) -> float:
    """Root mean square, weighted with the area of the points."""
    return float(np.sqrt(np.average(values[inner] ** 2, weights=result.interface.weight[inner])))


def _without_motion(
    case: Case, result: Result, heights: np.ndarray, inner: np.ndarray
) -> np.ndarray:
    """Heights minus their least-squares fit by a constant and the rigid motions of the holder.

    Shapes are determined up to these.
    """
    profile = result.profile
    points = np.column_stack([profile.x, profile.y, profile.z])
    normals = np.column_stack([profile.normal_x, profile.normal_y, profile.normal_z])
    closing = [(_motion(case, m).at(points) * normals).sum(axis=1) for m in case.holder.free]
    modes = np.column_stack([np.ones(len(points)), *closing])
    amplitudes = np.linalg.lstsq(modes[inner], heights[inner], rcond=None)[0]
    return heights - modes @ amplitudes


def _motion(case: Case, name: str) -> RigidMotion:
    """Rigid motion of the holder, of either sign."""
    if name in _AXES:
        return translation(_AXES[name])
    if name in _TURNS:
        return rotation(_TURNS[name], np.array(model_of(case).holder.pivot))
    return translation(case.geometry.press_direction)


_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0)}
_TURNS = {"rotation": (0.0, 0.0, 1.0), "rotation-x": (1.0, 0.0, 0.0), "rotation-y": (0.0, 1.0, 0.0)}

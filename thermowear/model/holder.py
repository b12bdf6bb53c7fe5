"""Rigid holder of body 1 and the loads on it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..laws.time_course import LoadHistory


@dataclass(frozen=True)
class Holder:
    """Rigid holder of a body: its free motions, and the loads or given motions along them.

    Attributes
    ----------
    load_direction : tuple of float
        Unit vector of the load direction, towards body 2.
    pivot : tuple of float
        Centre of rotation [m].
    point : tuple of float
        Point of application of the force [m].
    free : tuple of str
        Free rigid motions: ``"z"`` along the load direction, ``"x"`` (and ``"y"``) across it,
        ``"rotation"`` in the section, ``"rotation-x"`` and ``"rotation-y"`` in space.
    force : float or None
        Force along the load direction, the maximum of a history [N].
    approach : float or None
        Given displacement along the load direction, the maximum of a history [m].
    tangential_force : float
        Force along x [N].
    moments : tuple of float
        Moments about x, y and z through the pivot, by the right-hand rule [N m].
    closing_moment : float or None
        Moment of a holder that can only rotate, positive where it closes the contact [N m].
    history : LoadHistory or None
        Time history of the loads.
    surface_forces : mapping of str to float
        Forces along the load direction, distributed evenly over surfaces of body 1 [N].
    surface_pressures : mapping of str to float
        Pressures on surfaces of either body, towards the body, constant in time [Pa].
    """

    load_direction: tuple[float, ...]
    pivot: tuple[float, ...]
    point: tuple[float, ...]
    free: tuple[str, ...] = ("z",)
    force: float | None = None
    approach: float | None = None
    tangential_force: float = 0.0
    moments: tuple[float, float, float] = (0.0, 0.0, 0.0)
    closing_moment: float | None = None
    history: LoadHistory | None = None
    surface_forces: Mapping[str, float] = field(default_factory=dict)
    surface_pressures: Mapping[str, float] = field(default_factory=dict)

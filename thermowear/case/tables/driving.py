"""Holder of body 1, loads on it, and sliding motion."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from ..values import units
from ..values.section import KeyFault, Section
from .history import FactorHistory, History

FreeMotion = Literal["x", "y", "z", "rotation", "rotation-x", "rotation-y"]


class HolderTable(Section):
    """Rigid holder of body 1, see `model.holder.Holder`.

    Attributes
    ----------
    pivot : tuple of float or None
        Centre of its rotation, by default that of the geometry, or the origin [m].
    """

    free: tuple[FreeMotion, ...] = ("z",)
    pivot: tuple[units.Coordinate, ...] | None = None

    @model_validator(mode="after")
    def _distinct_motions(self):
        if len(set(self.free)) != len(self.free):
            raise KeyFault("free", "names a motion twice")
        return self

    @property
    def turns(self) -> bool:
        return any(name.startswith("rotation") for name in self.free)


class LoadTable(Section):
    """Loads that press body 1 on body 2.

    Exactly one of force, mean pressure and approach; a holder that can only rotate may have a
    moment instead, and a fixed one needs forces or pressures on surfaces. Pressures on surfaces
    may also act alone.

    Attributes
    ----------
    mean_pressure : float or None
        Mean over the nominal contact area [Pa].
    force : float or None
        Normal force along the load direction, on the whole ring or on the thickness [N].
    approach : float or None
        Displacement of the holder along the load direction, towards body 2, from its position in
        the mesh [m].
    lever : float or None
        Distance along x from the pivot to the line of action of the force [m].
    point : tuple of float or None
        Point of application of the force: x, or x and y in space, by default at the pivot [m].
    moment : float or None
        Additional moment about the pivot [N m]: positive where it closes the contact if the holder
        can only rotate, anticlockwise otherwise.
    moments : tuple of float or None
        Moments about x and y through the pivot, in space, by the right-hand rule [N m].
    tangential_force : float or None
        Force along x, for a holder that is free along x [N].
    surfaces : dict of str to float
        Forces along the load direction, distributed evenly over surfaces of body 1 with a fixed
        holder [N].
    pressure : dict of str to float
        Pressures on surfaces of either body, normal to them and towards the body, in addition to
        all other loads and constant in time. Their resultant along a free motion of the holder
        enters its equilibrium with the contact [Pa].
    history : History or None
        Time history: of the loads of a fretting analysis, of the force of a transient one.
    """

    mean_pressure: units.Pressure | None = None
    force: units.Force | None = None
    approach: units.Length | None = None
    lever: units.Coordinate | None = None
    point: tuple[units.Coordinate, ...] | None = None
    moment: units.SignedMoment | None = None
    moments: tuple[units.SignedMoment, units.SignedMoment] | None = None
    tangential_force: units.SignedForce | None = None
    surfaces: dict[str, units.Force] = {}
    pressure: dict[str, units.Pressure] = {}
    history: History | None = None


class MotionTable(Section):
    """Sliding motion, see `model.holder.Motion`.

    Attributes
    ----------
    amplitude, frequency : float or None
        Reciprocating motion of body 1, ``x = amplitude sin(2 π frequency t)`` [m, Hz].
    """

    angular_velocity: units.AngularVelocity | None = None
    velocity: units.Velocity | None = None
    amplitude: units.Length | None = None
    frequency: units.Frequency | None = None
    history: FactorHistory | None = None

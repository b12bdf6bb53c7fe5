"""What drives body 1: its holder, the loads on it, and sliding."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from ..values import units
from ..values.section import KeyFault, Section
from .history import FactorHistory, History

FreeMotion = Literal["x", "y", "z", "rotation", "rotation-x", "rotation-y"]


class Holder(Section):
    """How body 1 is held.

    Attributes
    ----------
    free : tuple of str
        Motions it may make under its loads, or is given: ``"z"`` along the press, ``"x"`` (and
        ``"y"``) across it, ``"rotation"`` in the section, ``"rotation-x"`` and ``"rotation-y"`` in
        space.
    pivot : tuple of float or None
        Point about which it turns, by default that of the geometry, or the origin [m].
    """

    free: tuple[FreeMotion, ...] = ("z",)
    pivot: tuple[units.Coordinate, ...] | None = None

    @model_validator(mode="after")
    def _once(self):
        if len(set(self.free)) != len(self.free):
            raise KeyFault("free", "names a motion twice")
        return self

    @property
    def turns(self) -> bool:
        return any(name.startswith("rotation") for name in self.free)


class Load(Section):
    """What presses body 1 on body 2.

    Exactly one of force, mean pressure and approach; a holder that only turns may have a moment
    instead, and one that is fixed needs forces or pressures on surfaces. Pressures on surfaces may
    also press alone.

    Attributes
    ----------
    mean_pressure : float or None
        On the nominal contact area [Pa].
    force : float or None
        Of the whole ring, or of the thickness, along the press [N].
    approach : float or None
        How far the holder moves along the press, towards body 2, from where it stands in the mesh
        [m].
    lever : float or None
        Distance along x from the pivot to the line of the force [m].
    point : tuple of float or None
        Where the force acts: x, or x and y in space, by default at the pivot [m].
    moment : float or None
        About the pivot, in addition [N m]: positive where it presses if the holder only turns,
        anticlockwise otherwise.
    moments : tuple of float or None
        About x and y through the pivot, in space, by the right-hand rule [N m].
    tangential_force : float or None
        Along x, for a holder that is free along it [N].
    surfaces : dict of str to float
        Forces along the press, spread evenly over surfaces of body 1, whose holder is fixed [N].
    pressure : dict of str to float
        Pressures on surfaces of either body, normal to them and towards the body, in addition to
        all other loads and constant in time. What they press body 1 with along a free motion of
        its holder is in equilibrium with the contact, too [Pa].
    history : History or None
        What changes: the loads of a fretting analysis, the force of a transient one.
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


class Motion(Section):
    """Sliding.

    Attributes
    ----------
    angular_velocity : float or None
        Of body 1 about the axis of an axisymmetric model; of a disk or drum (body 2) about its
        centre, anticlockwise, in plane models and seen from above in space [rad/s].
    velocity : float or None
        Of body 1 over body 2 along x; negative: against it [m/s].
    amplitude, frequency : float or None
        Body 1 slides to and fro, ``x = amplitude sin(2 π frequency t)`` [m, Hz].
    history : FactorHistory or None
        How the speed of a transient analysis changes.
    """

    angular_velocity: units.AngularVelocity | None = None
    velocity: units.Velocity | None = None
    amplitude: units.Length | None = None
    frequency: units.Frequency | None = None
    history: FactorHistory | None = None

    @property
    def one_way(self) -> Motion:
        """The same, with the mean speed of sliding to and fro as a velocity along +x."""
        if self.amplitude is None or self.frequency is None:
            return self
        return self.model_copy(update={"velocity": 4 * self.amplitude * self.frequency})

"""Tables of the contacts, holders, motions and bodies of an assembly."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, model_validator

from ..tables.conditions import AxisTable, FreeMotion
from ..tables.contact import InterfaceTable
from ..tables.laws import Conductance
from ..tables.materials import BodyTable
from ..tables.tabulated import FactorHistory, History
from ..values import units
from ..values.json_schema import OrAlso
from ..values.section import KeyFault, Number, Section, Switch, UserFile, number_or

_PARTITION = number_or(
    "effusivity",
    None,
    where=lambda share: 0 <= share <= 1,
    allowed='at least 0 and at most 1, or "effusivity"',
)


_OF_SLIDING = (
    "friction",
    "friction_factor",
    "friction_history",
    "transverse_friction",
    "partition",
    "gap_conductance",
    "compliance",
    "fluid_pressure",
    "pressure_degree",
    "initial_shape",
)
"""Keys without a meaning for glued faces."""


def _names(value):
    """List of names from one name."""
    return (value,) if isinstance(value, str) else value


Names = Annotated[tuple[str, ...], BeforeValidator(_names), OrAlso({"type": "string"})]


SUPPORTS = ("fixed", "symmetry", "rollers", "mid_plane")
"""Keys of surfaces of a body that are held."""


class AssemblyContactTable(InterfaceTable):
    """Table ``contacts.NAME``; keys that are left out have the values of ``contact`` and ``heat``.

    Attributes
    ----------
    between : tuple of str or None
        Both contact faces, that of body 1 first; by default those of this name in the geometry.
    conductance, gap_conductance
        See `model.interface.Interface`.
    partition
        Fraction of the friction heat released on body 1; ``"effusivity"``: ``e1/(e1 + e2)``.
    initial_shape : str or None
        File with an initial worn shape, as ``geometry.initial_shape`` of a pair.
    tie : bool
        Glued faces, without friction, heat or wear.
    """

    between: tuple[str, str] | None = None
    conductance: Conductance | None = None
    gap_conductance: units.HeatTransfer | None = None
    partition: Annotated[float | Literal["effusivity"] | None, _PARTITION] = None
    initial_shape: UserFile | None = None
    tie: Switch = False

    @model_validator(mode="after")
    def _nothing_slides(self):
        for key in _OF_SLIDING if self.tie else ():
            if getattr(self, key) != type(self).model_fields[key].default:
                raise KeyFault(key, "not allowed together with tie")
        return self


class AssemblyHolderTable(Section):
    """Table ``holders.NAME``: a rigid holder with its loads, see `model.conditions.Holder`.

    Attributes
    ----------
    surface : tuple of str
        Surface, or list of surfaces of several bodies that move as one.
    direction : tuple of float or None
        Load direction, the motion ``"z"``, by default into the body in a stack, else downwards.
    point : tuple of float or None
        Point of application of the force, by default the pivot [m].
    pivot : tuple of float or None
        Centre of rotations, by default that of the geometry, else the origin [m].
    reaction : str or None
        Name of the holder that bears the force, as a caliper does that of its piston.
    moments : tuple of float or None
        Moments about x, y and z through the pivot; in a section the last one counts [N m].
    closing_moment : float or None
        Moment about the pivot, positive where it closes the contacts of the holder, for one that
        can only rotate in the section; instead of other loads [N m].
    """

    surface: Names
    free: tuple[FreeMotion, ...] = ("z",)
    direction: tuple[Number, ...] | None = None
    force: units.LeastForce | None = None
    approach: units.Length | None = None
    reaction: str | None = None
    tangential_force: units.SignedForce | None = None
    moments: tuple[units.SignedMoment, units.SignedMoment, units.SignedMoment] | None = None
    closing_moment: units.SignedMoment | None = None
    point: tuple[units.Coordinate, ...] | None = None
    pivot: tuple[units.Coordinate, ...] | None = None
    history: History | None = None

    @model_validator(mode="after")
    def _loads(self):
        if len(set(self.free)) != len(self.free):
            raise KeyFault("free", "names a motion twice")
        if self.force is not None and self.approach is not None:
            raise KeyFault("approach", "only one of force and approach can be given")
        if self.approach is not None and "z" not in self.free:
            raise KeyFault("approach", 'needs the motion "z" in free')
        loads = self.force, self.tangential_force, self.moments, self.history
        if self.closing_moment is not None:
            if self.free != ("rotation",):
                raise KeyFault("closing_moment", 'needs free = ["rotation"]')
            if any(load is not None for load in loads):
                raise KeyFault("closing_moment", "cannot be given together with other loads")
        moved = self.history is not None and self.history.loads.only_tangential
        if not self.free and any(load is not None for load in (loads[:-1] if moved else loads)):
            raise KeyFault("free", "is empty: a fixed holder takes no loads")
        if self.direction is not None and not any(self.direction):
            raise KeyFault("direction", "has no length")
        return self


class BodyMotionTable(Section):
    """Table ``motions.NAME``: motion of a body, see `scripting.holding`.

    Attributes
    ----------
    velocity : float or None
        Along x, of a plane model also across the section [m/s].
    angular_velocity : float or None
        About the axis of an axisymmetric model; in others about `center`, anticlockwise [rad/s].
    center : tuple of float
        x and y of the centre, or of the axis along z [m].
    axis : AxisTable or None
        Axis in space that the body turns about in place, instead of the centre.
    across : bool
        True if the velocity is normal to a plane section.
    amplitude, frequency : float or None
        Reciprocating motion ``x = amplitude sin(2 π frequency t)`` [m, Hz].
    history : FactorHistory or None
        Time-dependent factor of the speed.
    """

    velocity: units.Velocity | None = None
    angular_velocity: units.AngularVelocity | None = None
    amplitude: units.Length | None = None
    frequency: units.Frequency | None = None
    center: tuple[units.Coordinate, units.Coordinate] = (0.0, 0.0)
    axis: AxisTable | None = None
    across: Switch = False
    history: FactorHistory | None = None

    @model_validator(mode="after")
    def _one(self):
        if (self.amplitude is None) != (self.frequency is None):
            key = "amplitude" if self.amplitude is None else "frequency"
            raise KeyFault(key, "missing; a reciprocating motion has amplitude and frequency")
        given = self.velocity, self.angular_velocity, self.amplitude
        if sum(value is not None for value in given) != 1:
            raise KeyFault("velocity", "give either velocity or angular_velocity")
        if self.axis is not None and self.angular_velocity is None:
            raise KeyFault("axis", "needs angular_velocity")
        return self

    @property
    def mean_velocity(self) -> float | None:
        """Velocity along x; the mean speed of a reciprocating motion [m/s]."""
        if self.amplitude is None or self.frequency is None:
            return self.velocity
        return 4 * self.amplitude * self.frequency


class AssemblyBodyTable(BodyTable):
    """Table ``bodies.NAME``: material, and supports of a body without a holder.

    Attributes
    ----------
    fixed : tuple of str
        Surfaces that are clamped.
    symmetry : tuple of str
        Surfaces that cannot move along x.
    rollers : tuple of str
        Surfaces that cannot move along y.
    mid_plane : tuple of str
        Surfaces that cannot move along z, in space.
    """

    fixed: Names = ()
    symmetry: Names = ()
    rollers: Names = ()
    mid_plane: Names = ()

    @property
    def has_own(self) -> bool:
        return bool(self.model_fields_set - {"materials", *SUPPORTS})


class SurfaceLoadTable(Section):
    """Table ``load``: loads on surfaces, constant in time.

    Attributes
    ----------
    pressure : dict of str to float
        Pressures on surfaces, towards the bodies [Pa].
    """

    pressure: dict[str, units.Pressure] = Field(default={})

"""Rigid holder of a surface of a body, and motion of one body relative to the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, get_args

from ..case.tables.conditions import FreeMotion
from ..case.values import units
from ..case.values.units import in_python
from ..errors import CaseError
from ..laws.time_course import LoadHistory, TimeFunction
from ..model.conditions import Holder, Motion
from .body import BodySurface, require_surface
from .conversion import by_surface, each_quantity, quantities

_LOADS = {
    "force": units.Force,
    "approach": units.Length,
    "tangential_force": units.SignedForce,
    "closing_moment": units.SignedMoment,
}
_ON_SURFACES = {"surface_forces": units.Force, "surface_pressures": units.Pressure}


@dataclass(frozen=True, eq=False)
class SurfaceHolder:
    """Rigid holder of a surface, see `model.conditions.Holder`.

    It presses along -y in a section and along -z in space.

    Attributes
    ----------
    surface : BodySurface
    free : sequence of str
    force, approach, tangential_force, moments, closing_moment
        Quantities; the moments about x, y and z.
    pivot, point : tuple of float or None
        By default the origin, and the pivot [m].
    history : LoadHistory or None
    surface_forces, surface_pressures : mapping of BodySurface to quantity
    """

    surface: BodySurface
    free: Sequence[str] = ("z",)
    force: Any = None
    approach: Any = None
    tangential_force: Any = 0.0
    moments: tuple[Any, Any, Any] = (0.0, 0.0, 0.0)
    closing_moment: Any = None
    pivot: tuple[Any, ...] | None = None
    point: tuple[Any, ...] | None = None
    history: LoadHistory | None = None
    surface_forces: Mapping[BodySurface, Any] = field(default_factory=dict)
    surface_pressures: Mapping[BodySurface, Any] = field(default_factory=dict)

    def __post_init__(self):
        require_surface(self.surface, "Holder")
        for name in self.free:
            if name not in get_args(FreeMotion):
                known = ", ".join(get_args(FreeMotion))
                raise CaseError(f"Holder.free: found {name!r}; must be some of: {known}")
        loads = self._largest("force"), self._largest("approach"), self.closing_moment
        given = sum(load is not None for load in loads)
        if given > 1 or not (given or self.surface_forces or self.surface_pressures):
            raise CaseError("Holder: needs one of force, approach and closing_moment")

    def in_model(self, dim: int) -> Holder:
        """Holder of a model in two or three dimensions."""
        pivot = (0.0,) * dim if self.pivot is None else self._position(self.pivot, "pivot", dim)
        about_x, about_y, about_z = each_quantity(
            units.SignedMoment, self.moments, "Holder.moments"
        )
        loads = {"force": self._largest("force"), "approach": self._largest("approach")}
        loads |= {key: getattr(self, key) for key in ("tangential_force", "closing_moment")}
        on_surfaces: dict[str, Any] = {
            key: by_surface(kind, getattr(self, key), f"Holder.{key}")
            for key, kind in _ON_SURFACES.items()
        }
        return Holder(
            load_direction=(0.0,) * (dim - 1) + (-1.0,),
            pivot=pivot,
            point=pivot if self.point is None else self._position(self.point, "point", dim),
            free=tuple(self.free),
            moments=(about_x, about_y, about_z),
            history=self.history,
            **quantities("Holder", _LOADS, loads),
            **on_surfaces,
        )

    def _largest(self, name: str) -> Any:
        """Load of a history at its maximum, or the constant one."""
        given = None if self.history is None else getattr(self.history, name)
        return getattr(self, name) if given is None else max(given)

    def _position(self, given: tuple[Any, ...], name: str, dim: int) -> tuple[float, ...]:
        if len(given) != dim:
            raise CaseError(f"Holder.{name}: has {len(given)} coordinates; needs {dim}")
        return each_quantity(units.Coordinate, given, f"Holder.{name}")


@dataclass(frozen=True)
class Translation:
    """Sliding of a body along x.

    Attributes
    ----------
    velocity : float or quantity
        Positive towards +x [m/s].
    across : bool
        True if it slides normal to a plane section instead.
    history : TimeFunction or None
        Time-dependent factor of the velocity.
    """

    velocity: Any
    across: bool = False
    history: TimeFunction | None = None

    def relative(self, holds: bool, axisymmetric: bool) -> Motion:
        """Sliding of body 1 over body 2; `holds` is true for a motion of body 1."""
        velocity = in_python(units.Velocity, self.velocity, "Translation.velocity")
        return Motion(
            velocity=velocity if holds else -velocity,
            across=self.across,
            passes=not holds and not self.across and not axisymmetric,
            history=self.history,
        )


@dataclass(frozen=True)
class Rotation:
    """Rotation of a body about the axis of an axisymmetric model, or about a centre.

    Attributes
    ----------
    angular_velocity : float or quantity
        Positive anticlockwise [rad/s].
    center : tuple of float
        x and y of the centre, or of the axis along z, in other than axisymmetric models [m].
    history : TimeFunction or None
        Time-dependent factor of the angular velocity.
    """

    angular_velocity: Any
    center: tuple[Any, Any] = (0.0, 0.0)
    history: TimeFunction | None = None

    def relative(self, holds: bool, axisymmetric: bool) -> Motion:
        """Sliding of body 1 over body 2; `holds` is true for a motion of body 1."""
        ω = in_python(units.AngularVelocity, self.angular_velocity, "Rotation.angular_velocity")
        if axisymmetric:
            return Motion(angular_velocity=ω if holds else -ω, history=self.history)
        if holds:
            raise CaseError("Model.motions: a body on a holder cannot rotate about a centre")
        x, y = each_quantity(units.Coordinate, self.center, "Rotation.center")
        return Motion(angular_velocity=ω, center=(x, y), passes=True, history=self.history)

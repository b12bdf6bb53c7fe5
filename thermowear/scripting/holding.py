"""Rigid holders of surfaces of bodies, and motions of bodies relative to each other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, get_args

import numpy as np

from ..case.tables.conditions import FreeMotion
from ..case.values import units
from ..case.values.units import in_python
from ..errors import CaseError
from ..laws.histories import LoadHistory, TimeFunction
from ..laws.motions import axis_of
from ..model.conditions import Holder, Motion
from .body import BodySurface, MeshBody, require_surface
from .conversion import by_surface, each_quantity, quantities

_LOADS = {
    "force": units.LeastForce,
    "approach": units.Length,
    "tangential_force": units.SignedForce,
    "closing_moment": units.SignedMoment,
}


@dataclass(frozen=True, eq=False)
class SurfaceHolder:
    """Rigid holder of a surface, see `model.conditions.Holder`.

    Attributes
    ----------
    surface : BodySurface or sequence of BodySurface
        Surfaces of several bodies move as one.
    free : sequence of str
    force, approach, tangential_force, moments, closing_moment
        Quantities; the moments about x, y and z.
    pivot, point : tuple of float or None
        By default the origin, and the pivot [m].
    history : LoadHistory or None
    surface_forces, surface_pressures : mapping of BodySurface to quantity
    direction : sequence of float or None
        Direction along which it presses, the motion "z"; by default -y in a section, -z in space.
    name : str
        By default that of the first body.
    reaction : SurfaceHolder or str
        Holder that bears the force, or its name, as a caliper does that of its piston.
    """

    surface: BodySurface | Sequence[BodySurface]
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
    direction: Sequence[float] | None = None
    name: str = ""
    reaction: SurfaceHolder | str = ""

    def __post_init__(self):
        for surface in self.surfaces:
            require_surface(surface, "Holder")
        for name in self.free:
            if name not in get_args(FreeMotion):
                known = ", ".join(get_args(FreeMotion))
                raise CaseError(f"Holder.free: found {name!r}; must be some of: {known}")
        loads = self._largest("force"), self._largest("approach"), self.closing_moment
        given = sum(load is not None for load in loads)
        if given > 1:
            raise CaseError("Holder: needs one of force, approach and closing_moment")

    @property
    def surfaces(self) -> tuple[BodySurface, ...]:
        """Surfaces that it holds."""
        given = self.surface
        return tuple(given) if isinstance(given, Sequence) else (given,)

    @property
    def own_name(self) -> str:
        """Name for results and references, by default that of the first body."""
        return self.name or self.surfaces[0].body.name

    @property
    def pressed(self) -> bool:
        """True if it is loaded."""
        loads = self._largest("force"), self._largest("approach"), self.closing_moment
        loaded = any(load is not None for load in loads)
        return loaded or bool(self.surface_forces or self.surface_pressures)

    def in_model(self, dim: int, bodies: Sequence[MeshBody]) -> Holder:
        """Holder of a model in two or three dimensions.

        Parameters
        ----------
        dim : int
        bodies : sequence of MeshBody
            Bodies of the model.
        """
        direction = (0.0,) * (dim - 1) + (-1.0,)
        if self.direction is not None:
            given = np.asarray(self.direction, dtype=float)
            if given.shape != (dim,) or not np.linalg.norm(given) > 0.0:
                raise CaseError(f"Holder.direction: needs {dim} components, not all of them zero")
            direction = tuple(map(float, given / np.linalg.norm(given)))
        pivot = (0.0,) * dim if self.pivot is None else self._position(self.pivot, "pivot", dim)
        about_x, about_y, about_z = each_quantity(
            units.SignedMoment, self.moments, "Holder.moments"
        )
        bearing = self.reaction
        loads = {"force": self._largest("force"), "approach": self._largest("approach")}
        loads |= {key: getattr(self, key) for key in ("tangential_force", "closing_moment")}
        return Holder(
            load_direction=direction,
            bodies=tuple(bodies.index(surface.body) for surface in self.surfaces),
            name=self.own_name,
            reaction=bearing if isinstance(bearing, str) else bearing.own_name,
            pivot=pivot,
            point=pivot if self.point is None else self._position(self.point, "point", dim),
            free=tuple(self.free),
            moments=(about_x, about_y, about_z),
            history=self.history,
            **quantities("Holder", _LOADS, loads),
            surface_forces=by_surface(units.Force, self.surface_forces, "Holder.surface_forces"),
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

    def in_model(self) -> Motion:
        """Motion of the body in the frame of the model."""
        velocity = in_python(units.Velocity, self.velocity, "Translation.velocity")
        return Motion(velocity=velocity, across=self.across, history=self.history)


@dataclass(frozen=True)
class Rotation:
    """Rotation of a body about the axis of an axisymmetric model, a centre, or an axis in space.

    Attributes
    ----------
    angular_velocity : float or quantity
        Positive anticlockwise [rad/s].
    center : tuple of float
        x and y of the centre, or of the axis along z, in other than axisymmetric models; with
        `axis` the coordinates of a point of it [m].
    axis : tuple of float or None
        Direction of an axis in space that the body turns about in place, by the right-hand rule.
    history : TimeFunction or None
        Time-dependent factor of the angular velocity.
    """

    angular_velocity: Any
    center: tuple[Any, ...] = (0.0, 0.0)
    axis: tuple[float, float, float] | None = None
    history: TimeFunction | None = None

    def in_model(self) -> Motion:
        """Motion of the body in the frame of the model.

        Raises
        ------
        CaseError
            If the centre has another number of coordinates, or the axis no direction.
        """
        ω = in_python(units.AngularVelocity, self.angular_velocity, "Rotation.angular_velocity")
        needed = 2 if self.axis is None else 3
        if len(self.center) != needed:
            raise CaseError(f"Rotation.center: has {len(self.center)} coordinates; needs {needed}")
        if self.axis is not None:
            point = tuple(each_quantity(units.Coordinate, self.center, "Rotation.center"))
            try:
                axis = axis_of(point, self.axis)
            except ValueError as error:
                raise CaseError(f"Rotation.axis: {error}") from None
            return Motion(angular_velocity=ω, axis=axis, history=self.history)
        x, y = each_quantity(units.Coordinate, self.center, "Rotation.center")
        return Motion(angular_velocity=ω, center=(x, y), history=self.history)

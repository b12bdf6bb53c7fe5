"""Rigid holder of a surface of a body."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, get_args

from ..case.tables.conditions import FreeMotion
from ..case.values import units
from ..case.values.units import in_python
from ..errors import CaseError
from ..laws.load_history import LoadHistory
from ..model.holder import Holder
from .body import BodySurface, require_surface
from .conversion import optional
from .physics import by_surface


@dataclass(frozen=True, eq=False)
class SurfaceHolder:
    """Rigid holder of a surface, see `model.holder.Holder`.

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
        point = pivot if self.point is None else self._position(self.point, "point", dim)
        force, approach = self._largest("force"), self._largest("approach")
        about_x, about_y, about_z = (
            in_python(units.SignedMoment, moment, "Holder.moments") for moment in self.moments
        )
        return Holder(
            load_direction=(0.0,) * (dim - 1) + (-1.0,),
            pivot=pivot,
            point=point,
            free=tuple(self.free),
            force=optional(units.Force, force, "Holder.force"),
            approach=optional(units.Length, approach, "Holder.approach"),
            tangential_force=in_python(
                units.SignedForce, self.tangential_force, "Holder.tangential_force"
            ),
            moments=(about_x, about_y, about_z),
            closing_moment=optional(
                units.SignedMoment, self.closing_moment, "Holder.closing_moment"
            ),
            history=self.history,
            surface_forces=by_surface(units.Force, self.surface_forces, "Holder.surface_forces"),
            surface_pressures=by_surface(
                units.Pressure, self.surface_pressures, "Holder.surface_pressures"
            ),
        )

    def _largest(self, name: str) -> Any:
        """Load of a history at its maximum, or the constant one."""
        given = None if self.history is None else getattr(self.history, name)
        return getattr(self, name) if given is None else max(given)

    def _position(self, given: tuple[Any, ...], name: str, dim: int) -> tuple[float, ...]:
        if len(given) != dim:
            raise CaseError(f"Holder.{name}: has {len(given)} coordinates; needs {dim}")
        return tuple(in_python(units.Coordinate, x, f"Holder.{name}") for x in given)

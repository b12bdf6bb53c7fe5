"""Motion of one body, in place of the relative sliding velocity of a model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..case.values import units
from ..case.values.units import in_python
from ..errors import CaseError
from ..laws.time_course import TimeFunction
from ..model.motion import Motion


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
        x, y = (in_python(units.Coordinate, value, "Rotation.center") for value in self.center)
        return Motion(angular_velocity=ω, center=(x, y), passes=True, history=self.history)

"""Relative sliding motion of the bodies."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..laws.time_course import TimeFunction


@dataclass(frozen=True)
class Motion:
    """Sliding of body 1 over body 2; at rest without a velocity.

    Attributes
    ----------
    velocity : float or None
        Velocity of body 1 relative to body 2 along x, or across a section [m/s].
    angular_velocity : float or None
        Rotation of body 1 about the axis of an axisymmetric model; of body 2 about the centre,
        anticlockwise, in other models [rad/s].
    center : tuple of float or None
        Centre of rotation of body 2 in the section; None: it moves along x [m].
    across : bool
        True if body 1 slides normal to a plane section instead of along x.
    passes : bool
        True if body 2 passes under body 1 in the model, as a strip, a disk or a drum does.
    history : TimeFunction or None
        Time-dependent factor of the speed.
    """

    velocity: float | None = None
    angular_velocity: float | None = None
    center: tuple[float, float] | None = None
    across: bool = False
    passes: bool = False
    history: TimeFunction | None = None

    @property
    def at_rest(self) -> bool:
        """True without a velocity."""
        return self.velocity is None and self.angular_velocity is None

    def faster(self, factor: float) -> Motion:
        """Motion at another speed."""
        v, ω = (None if x is None else factor * x for x in (self.velocity, self.angular_velocity))
        return replace(self, velocity=v, angular_velocity=ω)

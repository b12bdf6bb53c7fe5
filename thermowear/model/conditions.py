"""Operating conditions: rigid holders with their loads, sliding motion, heat."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from ..laws.histories import LoadHistory, TimeFunction
from ..laws.motions import TurningAxis, spans


@dataclass(frozen=True)
class Holder:
    """Rigid holder of bodies: its free motions, and the loads or given motions along them.

    Attributes
    ----------
    bodies : tuple of int
        Indices of the bodies in the model that it moves.
    name : str
        Name for results and messages; empty for the holder of a pair.
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
    reaction : str
        Name of another holder that bears the force, as a caliper bears that of its piston: the
        opposite force acts on it at the same point. Empty: the surroundings bear it.
    surface_forces : mapping of str to float
        Forces along the load direction, distributed evenly over surfaces of body 1 [N].
    hanging : bool
        True for bodies without a holder whose contacts alone keep them from these motions: no
        surface is held.
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
    bodies: tuple[int, ...] = (0,)
    name: str = ""
    reaction: str = ""
    hanging: bool = False

    @property
    def pressing_force(self) -> np.ndarray:
        """Force along the load direction, shape (gdim,) [N]."""
        return (self.force or 0.0) * np.array(self.load_direction)

    def admits(self, force: np.ndarray) -> bool:
        """True if its free translations follow a force in any direction of (gdim,) components."""
        along = [self.load_direction] if "z" in self.free and self.approach is None else []
        across = [np.eye(len(force))["xy".index(name)] for name in self.free if name in ("x", "y")]
        return spans([*along, *across], force)


@dataclass(frozen=True)
class Motion:
    """Sliding of body 1 over body 2; at rest without a velocity.

    Attributes
    ----------
    velocity : float or None
        Velocity of body 1 relative to body 2 along x, or across a section [m/s].
    angular_velocity : float or None
        Rotation of body 1 about the axis of an axisymmetric model or the given one; else of body 2
        about the centre, anticlockwise [rad/s].
    center : tuple of float or None
        Centre of rotation of body 2 in the section; None: it moves along x [m].
    axis : TurningAxis or None
        Axis in space that body 1 turns about in place, over body 2 at rest.
    across : bool
        True if body 1 slides normal to a plane section instead of along x.
    passes : bool
        True if the moving body passes the other one in the model, as a strip or a drum does.
    moving_side : int
        Side of the interface of that body: 0 if it is body 1.
    history : TimeFunction or None
        Time-dependent factor of the speed.
    """

    velocity: float | None = None
    angular_velocity: float | None = None
    center: tuple[float, float] | None = None
    axis: TurningAxis | None = None
    across: bool = False
    passes: bool = False
    moving_side: int = 1
    history: TimeFunction | None = None

    @property
    def at_rest(self) -> bool:
        """True without a velocity."""
        return self.velocity is None and self.angular_velocity is None

    def faster(self, factor: float) -> Motion:
        """Motion at another speed."""
        v, ω = (None if x is None else factor * x for x in (self.velocity, self.angular_velocity))
        return replace(self, velocity=v, angular_velocity=ω)


@dataclass(frozen=True)
class Heat:
    """Heat sources and thermal boundary conditions; surfaces not named are insulated.

    Attributes
    ----------
    ambient : float
        Temperature of the surroundings and of the stress-free state [K].
    ambient_history : TimeFunction or None
        Time-dependent temperature of the surroundings [K].
    initial : float or None
        Initial temperature of the bodies, by default the ambient one [K].
    transient : bool
        Temperatures in time, instead of the steady ones of the present friction heat.
    advection : str
        Heat transport by a body 2 that passes under body 1: ``"none"``, conduction as at rest;
        ``"resolved"``, advection with the motion; ``"spread"``, the limit of fast motion.
    cooling : mapping of str to float
        Heat transfer coefficients of surfaces [W/(m² K)].
    temperature : mapping of str to (float or TimeFunction)
        Prescribed temperatures of surfaces [K].
    flux : mapping of str to float
        Heat flux into the body through surfaces [W/m²].
    power : mapping of str to float
        Total heat into surfaces, distributed evenly [W].
    """

    ambient: float = 293.15
    ambient_history: TimeFunction | None = None
    initial: float | None = None
    transient: bool = False
    advection: Literal["none", "resolved", "spread"] = "none"
    cooling: Mapping[str, float] = field(default_factory=dict)
    temperature: Mapping[str, float | TimeFunction] = field(default_factory=dict)
    flux: Mapping[str, float] = field(default_factory=dict)
    power: Mapping[str, float] = field(default_factory=dict)

    @property
    def histories(self) -> list[TimeFunction]:
        """Functions of time of the boundary conditions."""
        given = (*self.temperature.values(), self.ambient_history)
        return [value for value in given if isinstance(value, TimeFunction)]

    @property
    def driven(self) -> bool:
        """True if the bodies are heated or cooled by anything besides friction."""
        given = [*self.temperature.values(), self.ambient if self.initial is None else self.initial]
        return bool(self.flux or self.power or self.ambient_history) or any(
            value != self.ambient for value in given
        )

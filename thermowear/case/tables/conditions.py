"""Operating conditions: holder of body 1 and loads on it, sliding motion, heat."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import PlainSerializer, PlainValidator, TypeAdapter, ValidationInfo, model_validator

from ...laws.motions import TurningAxis, axis_of
from ..values import units
from ..values.json_schema import AnyOf, quantity_text
from ..values.section import KeyFault, Number, Section, Switch, number_or
from .laws import Conductance
from .tabulated import FactorHistory, History, TemperatureHistory, TimeHistory

FreeMotion = Literal["x", "y", "z", "rotation", "rotation-x", "rotation-y"]


class HolderTable(Section):
    """Rigid holder of body 1, see `model.conditions.Holder`.

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

    Keys without a note are those of `model.conditions.Holder`. Exactly one of force, mean pressure
    and approach; a holder that can only rotate may have a moment instead, and a fixed one needs
    forces or pressures on surfaces. Pressures on surfaces may also act alone.

    Attributes
    ----------
    mean_pressure : float or None
        Mean over the nominal contact area [Pa].
    force : float or None
        Normal force along the load direction, on the whole ring or on the thickness [N].
    lever : float or None
        Distance along x from the pivot to the line of action of the force [m].
    point : tuple of float or None
        Point of application of the force: x, or x and y in space, by default at the pivot [m].
    moment : float or None
        Additional moment about the pivot [N m]: positive where it closes the contact if the holder
        can only rotate, anticlockwise otherwise.
    moments : tuple of float or None
        Moments about x and y through the pivot, in space, by the right-hand rule [N m].
    surfaces : dict of str to float
        Forces along the load direction on surfaces of a body with a fixed holder [N].
    pressure : dict of str to float
        Pressures on surfaces, in addition to all other loads. Their resultant along a free motion
        of the holder enters its equilibrium with the contact [Pa].
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


_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


class AxisTable(Section):
    """Axis in space that a body turns about, by the right-hand rule.

    Attributes
    ----------
    point : tuple of float
        A point of it [m].
    direction : str or tuple of float
        An axis of coordinates, or a vector of any length.
    """

    point: tuple[units.Coordinate, units.Coordinate, units.Coordinate]
    direction: Literal["x", "y", "z"] | tuple[Number, Number, Number]

    @model_validator(mode="after")
    def _has_direction(self):
        try:
            self.axis  # noqa: B018
        except ValueError as error:
            raise KeyFault("direction", str(error)) from None
        return self

    @property
    def axis(self) -> TurningAxis:
        given = self.direction
        return axis_of(self.point, _AXES[given] if isinstance(given, str) else given)


class MotionTable(Section):
    """Sliding motion, see `model.conditions.Motion`.

    Attributes
    ----------
    axis : AxisTable or None
        Axis in space that body 1 turns about in place, as a ball in its socket.
    amplitude, frequency : float or None
        Reciprocating motion of body 1, ``x = amplitude sin(2 π frequency t)`` [m, Hz].
    """

    angular_velocity: units.AngularVelocity | None = None
    velocity: units.Velocity | None = None
    axis: AxisTable | None = None
    amplitude: units.Length | None = None
    frequency: units.Frequency | None = None
    history: FactorHistory | None = None


_PARTITION = number_or(
    "effusivity",
    where=lambda share: 0 <= share <= 1,
    allowed='at least 0 and at most 1, or "effusivity"',
)
_CONSTANT = TypeAdapter(units.Temperature)


def _parse_temperature(data: Any, info: ValidationInfo) -> Any:
    """Convert a quantity to a constant, a table or the name of a CSV file to a history."""
    in_a_file = isinstance(data, str) and data.strip().lower().endswith(".csv")
    if in_a_file or isinstance(data, dict | TemperatureHistory):
        return TemperatureHistory.model_validate(data, context=info.context)
    return _CONSTANT.validate_python(data)


def _serialise_temperature(value: Any) -> Any:
    return value.model_dump() if isinstance(value, Section) else _CONSTANT.dump_python(value)


GivenTemperature = Annotated[
    float | TemperatureHistory,
    PlainValidator(_parse_temperature),
    PlainSerializer(_serialise_temperature),
    AnyOf(quantity_text("K", "20 degC", ge=0.0), TemperatureHistory),
]
"""Constant [K], or history of a temperature."""


class HeatTable(Section):
    """Heat sources, thermal boundary conditions and thermal properties of the interface.

    Friction heats the faces while the bodies slide; bodies in contact conduct also at rest. Keys
    are those of `model.conditions.Heat`; `conductance`, `gap_conductance` and `partition` are those
    of `model.interface.Interface`.
    """

    conductance: Conductance | None = None
    gap_conductance: units.HeatTransfer | None = None
    partition: Annotated[float | Literal["effusivity"], _PARTITION] = 0.5
    advection: Literal["none", "resolved", "spread"] = "none"
    transient: Switch = False
    initial: units.Temperature | None = None
    ambient: units.Temperature = 293.15
    ambient_history: TemperatureHistory | None = None
    cooling: dict[str, units.HeatTransfer] = {}
    temperature: dict[str, GivenTemperature] = {}
    flux: dict[str, units.HeatFlux] = {}
    power: dict[str, units.Power] = {}

    @property
    def histories(self) -> Mapping[str, TimeHistory]:
        """Time histories by key."""
        found = {
            f"temperature.{surface}": value
            for surface, value in self.temperature.items()
            if isinstance(value, TemperatureHistory)
        }
        if self.ambient_history is not None:
            found["ambient_history"] = self.ambient_history
        return found

    @property
    def driven(self) -> bool:
        """True if the bodies are heated or cooled by anything besides friction."""
        given = [*self.temperature.values(), self.ambient if self.initial is None else self.initial]
        return bool(self.flux or self.power or self.ambient_history) or any(
            value != self.ambient for value in given
        )

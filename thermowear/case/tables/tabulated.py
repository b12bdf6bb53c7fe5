"""Tabulated functions: time histories, and factors by temperature, pressure or speed."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, ClassVar, Generic, TypeVar

from pydantic import Field, TypeAdapter, ValidationError, ValidationInfo, model_validator

from ...laws.histories import TANGENTIAL, LoadHistory, TimeFunction
from ...laws.interfaces import Multipliers, Table1D
from ..values import units
from ..values.csv_columns import Columns, read_columns
from ..values.section import KeyFault, Number, Section, Switch, UserFile

_PATH = TypeAdapter(UserFile)
_CLOSED = 1e-9
"""Largest difference between start and end of a closed cycle, relative to the largest value."""
_VARIABLES = {"temperature": "T", "pressure": "p", "speed": "v"}
Positive = Annotated[Number, Field(gt=0.0)]
NotNegative = Annotated[Number, Field(ge=0.0)]
At = TypeVar("At", bound=float)
Factor = TypeVar("Factor", bound=float)


def must_increase(key: str, values: tuple[float, ...]) -> None:
    """Reject a list that is empty or not strictly increasing."""
    if not values:
        raise KeyFault(key, "is empty; needs at least one value")
    if any(b <= a for a, b in pairwise(values)):
        raise KeyFault(key, "must increase")


def must_match(key: str, values: tuple[float, ...], places: tuple[float, ...], what: str) -> None:
    """Reject a list whose length differs from that of another list."""
    if len(values) != len(places):
        raise KeyFault(key, f"has {len(values)} values for {len(places)} {what}")


class MultiplierTable(Section, Generic[At, Factor]):
    """Piecewise linear factor of one variable, constant beyond the ends.

    Attributes
    ----------
    at : tuple of float
        Places of the values, increasing, in SI.
    factor : tuple of float
        Values of the factor at these places.
    """

    at: tuple[At, ...]
    factor: tuple[Factor, ...]

    @model_validator(mode="after")
    def _fits(self):
        must_increase("at", self.at)
        must_match("factor", self.factor, self.at, "places")
        return self

    @property
    def table(self) -> Table1D:
        """Factor as a piecewise linear function."""
        return Table1D(self.at, self.factor)


class TemperatureTable(MultiplierTable[units.Temperature, Positive]):
    """Factor that depends on the temperature [K]."""


class ExpansionTable(MultiplierTable[units.Temperature, NotNegative]):
    """Factor of the secant coefficient of expansion, which may be 0."""


class PressureTable(MultiplierTable[units.LeastPressure, Positive]):
    """Factor that depends on the pressure [Pa]."""


class SpeedTable(MultiplierTable[units.Speed, Positive]):
    """Factor that depends on the sliding speed [m/s]."""


class MultiplierTables(Section):
    """Product of tabulated factors.

    Attributes
    ----------
    temperature : TemperatureTable or None
        Factor by the temperature of the face.
    pressure : PressureTable or None
        Factor by the contact pressure.
    speed : SpeedTable or None
        Factor by the sliding speed.
    """

    temperature: TemperatureTable | None = None
    pressure: PressureTable | None = None
    speed: SpeedTable | None = None

    @property
    def depends_on(self) -> tuple[str, ...]:
        """Variables with a table: temperature, pressure, speed."""
        return tuple(name for name, table in self if table is not None)

    @property
    def multipliers(self) -> Multipliers:
        """Factors as a law."""
        return Multipliers({_VARIABLES[key]: getattr(self, key).table for key in self.depends_on})


class TimeHistory(Section):
    """Base of time histories: piecewise linear between instants, constant before and after.

    A table of lists, or a CSV file with a column for each list: the name of the file instead of the
    table, or as key ``file`` of the table, together with keys that are no lists.

    Attributes
    ----------
    time : tuple of float
        Instants, increasing [s].
    repeat : bool
        Periodic continuation after the last instant.
    """

    COLUMNS: ClassVar[dict[str, str]]
    """Columns of a CSV file, with a suitable unit for each; empty for plain numbers."""
    ALTERNATIVES: ClassVar[tuple[tuple[str, str], ...]] = ()
    """Pairs of columns of which only one can be given."""

    time: tuple[units.Instant, ...]
    repeat: Switch = False

    @model_validator(mode="wrap")
    @classmethod
    def _from_file(cls, data: Any, handler, info: ValidationInfo):
        data = {"file": data} if isinstance(data, str) else data
        if not isinstance(data, dict) or "file" not in data:
            return handler(data)
        name, others = data["file"], {key: data[key] for key in data if key != "file"}
        if not isinstance(name, str):
            raise KeyFault("file", "must be the name of a CSV file")
        path = _PATH.validate_python(name, context=info.context)
        columns = read_columns(Path(path), cls.COLUMNS)
        for key in columns.values:
            if key in others:
                raise KeyFault(key, f"is a column of {columns.name} already")
        try:
            return handler(others | columns.values)
        except ValidationError as error:
            _report_line(error, columns)
            raise

    @classmethod
    def __get_pydantic_json_schema__(cls, schema, handler):
        """A table with a file in place of lists is allowed, and its name alone."""
        table = dict(handler.resolve_ref_schema(handler(schema)))
        table.pop("required", None)
        name = {"type": "string", "examples": ["history.csv"]}
        what = {"description": "CSV file with a column for each list, in place of the lists."}
        table["properties"] = table["properties"] | {"file": name | what}
        return {"anyOf": [name, table]}

    @model_validator(mode="after")
    def _lists(self):
        must_increase("time", self.time)
        if self.repeat and len(self.time) < 2:
            raise KeyFault("repeat", "needs at least two instants in time")
        for first, second in self.ALTERNATIVES:
            if getattr(self, first) is not None and getattr(self, second) is not None:
                raise KeyFault(second, f"only one of {first} and {second} can be given")
        for key in self.COLUMNS:
            values = getattr(self, key)
            if key == "time" or values is None:
                continue
            must_match(key, values, self.time, "times")
            if self.repeat and abs(values[-1] - values[0]) > _CLOSED * max(map(abs, values)):
                raise KeyFault("repeat", f"the last value of {key} must equal the first one")
        return self


def _report_line(error: ValidationError, columns: Columns) -> None:
    """Report an invalid value of a file with its line; leave other faults to the table."""
    for fault in error.errors(include_url=False):
        place = fault["loc"]
        if len(place) == 2 and place[0] in columns.values and isinstance(place[1], int):
            message = fault.get("ctx", {}).get("error", fault["msg"])
            message = str(message).replace("Input should be", "must be")
            line = columns.lines[place[1]]
            raise ValueError(f"{columns.name}, line {line}: {place[0]}: {message}") from None


class FactorHistory(TimeHistory):
    """Time-dependent factor of the speed or of the friction.

    Attributes
    ----------
    factor : tuple of float
        Factors, at least one of them greater than 0.
    """

    COLUMNS = {"time": "s", "factor": ""}

    factor: tuple[NotNegative, ...]

    @model_validator(mode="after")
    def _fits(self):
        if not any(self.factor):
            raise KeyFault("factor", "at least one value must be greater than 0")
        return self

    @property
    def function(self) -> TimeFunction:
        """Factor as a function of time."""
        return TimeFunction(self.time, self.repeat, self.factor)


class TemperatureHistory(TimeHistory):
    """Temperature of a surface, or ambient temperature.

    Attributes
    ----------
    temperature : tuple of float
        Temperatures at the instants [K].
    """

    COLUMNS = {"time": "s", "temperature": "degC"}

    temperature: tuple[units.Temperature, ...]

    @property
    def function(self) -> TimeFunction:
        """Temperature [K] as a function of time."""
        return TimeFunction(self.time, self.repeat, self.temperature)


class History(TimeHistory):
    """Loads of the holder of body 1 at instants, see `laws.histories.LoadHistory`."""

    COLUMNS = {
        "time": "s",
        "force": "kN",
        "approach": "um",
        "tangential_force": "N",
        "tangential_displacement": "um",
        "moment": "N m",
        "tangential_force_y": "N",
        "tangential_displacement_y": "um",
        "torque": "N m",
        "twist": "mrad",
    }
    ALTERNATIVES = ("force", "approach"), *TANGENTIAL

    force: tuple[units.LeastForce, ...] | None = None
    approach: tuple[units.Length, ...] | None = None
    tangential_force: tuple[units.SignedForce, ...] | None = None
    tangential_displacement: tuple[units.Displacement, ...] | None = None
    moment: tuple[units.SignedMoment, ...] | None = None
    tangential_force_y: tuple[units.SignedForce, ...] | None = None
    tangential_displacement_y: tuple[units.Displacement, ...] | None = None
    torque: tuple[units.SignedMoment, ...] | None = None
    twist: tuple[units.Twist, ...] | None = None
    cycle_start: units.Instant | None = None

    @model_validator(mode="after")
    def _fits(self):
        if self.force is not None and not any(self.force):
            raise KeyFault("force", "at least one value must be greater than 0 N")
        start = self.cycle_start
        if start is not None:
            if not self.time[0] <= start < self.time[-1]:
                raise KeyFault(
                    "cycle_start",
                    f"found {start:g} s; must be at least {self.time[0]:g} s and less than "
                    f"{self.time[-1]:g} s, the ends of time",
                )
            if not self.loads.ends_as(start):
                raise KeyFault("cycle_start", "the loads at both ends of the cycle must be equal")
        return self

    @property
    def loads(self) -> LoadHistory:
        """Loads as functions of time."""
        return LoadHistory(**dict(self))

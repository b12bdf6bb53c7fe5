"""Histories: piecewise linear functions of time."""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar

from pydantic import TypeAdapter, ValidationError, ValidationInfo, model_validator

from ...laws.load_history import KEYS, LoadHistory
from ...laws.time_course import TimeCourse, TimeFunction
from ..values import units
from ..values.csv_columns import Columns, read_columns
from ..values.paths import UserFile
from ..values.section import KeyFault, Section, Switch
from .multipliers import NotNegative, must_increase, must_match

_PATH = TypeAdapter(UserFile)
_CLOSED = 1e-9  # of the largest value: a cycle that ends so near to its begin is closed


class TimeHistory(Section):
    """Base of what is given at instants: straight lines between them, constant before and after.

    A table of lists, or a CSV file with a column for each of them: the name of the file instead of
    the table, or ``file`` in the table beside keys that are no lists.

    Attributes
    ----------
    time : tuple of float
        Increasing [s].
    repeat : bool
        From the last instant on it goes on as from the first one, again and again.
    """

    COLUMNS: ClassVar[dict[str, str]]
    """Lists that a CSV file may hold, with a unit that fits each; empty for plain numbers."""

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
            _charge(error, columns)
            raise

    @model_validator(mode="after")
    def _in_order(self):
        must_increase("time", self.time)
        if self.repeat and len(self.time) < 2:
            raise KeyFault("repeat", "needs at least two instants in time")
        return self

    def _closes(self, key: str, values: tuple[float, ...]) -> None:
        """Refuse repetitions of values that jump from the end back to the begin."""
        if self.repeat and abs(values[-1] - values[0]) > _CLOSED * max(map(abs, values)):
            raise KeyFault("repeat", f"{key} must end with the value that it begins with")

    @property
    def course(self) -> TimeCourse:
        """The instants."""
        return TimeCourse(self.time, self.repeat)


def _charge(error: ValidationError, columns: Columns) -> None:
    """Refuse a value of a file with its line; other faults are those of the table."""
    for fault in error.errors(include_url=False):
        place = fault["loc"]
        if len(place) == 2 and place[0] in columns.values and isinstance(place[1], int):
            said = fault.get("ctx", {}).get("error", fault["msg"])
            said = str(said).replace("Input should be", "must be")
            line = columns.lines[place[1]]
            raise ValueError(f"{columns.name}, line {line}: {place[0]}: {said}") from None


class FactorHistory(TimeHistory):
    """Time-dependent factor of the speed or of the friction.

    Attributes
    ----------
    factor : tuple of float
        One of them at least greater than 0.
    """

    COLUMNS = {"time": "s", "factor": ""}

    factor: tuple[NotNegative, ...]

    @model_validator(mode="after")
    def _fits(self):
        must_match("factor", self.factor, self.time, "times")
        if not any(self.factor):
            raise KeyFault("factor", "one at least must be greater than 0")
        self._closes("factor", self.factor)
        return self

    @property
    def function(self) -> TimeFunction:
        """The factor as a function of time."""
        return TimeFunction(self.course, self.factor)


class TemperatureHistory(TimeHistory):
    """Temperature of a surface, or of the surroundings.

    Attributes
    ----------
    temperature : tuple of float
        [K]
    """

    COLUMNS = {"time": "s", "temperature": "degC"}

    temperature: tuple[units.Temperature, ...]

    @model_validator(mode="after")
    def _fits(self):
        must_match("temperature", self.temperature, self.time, "times")
        self._closes("temperature", self.temperature)
        return self

    @property
    def function(self) -> TimeFunction:
        """The temperature [K] as a function of time."""
        return TimeFunction(self.course, self.temperature)


class History(TimeHistory):
    """Loads of the holder of body 1 at instants, see `laws.load_history.LoadHistory`."""

    COLUMNS = {
        "time": "s",
        "force": "kN",
        "approach": "um",
        "tangential_force": "N",
        "tangential_displacement": "um",
    }

    force: tuple[units.LeastForce, ...] | None = None
    approach: tuple[units.Length, ...] | None = None
    tangential_force: tuple[units.SignedForce, ...] | None = None
    tangential_displacement: tuple[units.Displacement, ...] | None = None
    cycle_start: units.Instant | None = None

    @model_validator(mode="after")
    def _fits(self):
        pairs = ("force", "approach"), ("tangential_force", "tangential_displacement")
        for first, second in pairs:
            if getattr(self, first) is not None and getattr(self, second) is not None:
                raise KeyFault(second, f"only one of {first} and {second} can be given")
        for key in (key for pair in pairs for key in pair):
            values = getattr(self, key)
            if values is not None:
                must_match(key, values, self.time, "times")
                self._closes(key, values)
        if self.force is not None and not any(self.force):
            raise KeyFault("force", "one at least must be greater than 0 N")
        start = self.cycle_start
        if start is not None:
            if not self.time[0] <= start < self.time[-1]:
                raise KeyFault(
                    "cycle_start",
                    f"found {start:g} s; must be at least {self.time[0]:g} s and less than "
                    f"{self.time[-1]:g} s, the ends of time",
                )
            if not self.loads.ends_as(start):
                raise KeyFault("cycle_start", "a cycle must end with the loads that it begins with")
        return self

    @property
    def loads(self) -> LoadHistory:
        """The loads as functions of time."""
        values = {key: getattr(self, key) for key in KEYS}
        return LoadHistory(self.course, **values, cycle_start=self.cycle_start)

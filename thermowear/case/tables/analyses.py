"""The analyses a case can ask for."""

from __future__ import annotations

from collections import Counter
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from ...errors import quoted
from ..values import units
from ..values.section import KeyFault, Number, Section


class Initial(Section):
    """Contact of the unworn faces."""

    type: Literal["initial"]


class Steady(Section):
    """Steady state of wear, directly."""

    type: Literal["steady"]


_MINUTES = 120.0  # s; a state takes milliseconds to write
Frames = Annotated[int, Field(ge=0, le=1000, strict=True)]


def _all_different(output_times: tuple[float, ...]) -> None:
    """Refuse times that would share a file."""
    counts = Counter(f"{t:g}" for t in output_times)
    twice = [name for name, count in counts.items() if count > 1]
    if twice:
        raise KeyFault("output_times", f"{twice[0]} s is there twice (to six digits)")


class Timed(Section):
    """Base of analyses that follow wear in time by steps of their own choice.

    Attributes
    ----------
    end_time : float or None
        [s]
    until : str or None
        ``"steady"``: stop when the steady state is reached within `steady_tolerance`.
    output_times : tuple of float
        Times that get an interface file of their own [s].
    tolerance : float
        Allowed error of one step, relative to the largest pressure and to the largest depth worn.
    frames : int
        How many states on the way are kept for an animation, at most.
    checkpoint_every : float
        Time of computing after which the run is saved again, besides at output times [s].
    """

    type: str
    end_time: units.Time | None = None
    until: Literal["steady"] | None = None
    steady_tolerance: Annotated[Number, Field(gt=0.0, lt=1.0)] = 1e-3
    output_times: tuple[units.Time, ...] = ()
    tolerance: Annotated[Number, Field(ge=1e-9, le=0.1)] = 1e-4
    max_steps: Annotated[int, Field(ge=1, strict=True)] = 10_000
    frames: Frames = 0
    checkpoint_every: units.Time = _MINUTES

    @model_validator(mode="after")
    def _outputs(self):
        _all_different(self.output_times)
        if self.end_time is not None:
            late = [t for t in self.output_times if t > self.end_time]
            if late:
                raise KeyFault(
                    "output_times", f"{late[0]:g} s lies after end_time {self.end_time:g} s"
                )
        return self


class Transient(Timed):
    """Running-in; steady is the pressure within `steady_tolerance` of the largest steady one."""

    type: Literal["transient"]

    @model_validator(mode="after")
    def _ends(self):
        if self.end_time is None and self.until is None:
            raise KeyFault("end_time", 'missing; needs end_time = "…" or until = "steady"')
        return self


class Reciprocating(Timed):
    """Wear of a body 1 that slides to and fro, and of what it rubs along, averaged over cycles.

    Steady are wear rates that differ from their mean along each of the worn faces, but for its
    ends, by less than `steady_tolerance` of it.

    Attributes
    ----------
    cycles : float or None
        How many of them, instead of an end time; ``wear.cycles`` says the same.
    positions : int
        Places of body 1 in which contact is solved, between the ends of the stroke.
    """

    type: Literal["reciprocating"]
    cycles: Annotated[Number, Field(gt=0.0)] | None = None
    positions: Annotated[int, Field(ge=2, le=200, strict=True)] = 12
    steady_tolerance: Annotated[Number, Field(gt=0.0, lt=1.0)] = 0.05
    tolerance: Annotated[Number, Field(ge=1e-9, le=0.1)] = 1e-3

    @model_validator(mode="after")
    def _ends(self):
        if self.end_time is not None and self.cycles is not None:
            raise KeyFault("cycles", "only one of end_time and cycles can be given")
        return self


class Stability(Section):
    """Thermoelastic instability of the contact: the critical speed and the shape that grows."""

    type: Literal["stability"]


def _jump(value: Any) -> Any:
    whole = isinstance(value, int) and not isinstance(value, bool)
    if value == "auto" or (whole and value >= 1):
        return value
    raise ValueError(f'found {quoted(value)}; must be "auto" or a whole number, at least 1')


class Fretting(Section):
    """Sticking and slipping under a history of loads.

    Attributes
    ----------
    increments : int
        From each corner of the history to the next.
    output_times : tuple of float
        Times that get files of their own [s].
    cycles : int or None
        How often the cycle of the history goes on, see `History.cycle_start`; ``wear.cycles`` says
        the same. Once by default.
    jump : int or str
        How many of them each computed cycle stands for: so many times it wears. ``"auto"``: as many
        as the tolerance allows.
    tolerance : float
        Allowed error of one jump, relative to the largest depth worn.
    frames : int
        How many states on the way are kept for an animation, at most: ends of cycles, or of
        increments where there is only one cycle.
    checkpoint_every : float
        Time of computing after which the run is saved again, besides at output times [s].
    """

    type: Literal["fretting"]
    increments: Annotated[int, Field(ge=1, strict=True)] = 20
    output_times: tuple[units.Instant, ...] = ()
    cycles: Annotated[int, Field(ge=1, strict=True)] | None = None
    jump: Annotated[int | Literal["auto"], BeforeValidator(_jump)] = "auto"
    tolerance: Annotated[Number, Field(ge=1e-9, le=0.1)] = 1e-2
    frames: Frames = 0
    checkpoint_every: units.Time = _MINUTES

    @model_validator(mode="after")
    def _outputs(self):
        _all_different(self.output_times)
        return self

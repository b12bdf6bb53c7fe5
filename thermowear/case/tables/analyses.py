"""Types of analysis."""

from __future__ import annotations

from collections import Counter
from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from ..values import units
from ..values.json_schema import OrAlso
from ..values.section import KeyFault, Number, Section, number_or


class OneWay(Section):
    """Base of analyses of one state, or in time, of faces that do not move back and forth."""

    cyclic: ClassVar[bool] = False


class Initial(OneWay):
    """Contact of the unworn faces."""

    type: Literal["initial"]


class Steady(OneWay):
    """Steady state of wear, computed without time stepping."""

    type: Literal["steady"]


_MINUTES = 120.0  # s; writing a state takes milliseconds
Frames = Annotated[int, Field(ge=0, le=1000, strict=True)]


def _distinct(output_times: tuple[float, ...]) -> tuple[float, ...]:
    """Reject output times that would be written to the same file."""
    counts = Counter(f"{t:g}" for t in output_times)
    twice = [name for name, count in counts.items() if count > 1]
    if twice:
        raise ValueError(f"contains {twice[0]} s twice (to six digits)")
    return output_times


class Timed(OneWay):
    """Base of analyses in time, see `model.analyses.TimedAnalysis`."""

    type: str
    end_time: units.Time | None = None
    until: Literal["steady"] | None = None
    steady_tolerance: Annotated[Number, Field(gt=0.0, lt=1.0)] = 1e-3
    output_times: Annotated[tuple[units.Time, ...], AfterValidator(_distinct)] = ()
    tolerance: Annotated[Number, Field(ge=1e-9, le=0.1)] = 1e-4
    max_steps: Annotated[int, Field(ge=1, strict=True)] = 10_000
    frames: Frames = 0
    checkpoint_every: units.Time = _MINUTES

    @model_validator(mode="after")
    def _outputs(self):
        if self.end_time is not None:
            late = [t for t in self.output_times if t > self.end_time]
            if late:
                raise KeyFault(
                    "output_times", f"{late[0]:g} s lies after end_time {self.end_time:g} s"
                )
        return self


class Transient(Timed):
    """Running-in; steady within `steady_tolerance`, relative to the largest steady pressure."""

    type: Literal["transient"]

    @model_validator(mode="after")
    def _ends(self):
        if self.end_time is None and self.until is None:
            raise KeyFault("end_time", 'missing; needs end_time = "…" or until = "steady"')
        return self


class Reciprocating(Timed):
    """Reciprocating sliding, see `model.analyses.ReciprocatingAnalysis`.

    Attributes
    ----------
    cycles : float or None
        Number of cycles, instead of an end time; equivalent to ``wear.cycles``.
    """

    cyclic: ClassVar[bool] = True

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


MOST_HOT_SPOTS = 1000
"""Largest number of hot spots round an axis."""
HotSpotNumber = Annotated[int, Field(ge=0, le=MOST_HOT_SPOTS, strict=True)]


def _up_to(given: Any) -> Any:
    """Numbers from zero to a given one; anything else as it is."""
    if isinstance(given, int) and not isinstance(given, bool) and 0 <= given <= MOST_HOT_SPOTS:
        return tuple(range(given + 1))
    return given


def _each_once(numbers: tuple[float, ...]) -> tuple[float, ...]:
    """Reject numbers that are given twice."""
    twice = [number for number, count in Counter(numbers).items() if count > 1]
    if twice:
        raise ValueError(f"contains {twice[0]:g} twice")
    return numbers


class Stability(OneWay):
    """Thermoelastic instability of the contact: critical speed and unstable mode.

    Attributes
    ----------
    hot_spots : tuple of int
        Numbers of hot spots round the axis to search; in the file also the largest one alone, for
        all up to it.
    wave_lengths : tuple of float
        Wave lengths along the sliding, of a section that it is normal to [m].
    mirror : str, or tuple of str, or None
        Surfaces in the mirror plane of a half model, by default that of the geometry.
    """

    type: Literal["stability"]
    hot_spots: Annotated[
        tuple[HotSpotNumber, ...],
        BeforeValidator(_up_to),
        AfterValidator(_each_once),
        OrAlso({"type": "integer", "minimum": 0, "maximum": MOST_HOT_SPOTS}),
    ] = ()
    wave_lengths: Annotated[tuple[units.Length, ...], AfterValidator(_each_once)] = ()
    mirror: str | tuple[str, ...] | None = None

    @model_validator(mode="after")
    def _of_one_kind(self):
        if self.hot_spots and self.wave_lengths:
            raise KeyFault("wave_lengths", "only one of hot_spots and wave_lengths can be given")
        if self.mirror is not None and not (self.hot_spots or self.wave_lengths):
            raise KeyFault("mirror", "needs hot_spots or wave_lengths")
        return self

    @property
    def mirrors(self) -> tuple[str, ...] | None:
        """Surfaces in the mirror plane; None if not given."""
        return (self.mirror,) if isinstance(self.mirror, str) else self.mirror


_JUMP = number_or(
    "auto",
    where=lambda jump: isinstance(jump, int) and jump >= 1,
    allowed='"auto" or a whole number, at least 1',
)


class Fretting(Section):
    """Fretting, see `model.analyses.FrettingAnalysis`.

    Attributes
    ----------
    cycles : int or None
        Number of repetitions of the cycle of the history, equivalent to ``wear.cycles``; one by
        default.
    """

    cyclic: ClassVar[bool] = True

    type: Literal["fretting"]
    increments: Annotated[int, Field(ge=1, strict=True)] = 20
    output_times: Annotated[tuple[units.Instant, ...], AfterValidator(_distinct)] = ()
    cycles: Annotated[int, Field(ge=1, strict=True)] | None = None
    jump: Annotated[int | Literal["auto"], _JUMP] = "auto"
    tolerance: Annotated[Number, Field(ge=1e-9, le=0.1)] = 1e-2
    frames: Frames = 0
    checkpoint_every: units.Time = _MINUTES

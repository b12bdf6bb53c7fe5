"""Differences between two cases, and those allowed when a run is resumed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from ..any_case import AnyCase
from ..tables.analyses import Fretting, Reciprocating, Timed
from ..tables.schema import as_plain
from ..values.section import Section

_FREE = {"title", "analysis.max_steps", "analysis.frames", "analysis.checkpoint_every"}
"""Keys that do not affect any computed number."""
_FILES = ("geometry.path", ".initial_shape")
"""Ends of keys of files, whose path may change: meshes and gaps read from them are compared."""
_END = {"analysis.end_time", "analysis.cycles", "wear.cycles"}
_OUTPUTS = "analysis.output_times"
_ASIDE = {"calibrate", "study"}
"""Tables of other commands."""
_LONGEST = 60  # characters of a value that is shown


@dataclass(frozen=True)
class Change:
    """A key whose value differs between two cases, defaults included.

    Attributes
    ----------
    key : str
        Dotted path of the key.
    before, now : object
        Plain values; None if absent.
    """

    key: str
    before: Any
    now: Any

    def __str__(self) -> str:
        return f"{self.key} was {_truncated(self.before)}, is now {_truncated(self.now)}"


def changes(before: Section, now: Section) -> list[Change]:
    """Keys whose values differ between two cases, in the order of the case."""
    one, other = (
        {key: table for key, table in as_plain(case).items() if key not in _ASIDE}
        for case in (before, now)
    )
    return list(_differences(one, other, ""))


def irrelevant_changes_only(before: Section, now: Section) -> bool:
    """True if both lead to the same numbers, provided that a mesh file has the same content."""
    return all(change.key in _FREE | {"geometry.path"} for change in changes(before, now))


def forbidden_changes(before: AnyCase, now: AnyCase, time: float) -> list[Change]:
    """Changes that prevent a case from resuming another one's run at a time [s].

    The physics must be identical. The end may change unless it has passed, and so may later
    output times and the paths of files.
    """
    free = set(_FREE)
    if _end_time(before) is not None and (_end_time(now) or 0.0) >= time:
        free |= _END
    if _outputs(before, time) == _outputs(now, time):
        free.add(_OUTPUTS)
    found = (change for change in changes(before, now) if not change.key.endswith(_FILES))
    return [change for change in found if change.key not in free]


def _differences(one: Any, other: Any, path: str) -> Iterator[Change]:
    if isinstance(one, dict) and isinstance(other, dict):
        for key in dict.fromkeys([*one, *other]):
            yield from _differences(one.get(key), other.get(key), f"{path}.{key}" if path else key)
    elif one != other:
        yield Change(path, one, other)


def _truncated(value: Any) -> str:
    """Text of a value, truncated."""
    text = "not given" if value is None else str(value)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 2]} …"


def _end_time(case: AnyCase) -> float | None:
    """Latest end time of an analysis that can be extended [s]."""
    settings = case.analysis
    if isinstance(settings, Fretting):
        return case.load_histories.end(int(case.cycles or 1))
    if not isinstance(settings, Timed):
        return None
    count = case.cycles
    if isinstance(settings, Reciprocating) and count is not None:
        assert case.reciprocation is not None  # the case has been checked
        return count / case.reciprocation[1]
    return float("inf") if settings.end_time is None else settings.end_time


def _outputs(case: AnyCase, time: float) -> set[float]:
    """Output times reached at a time."""
    settings = case.analysis
    if not isinstance(settings, Timed | Fretting):
        return set()
    return {t for t in settings.output_times if t <= time}

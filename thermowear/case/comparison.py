"""What two cases differ in, and what may differ where one goes on with the run of the other."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .analyses import Fretting, Reciprocating, Timed
from .oscillation import cycles
from .schema import Case, as_plain

_FREE = {"title", "analysis.max_steps", "analysis.checkpoint_every"}
"""Keys that no number that was computed depends on."""
_END = {"analysis.end_time", "analysis.cycles", "wear.cycles"}
_OUTPUTS = "analysis.output_times"


def different_keys(one: Case, other: Case) -> list[str]:
    """Dotted keys whose values differ, defaults included."""
    return list(_different(as_plain(one), as_plain(other), ""))


def irrelevant_changes_only(one: Case, other: Case) -> bool:
    """Whether both lead to the same numbers."""
    return set(different_keys(one, other)) <= _FREE


def forbidden_changes(before: Case, now: Case, time: float) -> list[str]:
    """Keys that keep a case from going on with the run of another one from a time [s].

    The physics must be the same; the end may be another one, if it has not passed, and so may the
    output times that have not.
    """
    changed = set(different_keys(before, now)) - _FREE
    if _end(before) is not None and (_end(now) or 0.0) >= time:
        changed -= _END
    if _outputs(before, time) == _outputs(now, time):
        changed.discard(_OUTPUTS)
    return sorted(changed)


def _different(one: Any, other: Any, path: str) -> Iterator[str]:
    if isinstance(one, dict) and isinstance(other, dict):
        for key in dict.fromkeys([*one, *other]):
            yield from _different(one.get(key), other.get(key), f"{path}.{key}" if path else key)
    elif one != other:
        yield path


def _end(case: Case) -> float | None:
    """Time at which an analysis by steps of its own choice ends at the latest [s]."""
    settings = case.analysis
    if not isinstance(settings, Timed):
        return None
    count = cycles(case)
    if isinstance(settings, Reciprocating) and count is not None:
        assert case.motion is not None  # the case has been checked
        assert case.motion.frequency is not None
        return count / case.motion.frequency
    return float("inf") if settings.end_time is None else settings.end_time


def _outputs(case: Case, time: float) -> set[float]:
    """Output times that have passed at a time."""
    settings = case.analysis
    if not isinstance(settings, Timed | Fretting):
        return set()
    return {t for t in settings.output_times if t <= time}

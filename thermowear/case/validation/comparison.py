"""What two cases differ in, and what may differ where one goes on with the run of the other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from ..tables.analyses import Fretting, Reciprocating, Timed
from ..tables.schema import Case, as_plain

_FREE = {"title", "analysis.max_steps", "analysis.frames", "analysis.checkpoint_every"}
"""Keys that no number that was computed depends on."""
_FILES = {"geometry.path", "geometry.initial_shape"}
"""Keys of files, wherever they lie: what is compared is the bodies and gaps that they lead to."""
_END = {"analysis.end_time", "analysis.cycles", "wear.cycles"}
_OUTPUTS = "analysis.output_times"
_LONGEST = 60  # characters of a value that is shown


@dataclass(frozen=True)
class Change:
    """A key whose value differs between two cases, defaults included.

    Attributes
    ----------
    key : str
        With its tables, dotted.
    before, now : object
        Plain values; None where there is none.
    """

    key: str
    before: Any
    now: Any

    def __str__(self) -> str:
        return f"{self.key} was {_shown(self.before)}, and is {_shown(self.now)} now"


def changes(before: Case, now: Case) -> list[Change]:
    """What two cases differ in, in the order of the case."""
    return list(_different(as_plain(before), as_plain(now), ""))


def irrelevant_changes_only(before: Case, now: Case) -> bool:
    """Whether both lead to the same numbers, if a mesh file has the same content."""
    return all(change.key in _FREE | {"geometry.path"} for change in changes(before, now))


def other_mesh(case: Case) -> str:
    """Message to one who goes on with a run of another mesh."""
    path = as_plain(case)["geometry"]["path"]
    return (
        f"--resume: geometry.path: the mesh in {path} is not that of the run; name "
        "the file with that mesh, or --overwrite starts it from the beginning"
    )


def forbidden_changes(before: Case, now: Case, time: float) -> list[Change]:
    """What keeps a case from going on with the run of another one from a time [s].

    The physics must be the same; the end may be another one, if it has not passed, and so may the
    output times that have not, and the places of files.
    """
    free = _FREE | _FILES
    if _end(before) is not None and (_end(now) or 0.0) >= time:
        free |= _END
    if _outputs(before, time) == _outputs(now, time):
        free.add(_OUTPUTS)
    return [change for change in changes(before, now) if change.key not in free]


def _different(one: Any, other: Any, path: str) -> Iterator[Change]:
    if isinstance(one, dict) and isinstance(other, dict):
        for key in dict.fromkeys([*one, *other]):
            yield from _different(one.get(key), other.get(key), f"{path}.{key}" if path else key)
    elif one != other:
        yield Change(path, one, other)


def _shown(value: Any) -> str:
    """A value in a few words."""
    text = "not given" if value is None else str(value)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 2]} …"


def _end(case: Case) -> float | None:
    """Time at which an analysis that can be made longer ends at the latest [s]."""
    settings = case.analysis
    if isinstance(settings, Fretting):
        return _end_of_cycles(case)
    if not isinstance(settings, Timed):
        return None
    count = case.cycles
    if isinstance(settings, Reciprocating) and count is not None:
        assert case.motion is not None  # the case has been checked
        assert case.motion.frequency is not None
        return count / case.motion.frequency
    return float("inf") if settings.end_time is None else settings.end_time


def _end_of_cycles(case: Case) -> float:
    """Time at which the history of loads ends, the repetitions of its cycle included [s]."""
    history = case.load.history
    assert history is not None  # the case has been checked
    begin, end = history.cycle or (0.0, history.time[-1])
    return end + (int(case.cycles or 1) - 1) * (end - begin)


def _outputs(case: Case, time: float) -> set[float]:
    """Output times that have passed at a time."""
    settings = case.analysis
    if not isinstance(settings, Timed | Fretting):
        return set()
    return {t for t in settings.output_times if t <= time}

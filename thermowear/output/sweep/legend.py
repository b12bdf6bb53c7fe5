"""Legends below the panels of a figure."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from matplotlib.artist import Artist
from matplotlib.figure import Figure

_LINE = 0.22  # inches
_SHORT = 14  # characters of an entry, up to which several entries stand side by side
_MOST_COLUMNS = 4


def add_legend(figure: Figure, place: str, title: str, handles: Sequence[Artist]) -> None:
    """Add a legend; short entries stand side by side."""
    figure.legend(handles=handles, loc=place, title=title, ncols=_columns(handles))


def tallest(legends: Iterable[Sequence[Artist]]) -> float:
    """Height of the tallest of several legends side by side [inches]."""
    return max((_LINE * (1.5 + _rows(handles)) for handles in legends), default=0.0)


def _columns(handles: Sequence[Artist]) -> int:
    longest = max(len(str(handle.get_label())) for handle in handles)
    return min(_MOST_COLUMNS, len(handles)) if longest <= _SHORT else 1


def _rows(handles: Sequence[Artist]) -> int:
    lines = sum(1 + str(handle.get_label()).count("\n") for handle in handles)
    return -(-lines // _columns(handles))

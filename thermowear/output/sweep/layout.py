"""Assignment of swept keys to colours, line styles and columns of panels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure

from .keys import Axis
from .record import VariantRecord

LINES = ("-", "--", "-.", ":")
_LEGEND_LIMIT = 6
_LEGEND_LINE = 0.22  # height of a line of a legend [inches]
_SHORT = 14  # characters of a legend entry, up to which several entries stand side by side
_LEGEND_COLUMNS = 4
_MOST_COLUMNS = 6
_LOG_RATIO = 30.0
"""Smallest ratio of largest to smallest value for a logarithmic axis; the values must also be more
evenly spaced on it."""


@dataclass(frozen=True)
class Layout:
    """Assignment of the swept keys in a picture.

    Attributes
    ----------
    record : VariantRecord
    colored : int
        Index of the key shown by colour, or along the horizontal axis.
    lined : int or None
        Index of the key shown by line style.
    columns : list of (str, ndarray of bool)
        Title of each column of panels, and mask of its variants.
    """

    record: VariantRecord
    colored: int
    lined: int | None
    columns: list[tuple[str, np.ndarray]]

    @property
    def axis(self) -> Axis:
        """Axis of the key shown by colour."""
        return self.record.axes[self.colored]

    @property
    def continuous(self) -> bool:
        """True if colours form a continuous scale instead of entries of a legend."""
        return self.axis.numbers is not None and len(self.axis.words) > _LEGEND_LIMIT

    def color(self, index: int):
        """Colour of a value of the coloured key, by its index."""
        if self.continuous:
            assert self.axis.numbers is not None
            return self.scale().to_rgba(np.array(self.axis.numbers[index]))
        if self.axis.numbers is None:
            return f"C{index % 10}"
        order = np.argsort(np.argsort(self.axis.numbers))
        return mpl.colormaps["viridis"](0.85 * order[index] / max(len(order) - 1, 1))

    def scale(self) -> ScalarMappable:
        """Colour scale for a colour bar."""
        assert self.axis.numbers is not None
        low, high = min(self.axis.numbers), max(self.axis.numbers)
        norm = LogNorm(low, high) if is_wide(self.axis.numbers) else Normalize(low, high)
        return ScalarMappable(norm, "viridis")

    def line(self, indices: np.ndarray) -> str:
        """Line style of a variant, from its value indices."""
        return "-" if self.lined is None else LINES[indices[self.lined]]


def lay_out(record: VariantRecord) -> Layout:
    """Assign the swept keys to visual channels.

    The numeric key with most values is shown by colour, the next key with few values by line style;
    each combination of the remaining keys gets a column of panels.
    """
    sizes = [len(axis.words) for axis in record.axes]
    order = sorted(range(len(sizes)), key=lambda k: (record.axes[k].numbers is None, -sizes[k]))
    colored, *rest = [k for k in order if sizes[k] > 1] or [0]
    lined = next((k for k in rest if sizes[k] <= len(LINES)), None)
    rest = sorted(k for k in rest if k != lined)
    columns = []
    for combination in np.unique(record.indices[:, rest], axis=0)[:_MOST_COLUMNS]:
        chosen = (record.indices[:, rest] == combination).all(axis=1)
        named = (_named(record.axes[k], index) for k, index in zip(rest, combination, strict=True))
        columns.append((", ".join(named), chosen))
    return Layout(record, colored, lined, columns)


def is_wide(numbers) -> bool:
    """Test whether numbers suit a logarithmic axis better than a linear one."""
    if len(numbers) < 3 or min(numbers) <= 0 or max(numbers) < _LOG_RATIO * min(numbers):
        return False
    linear, logarithmic = (np.diff(np.sort(x)) for x in (numbers, np.log(numbers)))
    return bool(logarithmic.min() / logarithmic.max() > linear.min() / linear.max())


def _named(axis: Axis, index: int) -> str:
    return f"{axis.key} = {axis.words[index]}"


def add_legend(figure: Figure, location: str, title: str, handles: Sequence[Artist]) -> None:
    """Add a legend below the panels."""
    figure.legend(handles=handles, loc=location, title=title, ncols=_legend_columns(handles))


def legend_height(handles: Sequence[Artist]) -> float:
    """Height of a legend [inches]."""
    lines = sum(1 + str(handle.get_label()).count("\n") for handle in handles)
    return _LEGEND_LINE * (1.5 + -(-lines // _legend_columns(handles)))


def _legend_columns(handles: Sequence[Artist]) -> int:
    longest = max(len(str(handle.get_label())) for handle in handles)
    return min(_LEGEND_COLUMNS, len(handles)) if longest <= _SHORT else 1

"""Which swept key is shown how: by colour, by the kind of line, or in a column of its own."""

from __future__ import annotations

from dataclasses import dataclass

import matplotlib as mpl
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize

from .keys import Axis
from .record import Record

LINES = ("-", "--", "-.", ":")
_FEW = 6
_MOST_COLUMNS = 6
_WIDE = 30.0
"""Numbers are shown on a logarithmic axis if the largest is so many times the smallest, and if they
lie more evenly there."""


@dataclass(frozen=True)
class Layout:
    """The parts that the swept keys play in a picture.

    Attributes
    ----------
    record : Record
    colored : int
        Number of the key that is shown by colour, or along the axis of numbers.
    lined : int or None
        Of the key that is shown by the kind of line.
    columns : list of (str, ndarray of bool)
        The variants in each column of panels, and its title.
    """

    record: Record
    colored: int
    lined: int | None
    columns: list[tuple[str, np.ndarray]]

    @property
    def axis(self) -> Axis:
        """Of the key that is shown by colour."""
        return self.record.axes[self.colored]

    @property
    def continuous(self) -> bool:
        """Whether colours are those of a scale, rather than of words in a legend."""
        return self.axis.numbers is not None and len(self.axis.words) > _FEW

    def color(self, place: int):
        """Of a value of the coloured key."""
        if self.continuous:
            assert self.axis.numbers is not None
            return self.scale().to_rgba(np.array(self.axis.numbers[place]))
        if self.axis.numbers is None:
            return f"C{place % 10}"
        order = np.argsort(np.argsort(self.axis.numbers))
        return mpl.colormaps["viridis"](0.85 * order[place] / max(len(order) - 1, 1))

    def scale(self) -> ScalarMappable:
        """Of the colours, for a colour bar."""
        assert self.axis.numbers is not None
        low, high = min(self.axis.numbers), max(self.axis.numbers)
        norm = LogNorm(low, high) if is_wide(self.axis.numbers) else Normalize(low, high)
        return ScalarMappable(norm, "viridis")

    def line(self, places: np.ndarray) -> str:
        """Kind of line of a variant, from its places."""
        return "-" if self.lined is None else LINES[places[self.lined]]


def lay_out(record: Record) -> Layout:
    """Give each key its part.

    The one with the most numbers is shown by colour, the next with few values by the kind of line;
    each combination of what is left has a column of panels.
    """
    sizes = [len(axis.words) for axis in record.axes]
    order = sorted(range(len(sizes)), key=lambda k: (record.axes[k].numbers is None, -sizes[k]))
    colored, *rest = [k for k in order if sizes[k] > 1] or [0]
    lined = next((k for k in rest if sizes[k] <= len(LINES)), None)
    rest = sorted(k for k in rest if k != lined)
    columns = []
    for combination in np.unique(record.places[:, rest], axis=0)[:_MOST_COLUMNS]:
        chosen = (record.places[:, rest] == combination).all(axis=1)
        named = (_named(record.axes[k], place) for k, place in zip(rest, combination, strict=True))
        columns.append((", ".join(named), chosen))
    return Layout(record, colored, lined, columns)


def is_wide(numbers) -> bool:
    """Whether numbers are better shown on a logarithmic axis."""
    if len(numbers) < 3 or min(numbers) <= 0 or max(numbers) < _WIDE * min(numbers):
        return False
    linear, logarithmic = (np.diff(np.sort(x)) for x in (numbers, np.log(numbers)))
    return bool(logarithmic.min() / logarithmic.max() > linear.min() / linear.max())


def _named(axis: Axis, place: int) -> str:
    return f"{axis.key} = {axis.words[place]}"

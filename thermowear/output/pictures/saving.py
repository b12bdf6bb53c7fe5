"""Figures and rendered bodies as files: one drawing of each figure, cropping."""

from __future__ import annotations

from functools import reduce
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import FixedLocator
from PIL import Image

DPI = 150
_CUT = 0.01  # margin left around the content of a picture, relative to its size
_COMPRESSION = 4
"""Half the time of the default for files that are a tenth larger."""
_WHITE = 250  # least value of the channels of white


def save(figure: Figure, path: Path, crop: bool = False) -> None:
    """Write a figure as a picture; `Figure.savefig` would draw it twice, first for its layout."""
    canvas = FigureCanvasAgg(figure)
    show_as_text(figure)
    _fix_ticks(figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())[..., :3]
    picture = Image.fromarray(np.ascontiguousarray(pixels[content(pixels)] if crop else pixels))
    picture.save(path, dpi=(DPI, DPI), compress_level=_COMPRESSION)


def show_as_text(figure: Figure) -> None:
    """Draw all texts as they are: names of bodies may look like mathematics ("$").

    Those by matplotlib, on logarithmic axes, are mathematics.
    """
    for text in figure.findobj(Text):
        if "$" in text.get_text() and not text.get_text().startswith(r"$\mathdefault{"):
            text.set_parse_math(False)


def _fix_ticks(figure: Figure) -> None:
    """Keep the ticks of a first layout, as other ones would need a different width in the second.

    The two may alternate for ever, and labels would be cut off. A layout that does not change the
    ticks is the last one. Rendered bodies have no axes.
    """
    if not any(axes.axison and not hasattr(axes, "_colorbar") for axes in figure.axes):
        return
    layout = figure.get_layout_engine()
    assert layout is not None
    every = [axis for axes in figure.axes for axis in (axes.xaxis, axes.yaxis)]
    before = [list(axis.get_majorticklocs()) for axis in every]
    layout.execute(figure)
    after = [list(axis.get_majorticklocs()) for axis in every]
    if after == before:
        figure.set_layout_engine("none")
        return
    for axis, places in zip(every, after, strict=True):
        if axis.get_scale() == "linear":
            axis.set_major_locator(FixedLocator(places))


def cropped(picture: np.ndarray) -> np.ndarray:
    """Picture without the white space around its content, except for a margin."""
    return picture[content(picture)]


def content(*pictures: np.ndarray) -> tuple[slice, slice]:
    """Rows and columns of the content of equally large pictures, with a margin."""
    darkest = reduce(np.minimum, pictures)
    rows = np.flatnonzero(darkest.reshape(len(darkest), -1).min(axis=1) < _WHITE)
    columns = np.flatnonzero(darkest.min(axis=0).min(axis=1) < _WHITE)
    if not len(rows):
        return np.s_[:, :]
    margin = round(_CUT * max(pictures[0].shape))
    first, last = max(rows[0] - margin, 0), rows[-1] + margin + 1
    left, right = max(columns[0] - margin, 0), columns[-1] + margin + 1
    return np.s_[first:last, left:right]

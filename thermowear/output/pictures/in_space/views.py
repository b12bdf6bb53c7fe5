"""Views of rendered bodies in rows, each with the colours of a quantity."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..panels import MAP_STYLE, Limits, add_color_bar, panels

_VIEW = (5.0, 4.0)  # largest width and height of a view [inches]


class View(NamedTuple):
    """Rendered bodies and the colours of a quantity.

    Attributes
    ----------
    pixels : ndarray, shape (height, width, 3)
    name, label : str
        Quantity, and label of its colour bar.
    limits : tuple of float
    largest : float
        Largest value, see `add_color_bar`.
    title : str
    """

    pixels: np.ndarray
    name: str
    label: str
    limits: Limits
    largest: float
    title: str = ""


def draw_views(path: Path, rows: list[list[View]], title: str = "") -> None:
    """Draw rows of views with the same heights in each row; the last one may be shorter."""
    width, height = _VIEW
    across = max(map(len, rows))
    views = [view for row in rows for view in row]
    shapes = [view.pixels.shape[1] / view.pixels.shape[0] for view in views]
    widths = [max(shapes[k::across]) for k in range(across)]
    tall = min(height, width / max(widths))
    size = (tall * float(np.mean(widths)) + 1.2, tall + 0.3)
    options: dict[str, Any] = {"style": MAP_STYLE, "crop": True, "width_ratios": widths}
    with panels(path, len(views), across, size, **options) as (figure, axes):
        for axis, view in zip(axes.flat, views, strict=False):
            axis.imshow(view.pixels, interpolation="antialiased")
            add_color_bar(axis, view.name, view.label, view.limits, view.largest)
            axis.set_axis_off()
            axis.set_title(view.title, fontsize=10)
        if title:
            figure.suptitle(title, fontsize=11)

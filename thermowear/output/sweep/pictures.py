"""Pictures of a sweep, from its files alone."""

from __future__ import annotations

from pathlib import Path

from ..pictures.maps import is_surface
from .layout import lay_out
from .maps import draw_shape_maps
from .numbers import draw_numbers
from .record import read_sweep
from .shapes import draw_shapes


def draw_sweep(folder: Path) -> list[str]:
    """Draw ``shapes.png`` and ``sweep.png``.

    Returns
    -------
    list of str
        What could not be drawn and why, one line each.

    Raises
    ------
    ValueError
        If the folder holds no sweep.
    """
    record = read_sweep(folder)
    if not record.folders:
        return [f"{folder}: no variant was computed to its end"]
    layout = lay_out(record)
    if is_surface(record.folders[0]):
        draw_shape_maps(record, folder / "shapes.png")
    else:
        draw_shapes(layout, folder / "shapes.png")
    draw_numbers(layout, folder / "sweep.png")
    return []

"""Pictures of a sweep, drawn from its files."""

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
        Reasons for missing pictures, one line each.

    Raises
    ------
    ValueError
        If the folder contains no sweep.
    """
    record = read_sweep(folder)
    if not record.folders:
        return [f"{folder}: no variant was completed, so nothing is drawn"]
    layout = lay_out(record)
    if is_surface(record.folders[0]):
        draw_shape_maps(record, folder / "shapes.png")
    else:
        draw_shapes(layout, folder / "shapes.png")
    draw_numbers(layout, folder / "sweep.png")
    return []

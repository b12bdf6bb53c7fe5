"""Pictures of a sweep, drawn from its files."""

from __future__ import annotations

from pathlib import Path

from ..pictures.maps import is_surface
from ..tables import MissingColumnError
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
    layout, notes = lay_out(record), []
    draw_contacts = draw_shape_maps if is_surface(record.folders[0]) else draw_shapes
    for draw, name in ((draw_contacts, "shapes.png"), (draw_numbers, "sweep.png")):
        try:
            draw(layout, folder / name)
        except MissingColumnError as reason:
            notes.append(f"{folder}: no {name}, as {reason}")
    return notes

"""Curves and maps drawn from the tables of a results folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from ..files import contacts_of, name_at, picture
from ..tables import MissingColumnError
from . import curves, maps, over_time
from .hot_spots import draw_hot_spots
from .modes import draw_modes

_ALONG_A_LINE: dict[str, Callable[..., None]] = {
    "interface": curves.draw_interface,
    "profile": curves.draw_profile,
    "wear": curves.draw_wear,
    "coating": curves.draw_coating,
    "mode": draw_modes,
    "friction": curves.draw_friction,
    "track": curves.draw_track,
}
_OVER_A_SURFACE: dict[str, Callable[..., None]] = {
    "interface": maps.draw_interface_maps,
    "wear": maps.draw_wear_maps,
    "coating": maps.draw_coating_maps,
    "friction": maps.draw_friction_maps,
    "track": maps.draw_track_maps,
    "mode": draw_modes,
}
_OF_THE_INTERFACE = ("wear", "coating")
"""Pictures drawn from ``interface.csv`` that have no table of their own."""
_OTHERS: dict[str, Callable[..., None]] = {
    "history": over_time.draw_history,
    "heat": over_time.draw_heat,
    "loads": over_time.draw_loads,
    "cycles": over_time.draw_cycles,
    "hot_spots": draw_hot_spots,
}


def draw_tables(folder: Path, in_space: bool) -> list[str]:
    """Draw curves and maps from the tables; returns missing pictures with reasons."""
    notes = []
    first = _OVER_A_SURFACE if in_space else _ALONG_A_LINE
    contacts = contacts_of(folder)
    each = [(name, draw, (contact,)) for contact in contacts for name, draw in first.items()]
    for name, draw, contact in [*each, *((name, draw, ()) for name, draw in _OTHERS.items())]:
        try:
            if name in _OF_THE_INTERFACE or (folder / name_at(name, None, *contact)).is_file():
                draw(folder, *contact)
        except MissingColumnError as reason:
            notes.append(f"{folder}: no {picture(name, *contact)}, as {reason}")
    return notes

"""Curves and maps drawn from the tables of a results folder."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from ..files import contacts_of, name_at, picture
from ..tables import MissingColumnError
from . import curves, maps, over_time
from .modes import draw_hot_spots, draw_modes

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

_Picture = tuple[str, Callable[..., None], tuple[str, ...]]
"""Name, function that draws it, and contact, if it is one of a contact."""


def draw_tables(folder: Path, in_space: bool, contacts: int) -> list[str]:
    """Draw curves and maps of the first contacts, and of the whole, from the tables.

    Returns
    -------
    list of str
        Missing pictures with reasons.
    """
    notes = _drawn(folder, _of_contacts(contacts_of(folder)[:contacts], in_space))
    return notes + _drawn(folder, [(name, draw, ()) for name, draw in _OTHERS.items()])


def draw_other_contacts(folder: Path, in_space: bool, contacts: int) -> None:
    """Draw curves and maps of all contacts but the first ones.

    Raises
    ------
    MissingColumnError
        At the end, with the reasons of missing pictures.
    """
    notes = _drawn(folder, _of_contacts(contacts_of(folder)[contacts:], in_space))
    if notes:
        raise MissingColumnError("; ".join(notes))


def _of_contacts(contacts: list[str], in_space: bool) -> list[_Picture]:
    drawn = _OVER_A_SURFACE if in_space else _ALONG_A_LINE
    return [(name, draw, (contact,)) for contact in contacts for name, draw in drawn.items()]


def _drawn(folder: Path, pictures: Iterable[_Picture]) -> list[str]:
    notes = []
    for name, draw, contact in pictures:
        try:
            if name in _OF_THE_INTERFACE or (folder / name_at(name, None, *contact)).is_file():
                draw(folder, *contact)
        except MissingColumnError as reason:
            notes.append(f"{folder}: no {picture(name, *contact)}, as {reason}")
    return notes

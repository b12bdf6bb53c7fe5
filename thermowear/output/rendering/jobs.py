"""Pictures of bodies: what draws each of them, and which need VTK."""

from __future__ import annotations

import traceback
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

WARM_UP = ("warm up", ())
"""Kind and arguments of a drawing that loads what all others need."""
_DRAWN_BY = {
    WARM_UP[0]: ("in_space.solids", "warm_up"),
    "bodies": ("bodies", "draw_bodies"),
    "hot spots": ("in_space.hot_spot_views", "draw_views"),
    "animation": ("animation", "draw_animation"),
    "mesh": ("in_space.mesh", "draw_mesh"),
    "contacts": ("from_tables", "draw_other_contacts"),
}
"""Module of the pictures, imported only where it draws, and function of each kind."""


class PictureJob(NamedTuple):
    """Pictures of one kind.

    Attributes
    ----------
    kind : str
    arguments : tuple of (str or float)
        Absolute paths as strings, and numbers.
    in_space : bool
        True for pictures that need VTK.
    timeout : float
        Time after which drawing is given up [s].
    apart : bool
        True for pictures drawn in another process though they need no VTK.
    """

    kind: str
    arguments: tuple[str | float, ...]
    in_space: bool = True
    timeout: float = 180.0
    apart: bool = False


def attempt(kind: str, arguments: tuple[str | float, ...]) -> str:
    """Draw pictures in this process; returns the reason of a failure, empty on success."""
    module, function = _DRAWN_BY[kind]
    try:
        draw = getattr(import_module(f"...pictures.{module}", __name__), function)
        draw(*(Path(each) if isinstance(each, str) else each for each in arguments))
    except Exception as error:
        return traceback.format_exception_only(error)[-1].strip().splitlines()[-1]
    return ""

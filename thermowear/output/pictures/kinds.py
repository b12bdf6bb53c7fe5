"""Kinds of pictures that a results folder has; without matplotlib, which takes its time to load."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .. import tables
from ..files import FRAMES, contacts_of, name_at
from ..frames import frame_files

FPS = 8.0
"""Frames per second of an animation."""


def is_surface(folder: Path) -> bool:
    """Test whether the contact points of a results folder form a surface, not a line."""
    data = tables.read(folder / name_at("interface", None, contacts_of(folder)[0]))
    return "s" in data and bool(np.isnan(data["s"]).all())


def has_frames(folder: Path) -> bool:
    """Test whether a results folder has frames."""
    return bool(frame_files(folder / FRAMES))

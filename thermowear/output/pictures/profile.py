"""Worn shape of inclined or curved faces, along the normal and along the load direction."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .. import tables
from .curves import abscissa, panels

_SAME = 1e-3
"""Relative difference below which both shapes coincide, as on a level face."""
_SMALLEST_RANGE = 1e-2
"""Smallest range of wear rates along the face, relative to their size."""
_PAIRS = (
    ("shape", "shape_along_press", "height of the unloaded face"),
    ("wear_rate", "wear_rate_along_press", "wear rate"),
)


def draw_profile(folder: Path) -> None:
    """Draw ``profile.png``: worn shape and wear rates of a face that is not level."""
    data = tables.read(folder / "profile.csv")
    pairs = [pair for pair in _PAIRS if _differ(*(data[name] for name in pair[:2]))]
    if not pairs or not np.any(data["wear_rate"] > 0):
        return
    size = (6.4, 2.6 * len(pairs))
    with panels(folder / "profile.png", len(pairs), size, sharex=True) as axes:
        label, place = abscissa(data)
        for axis, (along_normal, along_press, what) in zip(axes, pairs, strict=True):
            kinds = ((along_normal, "-", "normal"), (along_press, "--", "load direction"))
            for name, line, how in kinds:
                axis.plot(place, data.drawn(name), line, label=f"along the {how}")
            axis.set_ylabel(f"{what}\n[{data.quantities[along_normal].unit}]")
        axes[0].legend()
        axes[-1].set_xlabel(label)


def _differ(along_normal: np.ndarray, along_press: np.ndarray) -> bool:
    size = max(float(np.ptp(along_normal)), _SMALLEST_RANGE * float(np.abs(along_normal).max()))
    return float(np.nanmax(np.abs(along_press - along_normal))) > _SAME * size

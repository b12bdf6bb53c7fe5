"""Worn shape of inclined or curved faces, along the normal and along the load direction."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from .. import tables
from ..coordinates import model_of
from ..quantities import PROFILE
from .curves import STYLE, abscissa

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
    if not (folder / "profile.csv").is_file():
        return
    data = tables.read(folder / "profile.csv", PROFILE)
    pairs = [pair for pair in _PAIRS if _differ(*(data[name] for name in pair[:2]))]
    if not pairs or not np.any(data["wear_rate"] > 0):
        return
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.4, 2.6 * len(pairs)), layout="constrained", dpi=150)
        axes = figure.subplots(len(pairs), sharex=True, squeeze=False)[:, 0]
        label, place = abscissa(data, model_of(folder))
        for axis, (along_normal, along_press, what) in zip(axes, pairs, strict=True):
            kinds = ((along_normal, "-", "normal"), (along_press, "--", "load direction"))
            for name, line, how in kinds:
                axis.plot(place, PROFILE[name].drawn(data[name]), line, label=f"along the {how}")
            axis.set_ylabel(f"{what}\n[{PROFILE[along_normal].unit}]")
        axes[0].legend()
        axes[-1].set_xlabel(label)
        figure.savefig(folder / "profile.png")


def _differ(along_normal: np.ndarray, along_press: np.ndarray) -> bool:
    size = max(float(np.ptp(along_normal)), _SMALLEST_RANGE * float(np.abs(along_normal).max()))
    return float(np.nanmax(np.abs(along_press - along_normal))) > _SAME * size

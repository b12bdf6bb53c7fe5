"""Curves of several runs along the contact in one picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from .. import tables
from ..coordinates import model_of
from ..quantities import INTERFACE, PROFILE, Quantity
from .curves import STYLE, abscissa

_FILES: dict[str, tuple[str, dict[str, Quantity]]] = {
    **dict.fromkeys(PROFILE, ("profile.csv", PROFILE)),
    **dict.fromkeys(INTERFACE, ("interface.csv", INTERFACE)),
}

_SINGULAR, _MOST = 3.0, 0.9
"""Peaks are clipped if they exceed the first factor times the quantile of the second: pressure
singularities at corners of unworn faces would hide all other values."""


@dataclass(frozen=True)
class OverlayPanel:
    """Panel of a picture.

    Attributes
    ----------
    quantity : str
        Column of ``interface.csv`` or ``profile.csv``, by its name in `quantities`.
    title : str
    from_zero : bool
        True if the axis begins at zero.
    """

    quantity: str
    title: str = ""
    from_zero: bool = False


def draw_overlay(runs: Mapping[str, Path], panels: Sequence[OverlayPanel], path: Path) -> None:
    """Draw quantities of several runs for comparison.

    Parameters
    ----------
    runs : dict of str to Path
        Results folders by their legend entry.
    panels : sequence of OverlayPanel
    path : Path
        Picture to write.
    """
    colors = mpl.colormaps["viridis"](np.linspace(0.0, 0.85, len(runs)))
    styles = ("-", "--", "-.", ":")
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.4, 2.6 * len(panels)), layout="constrained", dpi=150)
        axes = figure.subplots(len(panels), sharex=True, squeeze=False)[:, 0]
        for axis, panel in zip(axes, panels, strict=True):
            name, table = _FILES[panel.quantity]
            highest = []
            for k, (label, folder) in enumerate(runs.items()):
                data = tables.read(folder / name, table)
                where, place = abscissa(data, model_of(folder))
                drawn = table[panel.quantity].drawn(data[panel.quantity])
                axis.plot(place, drawn, styles[k % 4], color=colors[k], label=label)
                highest.append((np.nanmax(drawn), np.nanquantile(drawn, _MOST)))
            peak, usual = np.max(highest, axis=0)
            if usual > 0 and peak > _SINGULAR * usual:
                axis.set_ylim(top=1.5 * usual)
            axis.set_ylabel(f"{table[panel.quantity].label}\n[{table[panel.quantity].unit}]")
            axis.set_title(panel.title, fontsize="medium")
            if panel.from_zero:
                axis.set_ylim(bottom=0)
        axes[0].legend()
        axes[-1].set_xlabel(where)
        figure.savefig(path)

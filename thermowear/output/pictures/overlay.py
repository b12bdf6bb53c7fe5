"""Curves of several runs along the contact in one picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np

from ...results import TABLES
from .. import tables
from .curves import abscissa, cut_singular, panels


@dataclass(frozen=True)
class OverlayPanel:
    """Panel of a picture.

    Attributes
    ----------
    quantity : str
        Column of ``interface.csv`` or ``profile.csv``, by the name of its field.
    title : str
    from_zero : bool
        True if the axis begins at zero.
    """

    quantity: str
    title: str = ""
    from_zero: bool = False


def draw_overlay(runs: Mapping[str, Path], shown: Sequence[OverlayPanel], path: Path) -> None:
    """Draw quantities of several runs for comparison.

    Parameters
    ----------
    runs : dict of str to Path
        Results folders by their legend entry.
    shown : sequence of OverlayPanel
        Panels, one above the other.
    path : Path
        Picture to write.
    """
    colors = mpl.colormaps["viridis"](np.linspace(0.0, 0.85, len(runs)))
    styles = ("-", "--", "-.", ":")
    with panels(path, len(shown), (6.4, 2.6 * len(shown)), sharex=True) as axes:
        for axis, panel in zip(axes, shown, strict=True):
            name, curves = panel.quantity, []
            stem = "interface" if name in TABLES["interface"].columns else "profile"
            for k, (label, folder) in enumerate(runs.items()):
                data = tables.read(folder / f"{stem}.csv")
                where, place = abscissa(data)
                curves.append(data.drawn(name))
                axis.plot(place, curves[-1], styles[k % 4], color=colors[k], label=label)
            cut_singular(axis, *curves)
            axis.set_ylabel(data.quantities[name].wrapped)
            axis.set_title(panel.title, fontsize="medium")
            if panel.from_zero:
                axis.set_ylim(bottom=0)
        axes[0].legend()
        axes[-1].set_xlabel(where)

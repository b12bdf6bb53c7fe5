"""First hot spots on the best conductor, from both sides.

Drawn in the rendering process, as pyvista may crash.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyvista
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from ..panels import MAP_STYLE, cropped, panels
from .solids import rendering

_VIEWS = {"from above": (0.35, -0.8, 1.0), "from below": (0.35, -0.8, -1.0)}
_SIZE = (4.4, 3.6)  # of a view [inches]
_COLORS = "coolwarm"


def draw_views(folder: Path) -> None:
    """Draw ``hot_spots_3d.png`` from ``hot_spots.vtu``."""
    whole = pyvista.read(folder / "hot_spots.vtu")
    body = whole.threshold(0.5, scalars="is_best_conductor", preference="cell")
    surface = body.clean().extract_surface() if hasattr(body, "clean") else body.extract_surface()
    limit = float(np.abs(surface["temperature_K"]).max()) or 1.0
    with panels(folder / "hot_spots_3d.png", 2, 2, _SIZE, style=MAP_STYLE, crop=True) as (
        figure,
        axes,
    ):
        for axis, (side, camera) in zip(axes[0], _VIEWS.items(), strict=True):
            with rendering(camera) as (plotter, picture):
                plotter.add_mesh(
                    surface,
                    scalars="temperature_K",
                    cmap=_COLORS,
                    clim=(-limit, limit),
                    show_scalar_bar=False,
                    ambient=0.8,
                    diffuse=0.2,
                )
            axis.imshow(cropped(picture[0]))
            axis.set_axis_off()
            axis.set_title(side, fontsize=10)
        colored = ScalarMappable(Normalize(-1.0, 1.0), _COLORS)
        label = "temperature perturbation, largest value 1"
        figure.colorbar(colored, ax=axes, label=label, orientation="horizontal", shrink=0.5)

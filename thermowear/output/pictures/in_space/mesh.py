"""Mesh of bodies in space with its named surfaces, from above and from below.

Drawn in the rendering process, as pyvista may crash.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pyvista
from matplotlib.patches import Patch

from ..panels import MAP_STYLE, cropped, panels
from .solids import add_lines, rendering, solid_of

_VIEW = (4.6, 3.6)  # width and height of a view [inches]
_VIEWS = {"from above": (0.55, -1.0, 0.8), "from below": (0.55, -1.0, -0.8)}
_ORDER = [k for first in (0, 1) for k in range(first, 20, 2) if k not in (14, 15)]
"""Colours of a palette of pairs without grey, the strong ones first."""
_GREY = "whitesmoke"
"""Colour of faces without a name."""
_LINES = "dimgray"
_LEGEND_COLUMNS = 5


def draw_mesh(source: Path, path: Path) -> None:
    """Draw each body in a row.

    Parameters
    ----------
    source : Path
        ``.npz`` with ``bodies``, ``surfaces``, and ``points_B``, ``facets_B`` and ``surface_B`` of
        body B, see `thermowear.geometry.mesh.mixed`.
    path : Path
    """
    with np.load(source, allow_pickle=False) as file:
        arrays = dict(file)
    bodies, surfaces = (arrays[key].tolist() for key in ("bodies", "surfaces"))
    palette = mpl.colormaps["tab20"].colors  # type: ignore[attr-defined]
    colors = {k: palette[_ORDER[k % len(_ORDER)]] for k in range(len(surfaces))}
    options: dict[str, Any] = {"style": MAP_STYLE, "crop": True, "margin": (0.0, 0.6)}
    with panels(path, 2 * len(bodies), 2, _VIEW, **options) as (figure, axes):
        for b, body in enumerate(bodies):
            points, facets, surface = (
                arrays[f"{name}_{b}"] for name in ("points", "facets", "surface")
            )
            for axis, (side, camera) in zip(axes[b], _VIEWS.items(), strict=True):
                axis.imshow(_view(1e3 * points, facets, surface, colors, camera))
                axis.set_axis_off()
                axis.set_title(f"{body} {side}, {len(facets)} facets", fontsize=10)
        handles = [Patch(color=colors[k], label=name) for k, name in enumerate(surfaces)]
        handles.append(Patch(facecolor=_GREY, edgecolor=_LINES, label="without a name"))
        figure.legend(handles=handles, loc="outside lower center", ncols=_LEGEND_COLUMNS)


def _view(
    points: np.ndarray, facets: np.ndarray, surface: np.ndarray, colors: dict, camera
) -> np.ndarray:
    """Pixels of a body with coloured surfaces."""
    corners = np.column_stack([np.full(len(facets), facets.shape[1]), facets])
    whole = pyvista.PolyData(points, corners.ravel())
    with rendering(camera) as (plotter, picture):
        for k in np.unique(surface):
            part = pyvista.PolyData(points, corners[surface == k].ravel())
            plotter.add_mesh(
                part,
                color=colors.get(int(k), _GREY),
                show_edges=True,
                edge_color=_LINES,
                ambient=0.6,
                diffuse=0.4,
            )
        add_lines(plotter, solid_of([whole]).edges)
    return cropped(picture[0])

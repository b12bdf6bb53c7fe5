"""Panels of 3D models: clipped bodies, and maps of their contact face."""

from __future__ import annotations

import numpy as np
import pyvista
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from ..maps import COLORS, triangulated
from ..solids import PIXELS, cut, render
from ..windows import common_limits, whole
from .scene import ScenePanel
from .states import Film, FrameState, shown_field


class Solid:
    """Panel with the undeformed bodies and a fixed camera.

    Parameters
    ----------
    film : Film
    """

    shape = PIXELS[1] / PIXELS[0]

    def __init__(self, film: Film):
        self._hot = film.hot
        self.colors = "inferno" if film.hot else "viridis"
        y = film.states[-1].interface.drawn("y")
        self._middle = float((y.min() + y.max()) / 2)
        surfaces = (self._surfaces(state) for state in film.states)
        self.limits = common_limits(
            [np.concatenate([part["shown"] for part in parts]) for parts in surfaces]
        )

    def prepare(self, figure, axis) -> None:
        """Draw the static elements."""
        axis.set_axis_off()
        figure.colorbar(
            ScalarMappable(Normalize(*self.limits), self.colors),
            ax=axis,
            label=shown_field(self._hot).axis,
            shrink=0.8,
        )
        blank = np.full((PIXELS[1], PIXELS[0], 3), 255, dtype=np.uint8)
        self._image = axis.imshow(blank, interpolation="antialiased")

    def show(self, state: FrameState) -> None:
        """Update the panel to a state."""
        self._image.set_data(render(self._surfaces(state), "shown", self.colors, self.limits))

    def _surfaces(self, state: FrameState) -> list:
        grid = pyvista.read(state.file)
        shown = shown_field(self._hot)
        grid.points = 1e3 * grid.points
        grid["shown"] = shown.drawn(grid[shown.header])
        return cut(grid, self._middle)


class FaceMap:
    """Map of a quantity over the contact face with one colour range for all frames."""

    def __init__(self, film: Film, name: str):
        self._name = name
        highest = max(float(state.interface.drawn(name).max()) for state in film.states)
        self._limits = (0.0, highest)
        self._shown = film.states[-1].interface.quantities
        x, y = map(film.states[0].interface.drawn, "xy")
        self._window = whole(np.stack([x, y], axis=1))
        self._drawn: list = []

    def prepare(self, figure, axis) -> None:
        """Draw the static elements."""
        self._axis = axis
        axis.set_aspect("equal")
        axis.set_xlim(self._window[:2])
        axis.set_ylim(self._window[2:])
        axis.grid(visible=False)
        axis.set_xlabel(self._shown["x"].axis)
        axis.set_ylabel(self._shown["y"].axis)
        scale = ScalarMappable(Normalize(*self._limits), COLORS[self._name.split("_")[0]])
        figure.colorbar(scale, ax=axis, label=self._shown[self._name].wrapped)

    def show(self, state: FrameState) -> None:
        """Update the panel to a state."""
        while self._drawn:
            self._drawn.pop().remove()
        x, y, values = map(state.interface.drawn, ("x", "y", self._name))
        colors, norm = COLORS[self._name.split("_")[0]], Normalize(*self._limits)
        self._drawn.append(
            self._axis.tripcolor(
                triangulated(x, y), values, shading="gouraud", cmap=colors, norm=norm
            )
        )


def face_maps(film: Film) -> list[ScenePanel]:
    """Maps of the pressure, and of the wear depth of the body with the deeper wear."""
    depths = {name: film.states[-1].interface[name].max() for name in ("wear_1", "wear_2")}
    deepest = max(depths, key=lambda name: depths[name])
    return [
        FaceMap(film, name)
        for name in ("pressure", deepest)
        if name not in depths or depths[name] > 0
    ]

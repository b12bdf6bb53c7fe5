"""Panels of 3D models: clipped bodies, and maps of their contact face."""

from __future__ import annotations

import numpy as np
import pyvista
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from ...quantities import INTERFACE
from ..maps import COLORS, triangulated
from ..solids import PIXELS, cut, render
from ..windows import common_limits, whole
from .scene import ScenePanel
from .states import Film, FrameState, field_of


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
        y = INTERFACE["y"].drawn(film.states[-1].interface["y"])
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
            label=field_of(self._hot)[0],
            shrink=0.8,
        )
        blank = np.full((PIXELS[1], PIXELS[0], 3), 255, dtype=np.uint8)
        self._image = axis.imshow(blank, interpolation="antialiased")

    def show(self, state: FrameState) -> None:
        """Update the panel to a state."""
        self._image.set_data(render(self._surfaces(state), "shown", self.colors, self.limits))

    def _surfaces(self, state: FrameState) -> list:
        grid = pyvista.read(state.file)
        _, name, scale, offset = field_of(self._hot)
        grid.points = 1e3 * grid.points
        grid["shown"] = scale * grid[name] + offset
        return cut(grid, self._middle)


class FaceMap:
    """Map of a quantity over the contact face with one colour range for all frames."""

    def __init__(self, film: Film, name: str):
        self._name = name
        values = [state.interface[name] for state in film.states]
        self._limits = (0.0, max(float(INTERFACE[name].drawn(v).max()) for v in values))
        x, y = (INTERFACE[axis].drawn(film.states[0].interface[axis]) for axis in "xy")
        self._window = whole(np.stack([x, y], axis=1))
        self._drawn: list = []

    def prepare(self, figure, axis) -> None:
        """Draw the static elements."""
        self._axis = axis
        axis.set_aspect("equal")
        axis.set_xlim(self._window[:2])
        axis.set_ylim(self._window[2:])
        axis.grid(visible=False)
        axis.set_xlabel(INTERFACE["x"].axis)
        axis.set_ylabel(INTERFACE["y"].axis)
        scale = ScalarMappable(Normalize(*self._limits), COLORS[self._name.split("_")[0]])
        figure.colorbar(scale, ax=axis, label=INTERFACE[self._name].axis.replace(" [", "\n["))

    def show(self, state: FrameState) -> None:
        """Update the panel to a state."""
        while self._drawn:
            self._drawn.pop().remove()
        x, y, values = (INTERFACE[q].drawn(state.interface[q]) for q in ("x", "y", self._name))
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

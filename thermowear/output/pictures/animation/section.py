"""Section of 2D bodies with one colour range for all frames (matplotlib)."""

from __future__ import annotations

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.tri import Triangulation
from scipy.spatial import cKDTree

from ..windows import Extent, around_contact, common_limits, is_small, whole, within
from .states import Film, FrameState, read_fields, shown_field

_SCALE = 0.05  # width of the colour bar relative to the panel
_SAME = 1e-5  # tolerance for identical points, relative to the size of the bodies


class SectionPanel:
    """Panel with deformed 2D bodies, body 1 drawn behind body 2.

    The material worn off body 1 is thus hidden.

    Parameters
    ----------
    film : Film
    """

    def __init__(self, film: Film):
        self._hot = film.hot
        self._fields = {id(state): read_fields(state, film.hot) for state in film.states}
        self.window = _window(film, np.concatenate([f[0] for f in self._fields.values()]))
        seen = [
            values[_inside(points, self.window)] for points, _, _, values in self._fields.values()
        ]
        self.limits = common_limits(seen)
        self._over = max(values.max() for values in seen) > self.limits[1] * (1 + 1e-9)
        self.colors = "inferno" if film.hot else "viridis"
        self._axes = [film.states[-1].interface.quantities[name].axis for name in "xy"]
        self._drawn: list = []

    @property
    def shape(self) -> float:
        """Height over width."""
        left, right, lower, upper = self.window
        return (upper - lower) / (right - left)

    def prepare(self, figure, axis) -> None:
        """Draw the static elements."""
        self._axis = axis
        axis.set_xlim(self.window[:2])
        axis.set_ylim(self.window[2:])
        axis.set_aspect("equal", anchor="W")
        axis.set_xlabel(self._axes[0])
        axis.set_ylabel(self._axes[1])
        axis.grid(visible=False)
        figure.colorbar(
            ScalarMappable(Normalize(*self.limits), self.colors),
            cax=axis.inset_axes([1.03, 0.0, _SCALE * min(1.0, self.shape), 1.0]),
            label=shown_field(self._hot).axis,
            extend="max" if self._over else "neither",
        )

    def show(self, state: FrameState) -> None:
        """Update the panel to a state."""
        while self._drawn:
            self._drawn.pop().remove()
        points, triangles, body, values = self._fields[id(state)]
        seen = _near(points, self.window)[triangles].any(axis=1)
        for number in (1, 2):
            own = triangles[(body == number) & seen]
            self._drawn += [
                self._axis.tripcolor(
                    Triangulation(points[:, 0], points[:, 1], own),
                    values,
                    shading="gouraud",
                    cmap=self.colors,
                    norm=Normalize(*self.limits),
                    zorder=number,
                ),
                self._axis.add_collection(
                    LineCollection(
                        points[outline(points, own)],
                        colors="black",
                        linewidths=0.9,
                        snap=False,
                        zorder=number + 0.5,
                    ),
                    autolim=False,
                ),
            ]


def outline(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Boundary edges of triangles, shape (k, 2).

    Triangles of different cells share no points, so that edges are identified by their midpoints.
    """
    edges = np.concatenate([triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])])
    middles = points[edges].mean(axis=1)
    apart = _SAME * np.ptp(points, axis=0).max()
    beside, _ = cKDTree(middles).query(middles, k=2)
    return edges[beside[:, 1] > apart]


def _inside(points: np.ndarray, window: Extent) -> np.ndarray:
    (x, y), (left, right, lower, upper) = points.T, window
    return (x >= left) & (x <= right) & (y >= lower) & (y <= upper)


def _near(points: np.ndarray, window: Extent) -> np.ndarray:
    """Mask as of `_inside`, with a margin of the size of the window."""
    left, right, lower, upper = window
    wide, tall = right - left, upper - lower
    return _inside(points, (left - wide, right + wide, lower - tall, upper + tall))


def _window(film: Film, points: np.ndarray) -> Extent:
    """Window of the whole bodies, or around a small contact."""
    contact = around_contact([state.interface for state in film.states])
    if contact is not None and is_small(contact, points):
        return within(contact, points)
    return whole(points)

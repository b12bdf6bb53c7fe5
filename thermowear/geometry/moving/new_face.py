"""Volume-preserving redivision of a worn face on a spline through its nodes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import scipy

from ..mesh.nodes import chord_lengths
from .moved import enclosed

_STEPS = 6
"""Newton iterations on the volume, which is nearly proportional to the offset of the face."""


@dataclass(frozen=True)
class NewFace:
    """Worn face before and after redivision; lengths are chord lengths [m].

    Attributes
    ----------
    former, edges : ndarray, shape (n, order + 1, 2)
        Nodes of its edges in order along it, before and after [m].
    former_place, place : ndarray, shape (n_nodes,)
        Lengths along the former face up to its nodes, and up to the new ones.
    """

    former: np.ndarray
    edges: np.ndarray
    former_place: np.ndarray
    place: np.ndarray

    def on_curve(self, number: np.ndarray) -> np.ndarray:
        """Points (n, 2) of the smooth curve of the face, by edge number plus parameter [m]."""
        after = np.arange(len(self.place)) / self._order
        return curve(self.former_place, _nodes(self.former))(np.interp(number, after, self.place))

    def at(self, former: np.ndarray) -> np.ndarray:
        """New edge number plus parameter of points given by those on the former face."""
        before, after = (np.arange(len(p)) / self._order for p in (self.former_place, self.place))
        return np.interp(np.interp(former, before, self.former_place), self.place, after)

    def carried(self, values: np.ndarray) -> np.ndarray:
        """Interpolate nodal values (n_nodes, …) from the former nodes to the new ones."""
        columns = values.reshape(len(values), -1).T
        found = [np.interp(self.place, self.former_place, column) for column in columns]
        return np.column_stack(found).reshape(-1, *values.shape[1:])

    def cut(self, edges: np.ndarray, ends: np.ndarray) -> NewFace:
        """Copy with other edges, whose ends are numbers and fractions of the present ones."""
        count = np.arange(len(edges) * self._order + 1) / self._order
        number = np.interp(count, np.arange(len(ends)), ends)
        place = np.interp(number, np.arange(len(self.place)) / self._order, self.place)
        return replace(self, edges=edges, place=place)

    @property
    def sizes(self) -> np.ndarray:
        """Lengths of the new edges, shape (n,) [m]."""
        return np.diff(chord_lengths(_nodes(self.edges))[:: self._order])

    @property
    def _order(self) -> int:
        return self.edges.shape[1] - 1


def divided(
    nodes: np.ndarray,
    order: int,
    sizes: np.ndarray,
    factor: Callable[[np.ndarray], np.ndarray],
) -> NewFace:
    """Divide a face into edges in proportion to the requested lengths.

    Parameters
    ----------
    nodes : ndarray, shape (n_nodes, 2)
        Nodes in order along the face [m].
    order : int
        Order of its edges.
    sizes : ndarray, shape (n_edges,)
        Requested lengths of its present edges [m].
    factor : callable
        Factor from area to volume at points of shape (n, 2); the volume behind the face is kept.
    """
    place = chord_lengths(nodes)
    wanted = np.concatenate([[0.0], np.cumsum(np.diff(place[::order]) / sizes)])
    number = np.linspace(0.0, wanted[-1], max(1, round(wanted[-1])) + 1)
    ends = np.interp(number, wanted, place[::order])
    count = len(ends) - 1
    new = np.interp(np.arange(count * order + 1) / order, np.arange(count + 1), ends)
    through = curve(place, nodes)
    found, slope = through(new), through.derivative()(new)
    found[[0, -1]] = nodes[[0, -1]]
    across = np.column_stack([-slope[:, 1], slope[:, 0]])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    across[[0, -1]] = 0.0
    former = _edges(nodes, order)
    due, far = enclosed(former, factor), 1e-3 * place[-1] / count
    per_way = enclosed(_edges(found + far * across, order), factor)
    per_way = (per_way - enclosed(_edges(found - far * across, order), factor)) / (2 * far)
    for _ in range(_STEPS):
        found = found + (due - enclosed(_edges(found, order), factor)) / per_way * across
    return NewFace(former, _edges(found, order), place, new)


def curve(place: np.ndarray, nodes: np.ndarray) -> scipy.interpolate.Akima1DInterpolator:
    """Modified Akima interpolation through nodes (n, 2) at chord lengths `place`.

    It does not overshoot at the corner where the worn part of a face begins.
    """
    return scipy.interpolate.Akima1DInterpolator(place, nodes, method="makima")


def _edges(nodes: np.ndarray, order: int) -> np.ndarray:
    """Nodes edge by edge, shape (n_edges, order + 1, 2)."""
    first = np.arange(0, len(nodes) - 1, order)
    return nodes[first[:, None] + np.arange(order + 1)]


def _nodes(edges: np.ndarray) -> np.ndarray:
    """Inverse of `_edges`."""
    return np.concatenate([edges[:, :-1].reshape(-1, 2), edges[-1:, -1]])

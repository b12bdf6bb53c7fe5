"""Worn profile of a body on which the carrying one reciprocates, in sections and in space.

In a section the depth is piecewise linear on a separate grid along the face, as the contact points
differ in every position. A position represents a segment of the stroke: the depth at a point is the
mean over the segment. Worn depth is distributed to the nodes with the same weights, which conserves
volume.

In space it is piecewise bilinear on rows along the stroke: each row reaches from the first to the
last place that the carrying face passes over there. Rows of a face with parallel ends are those of
a section.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import scipy
import scipy.sparse as sp

from ...errors import CaseError
from ...lagrange import corner_nodes, edge_nodes
from ..faces.face import Surface
from ..search.pairing import Contacts, Pairing

STEPS = 16
"""Samples of the mean over a segment of the stroke."""
_LEAST_ACROSS = 0.1
"""Least sine of the angle between the stroke and the normal of a face that it slides along."""
_INSIDE = 1e-9
"""Distance of the outer rows from the ends of the face, relative to its breadth."""
_STROKE = np.array([1.0, 0.0, 0.0])


@dataclass(frozen=True)
class FaceOutline:
    """Extent of a face along x, linear between rows.

    Attributes
    ----------
    across : ndarray, shape (3,)
        Unit vector across the stroke and the mean normal of the swept face.
    rows : ndarray, shape (n_rows,)
        Positions of the rows along `across`, equally spaced [m].
    starts, ends : ndarray, shape (n_rows,)
        x of the ends of the face in each row [m].
    """

    across: np.ndarray
    rows: np.ndarray
    starts: np.ndarray
    ends: np.ndarray

    def coordinates(self, points: np.ndarray, reach: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Row, and part of the way from the start of the row to its end, at points (n, 3).

        Parameters
        ----------
        points : ndarray, shape (n, 3) [m]
        reach : float
            Distance that the face moves in either direction [m].
        """
        row = np.interp(points @ self.across, self.rows, np.arange(len(self.rows)))
        start, end = (np.interp(row, np.arange(len(row_x)), row_x) for row_x in self._ends(reach))
        length = np.where(end > start, end - start, 1.0)
        return row, np.clip((points[:, 0] - start) / length, 0.0, 1.0)

    def areas(self, reach: float = 0.0) -> np.ndarray:
        """Projected areas of the hat functions of the rows, shape (n_rows,) [m²]."""
        start, end = self._ends(reach)
        cell, length = np.diff(self.rows), end - start
        areas = np.zeros(len(self.rows))
        areas[:-1] += cell * (length[:-1] / 3 + length[1:] / 6)
        areas[1:] += cell * (length[:-1] / 6 + length[1:] / 3)
        return areas

    def _ends(self, reach: float) -> tuple[np.ndarray, np.ndarray]:
        return self.starts - reach, self.ends + reach


@dataclass(frozen=True)
class SweptSurface:
    """Grid of the worn profile over the swept part of a face.

    Attributes
    ----------
    outline : FaceOutline
        Carrying face in the middle of the stroke.
    reach : float
        Length of the stroke in either direction [m].
    columns : int
        Number of nodes of a row.
    level : float
        Height of the face over the origin along ``x × across`` [m].
    areas : ndarray, shape (n_rows * columns,)
        Area of each node, row by row [m²].
    """

    outline: FaceOutline
    reach: float
    columns: int
    level: float
    areas: np.ndarray

    @cached_property
    def nodes(self) -> np.ndarray:
        """Coordinates of the nodes, shape (n_nodes, 3) [m]."""
        of, part = self.outline, np.linspace(0.0, 1.0, self.columns)
        starts, ends = of.starts - self.reach, of.ends + self.reach
        x = (starts[:, None] + (ends - starts)[:, None] * part).ravel()
        across = np.repeat(of.rows, self.columns)[:, None] * of.across
        return x[:, None] * _STROKE + across + self.level * np.cross(_STROKE, of.across)

    def hats(self, pairing: Pairing, length: float = 0.0) -> sp.csr_array:
        """Values of the hat functions at contact points, see `StrokeGrid.hats`."""
        points = pairing.opposite.points
        if length == 0.0:
            return self._values(points)
        steps = length * ((np.arange(STEPS) + 0.5) / STEPS - 0.5)
        first, *others = (self._values(points + step * _STROKE) for step in steps)
        return sum(others, first) / STEPS

    def inner(self, pairing: Pairing, offset: float, part: float) -> np.ndarray:
        """Mask of the contact points away from the ends of the track and of the moved face.

        Parameters
        ----------
        pairing : Pairing
        offset : float
            Displacement of the carrying face [m].
        part : float
            Part of the face and of the track that is taken, in both directions.
        """
        on_1 = self.outline.coordinates(pairing.carrying.points - offset * _STROKE)
        on_2 = self.outline.coordinates(pairing.opposite.points, self.reach)
        last = len(self.outline.rows) - 1
        places = (on_1[0] / last, on_1[1], on_2[1])
        return np.all([np.abs(2 * place - 1) <= part for place in places], axis=0)

    def _values(self, points: np.ndarray) -> sp.csr_array:
        row, part = self.outline.coordinates(points, self.reach)
        first, beyond = _cells(row, len(self.outline.rows))
        before, along = _cells(part * (self.columns - 1), self.columns)
        node = first * self.columns + before
        nodes = node[:, None] + np.array([0, 1, self.columns, self.columns + 1])
        values = [(1 - beyond) * (1 - along), (1 - beyond) * along]
        values += [beyond * (1 - along), beyond * along]
        starts = 4 * np.arange(len(points) + 1)
        shape = len(points), len(self.areas)
        return sp.csr_array((np.column_stack(values).ravel(), nodes.ravel(), starts), shape)


def swept_surface(pairing: Pairing, reach: float, spacing: tuple[float, float]) -> SweptSurface:
    """Build the grid on the part of a face that the carrying one passes over.

    Areas are those of the contact points: a pressure that is uniform across the stroke wears all
    rows alike.

    Parameters
    ----------
    pairing : Pairing
        Contact points in the middle of the stroke.
    reach : float
        Length of the stroke in either direction [m].
    spacing : tuple of float
        Largest cell size along and across the stroke [m].

    Raises
    ------
    CaseError
        If the stroke is normal to the face.
    """
    second = pairing.opposite
    normals = second.face.normals(second.facet, second.t)
    mean = pairing.weights @ normals
    pole = mean / np.linalg.norm(mean)
    across = np.cross(_STROKE, pole)
    if np.linalg.norm(across) < _LEAST_ACROSS:
        raise CaseError(
            f"motion: reciprocating along x is normal to the contact face "
            f"{pairing.carrying.face.name}; it must slide along it"
        )
    across = across / np.linalg.norm(across) * np.sign(across[np.abs(across).argmax()])
    outline = _outline(pairing, across, spacing[1])
    longest = float((outline.ends - outline.starts).max()) + 2 * reach
    columns = max(1, int(np.ceil(longest / spacing[0] - 1e-9))) + 1
    within = np.full(columns, 1.0 / (columns - 1))
    within[[0, -1]] /= 2
    rows = outline.areas(reach) * _covered(pairing, outline, pole, np.abs(normals @ pole))
    level = float(pairing.weights @ pairing.opposite.points @ np.cross(_STROKE, across))
    areas = np.outer(rows, within).ravel()
    return SweptSurface(outline, reach, columns, level / pairing.weights.sum(), areas)


def _covered(
    pairing: Pairing, outline: FaceOutline, pole: np.ndarray, slopes: np.ndarray
) -> np.ndarray:
    """Area of the swept face under the quadrature points over that of the outline, (n_rows,).

    Parameters
    ----------
    pairing : Pairing
    outline : FaceOutline
    pole : ndarray, shape (3,)
        Unit normal of the plane of the outline.
    slopes : ndarray, shape (n,)
        Cosine between the pole and the normal of the swept face at the contact points.
    """
    face, pieces = pairing.carrying.face, pairing.pieces
    at = pieces.facet, pieces.t
    weights = pieces.weight * face.stretch(*at) * np.abs(face.normals(*at) @ pole)
    weights = weights / slopes[pieces.point]
    row, _ = outline.coordinates(face.points(*at))
    first, beyond = _cells(row, len(outline.rows))
    found = np.zeros(len(outline.rows))
    np.add.at(found, first, weights * (1 - beyond))
    np.add.at(found, first + 1, weights * beyond)
    known = outline.areas()
    return np.divide(found, known, out=np.ones_like(known), where=found > 0.0)


def _outline(pairing: Pairing, across: np.ndarray, spacing: float) -> FaceOutline:
    """Outline of the facets that have contact points."""
    face = pairing.carrying.face
    assert isinstance(face, Surface)
    lines = _border(face, np.unique(pairing.pieces.facet))
    place, x = lines @ across, lines[..., 0]
    low, high = place.min(), place.max()
    count = max(1, int(np.ceil((high - low) / spacing - 1e-9)))
    rows = np.linspace(low, high, count + 1)
    level = np.clip(rows, *(low + (high - low) * np.array([_INSIDE, 1 - _INSIDE])))[:, None]
    first, last, x_1, x_2 = place[:, :-1], place[:, 1:], x[:, :-1], x[:, 1:]
    first, last, x_1, x_2 = (values.ravel() for values in (first, last, x_1, x_2))
    crossed = (first < level) != (last < level)
    part = np.divide(level - first, last - first, out=np.zeros(crossed.shape), where=crossed)
    at = x_1 + part * (x_2 - x_1)
    starts, ends = np.where(crossed, at, np.inf), np.where(crossed, at, -np.inf)
    return FaceOutline(across, rows, starts.min(axis=1), ends.max(axis=1))


def _border(face: Surface, facets: np.ndarray) -> np.ndarray:
    """Nodes along the outer edges of some facets, shape (n_edges, order + 1, 3)."""
    edges, number = edge_nodes(face.order, face.kind), np.zeros(face.nodes.shape[1], dtype=int)
    number[corner_nodes(face.order, face.kind)] = np.arange(face.corners.shape[1])
    ends = np.sort(face.corners[facets][:, number[edges[:, [0, -1]]]], axis=2).reshape(-1, 2)
    _, edge, count = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
    lines = face.nodes[facets][:, edges].reshape(len(ends), -1, 3)
    return lines[count[edge.ravel()] == 1]


def _cells(place: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Cells of places on a line of nodes 0, 1, …, and the part of the way through each."""
    first = np.minimum(place.astype(int), count - 2)
    return first, place - first


@dataclass(frozen=True)
class StrokeGrid:
    """Grid of the worn profile along the face that does not carry the contact points.

    Attributes
    ----------
    position : ndarray, shape (n_nodes,)
        Arc length along the face [m].
    areas : ndarray, shape (n_nodes,)
        Area of each node [m²].
    """

    position: np.ndarray
    areas: np.ndarray

    def hats(self, pairing: Pairing, length: float = 0.0) -> np.ndarray:
        """Values of the hat functions at the contact points of a pairing, (n, n_nodes).

        Parameters
        ----------
        pairing : Pairing
        length : float
            Length of the segment, centred at the points, over which means are taken [m].
        """
        places = pairing.opposite.position
        if length == 0.0:
            return hat_functions(self.position, places)
        steps = length * ((np.arange(STEPS) + 0.5) / STEPS - 0.5)
        return np.mean([hat_functions(self.position, places + step) for step in steps], axis=0)


def hat_functions(knots: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Hat functions of increasing knots at places, constant beyond the ends, (n, n_knots)."""
    padded = np.concatenate([knots[:1], knots, knots[-1:]])
    return scipy.interpolate.BSpline.design_matrix(
        np.clip(places, knots[0], knots[-1]), padded, 1
    ).toarray()


@dataclass(frozen=True)
class StrokeGrids:
    """Grids of the worn profiles of the swept bodies of all interfaces, one after the other.

    Attributes
    ----------
    each : tuple of StrokeGrid or SweptSurface
    strokes : tuple of float
        Amplitude at each interface relative to that given.
    """

    each: tuple[StrokeGrid | SweptSurface, ...]
    strokes: tuple[float, ...]

    @cached_property
    def areas(self) -> np.ndarray:
        """Areas of the nodes of all grids [m²]."""
        return np.concatenate([grid.areas for grid in self.each])

    @cached_property
    def ranges(self) -> tuple[slice, ...]:
        """Range of the nodes of each grid."""
        ends = np.cumsum([0, *(len(grid.areas) for grid in self.each)])
        return tuple(slice(int(a), int(b)) for a, b in pairwise(ends))

    def hats(self, contacts: Contacts, length: float = 0.0) -> sp.csr_array:
        """Values of the hat functions at all contact points, shape (n, n_nodes).

        Parameters
        ----------
        contacts : Contacts
        length : float
            Length of the segment of the given stroke, see `StrokeGrid.hats` [m].
        """
        parts = zip(self.each, contacts.each, self.strokes, strict=True)
        values = [sp.csr_array(grid.hats(p, abs(s) * length)) for grid, p, s in parts]
        return sp.block_diag(values, format="csr")


def track(
    pairings: Sequence[Pairing], lengths: Sequence[float], spacing: float, thickness: float
) -> StrokeGrid:
    """Build a uniform grid on the swept part of the face.

    Parameters
    ----------
    pairings : sequence of Pairing
        Contact points in all positions.
    lengths : sequence of float
        Lengths of the segments of the stroke that they represent [m].
    spacing : float
        Largest cell size [m].
    thickness : float
        Thickness of the bodies [m].
    """
    placed = [
        (p.opposite.position, length / 2) for p, length in zip(pairings, lengths, strict=True)
    ]
    first = min(s.min() - half for s, half in placed)
    last = max(s.max() + half for s, half in placed)
    cells = max(1, int(np.ceil((last - first) / spacing - 1e-9)))
    areas = np.full(cells + 1, thickness * (last - first) / cells)
    areas[[0, -1]] /= 2
    return StrokeGrid(np.linspace(first, last, cells + 1), areas)

"""Curved facets of a contact face: geometry, and the facets that are close to points.

Where a facet is curved by more than a fraction of its width, its plane approximation is closer to
points of neighbouring facets than to its own ones. Points all over the facets bound the distance
instead: each facet that can be the closest one is a candidate.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...bulk.bodies import BodyMesh
from ...compat import geometry_dofmap
from ...errors import CaseError
from ...lagrange import corner_nodes, lattice, lebesgue, lobatto, on_lattice, order_of
from .normals import across, corner_corrections, smooth_normals


class PartValues(NamedTuple):
    """Values by part of a body; without any they are equal for all.

    Attributes
    ----------
    softness : dict of str to float
        ``(1 - ν²) / E``, or the wear rate that takes its place; only ratios count.
    group : dict of str to int
        Group of equally wearing materials.
    """

    softness: dict[str, float] = {}
    group: dict[str, int] = {}


EQUAL = PartValues()
"""Equal values of all parts."""


_NEAREST = 12
"""Number of facets of each octave that are candidates for the closest one, by their centres."""


class FacetTree:
    """Centres of facets in space, in one tree for each octave of their radii.

    Parameters
    ----------
    nodes : ndarray, shape (n_facets, n_nodes, 3) [m]

    Attributes
    ----------
    radii : ndarray, shape (n_facets,)
        Radii of the spheres round the facets [m].
    """

    def __init__(self, nodes: np.ndarray):
        centres = nodes.mean(axis=1)
        self.radii = np.linalg.norm(nodes - centres[:, None], axis=2).max(axis=1)
        octave = np.floor(np.log2(self.radii / self.radii.min())).astype(int)
        groups = [np.flatnonzero(octave == k) for k in np.unique(octave)]
        self._trees = [(g, cKDTree(centres[g]), float(self.radii[g].max())) for g in groups]

    def nearest(self, points: np.ndarray) -> np.ndarray:
        """Facets of each octave with the nearest centres to points, (n, n_candidates)."""
        found = [
            alike[tree.query(points, np.arange(1, min(_NEAREST, len(alike)) + 1))[1]]
            for alike, tree, _ in self._trees
        ]
        return np.hstack(found)

    def touching(self, centres: np.ndarray, radii: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pairs of a sphere and a facet whose own sphere overlaps it, in order of both."""
        spheres, facets = [], []
        for alike, tree, largest in self._trees:
            found = tree.query_ball_point(centres, radii + largest)
            counts = np.array([len(part) for part in found])
            spheres.append(np.repeat(np.arange(len(centres)), counts))
            facets.append(alike[np.concatenate(found).astype(np.int64)])
        sphere, facet = np.concatenate(spheres), np.concatenate(facets)
        order = np.lexsort((facet, sphere))
        return sphere[order], facet[order]


_FLATNESS_TOLERANCE = 1e-9
"""Largest deviation of a facet treated as a parallelogram, relative to its shorter side."""


@dataclass(frozen=True)
class FlatFacets:
    """Affine maps from the parameters that approximate the facets.

    Attributes
    ----------
    origin : ndarray, shape (n_facets, gdim) [m]
    sides : ndarray, shape (n_facets, dim, gdim)
        Tangents along the parameters [m].
    inverse : ndarray, shape (n_facets, dim, gdim)
        Parameters per coordinate [1/m].
    """

    origin: np.ndarray
    sides: np.ndarray
    inverse: np.ndarray

    def points(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Coordinates at parameters (..., dim) of facets (...), shape (..., gdim) [m]."""
        return self.origin[facet] + np.einsum("...k,...ki->...i", t, self.sides[facet])

    def parameters(self, facet: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Parameters of points (..., gdim) projected on facets (...), shape (..., dim)."""
        return np.einsum("...ki,...i->...k", self.inverse[facet], points - self.origin[facet])


@dataclass(frozen=True, eq=False)
class FacetSet(ABC):
    """Curved facets with parameters t that run 0…1, replicated on all ranks.

    Attributes
    ----------
    nodes : ndarray, shape (n_facets, n_nodes, gdim) [m]
        Geometry nodes of each facet, at equal steps of the parameters, in the order of
        `lagrange.lattice`.
    outward : ndarray, shape (n_facets,)
        Sign of the outward normal: +1 along the tangent turned clockwise or the cross product of
        both tangents, -1 opposite to it.
    rank, cell, local_facet : ndarray of int, shape (n_facets,)
        Rank that owns the cell of the facet, local cell index, and local facet index.
    body : int
        Index of the body in `bulk.bodies.Bodies`.
    kind : str
        ``"interval"`` in a section, ``"quadrilateral"`` or ``"triangle"`` in space.
    softness : float or ndarray, shape (n_facets,)
        ``(1 - ν²) / E`` of the material at each facet [1/Pa]; only its ratio to that of the other
        face matters.
    name : str
        Name of the surface.
    wears : bool
        True if the softness is that of wear, see `common_face`.
    group : int or ndarray of int, shape (n_facets,)
        Group of equally wearing materials that each facet belongs to; pressures may jump between
        them.
    """

    nodes: np.ndarray
    outward: np.ndarray
    rank: np.ndarray
    cell: np.ndarray
    local_facet: np.ndarray
    _: KW_ONLY
    kind: str = "interval"
    softness: float | np.ndarray = 1.0
    name: str = "the contact face"
    wears: bool = False
    body: int = 0
    group: int | np.ndarray = 0

    @property
    @abstractmethod
    def corner_numbers(self) -> np.ndarray:
        """Corner numbers shared by adjacent facets, shape (n_facets, n_corners)."""

    @abstractmethod
    def nearby(self, points: np.ndarray) -> np.ndarray:
        """Candidates for the closest facet to points (n, gdim), shape (n, n_candidates)."""

    def sampled_nearby(
        self, points: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
        """Candidates where `nearby` can miss the closest facet, see `SampledFacets`; else None."""
        return None

    def points(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Coordinates at parameters t of facets, shape (n, gdim) [m]."""
        from_first = self.shape_functions(t)[0][:, None] @ self._shape[facet]
        return self.nodes[facet, 0] + from_first[:, 0]

    def tangents(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Derivatives of the coordinates along the parameters, shape (n, dim, gdim) [m]."""
        return self.shape_functions(t, 1)[1:].swapaxes(0, 1) @ self._shape[facet]

    def points_and_tangents(
        self, facet: np.ndarray, t: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Results of `points` and `tangents`."""
        both = self.shape_functions(t, 1).swapaxes(0, 1) @ self._shape[facet]
        return self.nodes[facet, 0] + both[:, 0], both[:, 1:]

    def shape_functions(self, t: np.ndarray, derivatives: int = 0) -> np.ndarray:
        """Lagrange polynomials of the nodes and their derivatives, see `lagrange.on_lattice`."""
        return on_lattice(self.order, t, derivatives, self.kind)

    def normals(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Outward unit normals, shape (n, gdim)."""
        normal = across(self.tangents(facet, t)) * self.outward[facet, None]
        return normal / np.linalg.norm(normal, axis=1, keepdims=True)

    def smooth_normals(self, facet: np.ndarray, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Normals that are continuous across facets, and their derivatives along t.

        Shapes (n, gdim) and (n, gdim - 1, gdim).
        """
        t = t.reshape(len(t), self.dim)
        return smooth_normals(self.kind, self._shape, self.outward, self._corrections, facet, t)

    def softness_at(self, facet: np.ndarray) -> np.ndarray:
        """Softness at facets, shape (n,) [1/Pa]."""
        return np.broadcast_to(self.softness, len(self.nodes))[facet]

    def group_at(self, facet: np.ndarray) -> np.ndarray:
        """Group of materials at facets, shape (n,)."""
        return np.broadcast_to(self.group, len(self.nodes))[facet]

    def stretch(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Length per parameter or area per parameter area, shape (n,) [m or m²]."""
        return np.linalg.norm(across(self.tangents(facet, t)), axis=1)

    @property
    def dim(self) -> int:
        """Number of parameters of a facet."""
        return 1 if self.kind == "interval" else 2

    @property
    def measure(self) -> float:
        """Length or area of a facet in parameters."""
        return 0.5 if self.kind == "triangle" else 1.0

    @property
    def order(self) -> int:
        """Order of the geometry."""
        return order_of(self.kind, self.nodes.shape[1])

    @cached_property
    def sizes(self) -> np.ndarray:
        """Lengths or areas of the facets, shape (n_facets,) [m or m²]."""
        return self.integrals()

    @property
    def lengths(self) -> np.ndarray:
        """Lengths of the facets, on a surface square roots of their areas, (n_facets,) [m]."""
        return self.sizes ** (1 / self.dim)

    def integrals(self, factor: Callable[[np.ndarray], np.ndarray] | None = None) -> np.ndarray:
        """Integrals over the facets of a function of points (n, gdim), by default 1."""
        t, weights = lobatto(self.order + 5, self.kind)
        facet, at = self.on_each(t)
        density = self.stretch(facet, at)
        if factor is not None:
            density = density * factor(self.points(facet, at))
        return density.reshape(-1, len(weights)) @ weights

    def on_each(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Facets and parameters of the same places on all facets."""
        count = len(self.nodes)
        return np.repeat(np.arange(count), len(t)), np.concatenate([t] * count)

    @cached_property
    def flattened(self) -> FlatFacets:
        """Best affine fits to the corners of the facets."""
        t = lattice(1, self.kind).reshape(-1, self.dim)
        fit = np.linalg.pinv(np.column_stack([np.ones(len(t)), t]))
        origin, corners = self.nodes[:, 0], self._shape[:, corner_nodes(self.order, self.kind)]
        affine = np.einsum("kc,fci->fki", fit, corners)
        return FlatFacets(origin + affine[:, 0], affine[:, 1:], np.linalg.pinv(affine[:, 1:]).mT)

    def flat_distances(self, facet: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Distances of points (n, gdim) from flattened facets (n, k), shape (n, k) [m]."""
        points = points[:, None]
        t = self.inside(self.flattened.parameters(facet, points))
        return np.linalg.norm(self.flattened.points(facet, t) - points, axis=2)

    def least_distances(self, facet: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Lower bounds of the distances of points (n, gdim) from facets (n, k), shape (n, k) [m].

        Distances from the planes of flattened facets, less the most that the facets leave them.
        """
        points = points[:, None]
        on_plane = self.flattened.points(facet, self.flattened.parameters(facet, points))
        return np.maximum(np.linalg.norm(on_plane - points, axis=2) - self._off_plane[facet], 0.0)

    def inside(self, t: np.ndarray) -> np.ndarray:
        """Parameters (..., dim) moved into the facet."""
        t = np.clip(t, 0.0, 1.0)
        if self.kind != "triangle":
            return t
        beyond = np.maximum(t.sum(axis=-1, keepdims=True) - 1.0, 0.0) / 2
        return np.clip(t - beyond, 0.0, 1.0)

    def at_edge(self, t: np.ndarray) -> np.ndarray:
        """True for parameters (n, dim) on the edge of a facet."""
        outside = np.any((t <= 0.0) | (t >= 1.0), axis=1)
        return outside | (t.sum(axis=1) >= 1.0) if self.kind == "triangle" else outside

    @cached_property
    def flat(self) -> np.ndarray:
        """True for straight or plane facets with uniform tangents, shape (n_facets,)."""
        every = np.arange(len(self.nodes))[:, None]
        t = lattice(self.order, self.kind).reshape(-1, self.dim)
        off = np.abs(self.flattened.points(every, t) - self.nodes)
        shortest = np.linalg.norm(self.flattened.sides, axis=2).min(axis=1)
        return off.max(axis=(1, 2)) < _FLATNESS_TOLERANCE * shortest

    @cached_property
    def _off_plane(self) -> np.ndarray:
        """Bound of the distances of points of each facet from its flattened one, (n_facets,) [m].

        That of its nodes, which the facet interpolates.
        """
        every = np.arange(len(self.nodes))[:, None]
        on_plane = self.flattened.points(every, self.flattened.parameters(every, self.nodes))
        off = np.linalg.norm(on_plane - self.nodes, axis=2).max(axis=1)
        return lebesgue(self.order, self.kind) * off

    @property
    def corner_points(self) -> np.ndarray:
        """Corners of the facets, shape (n_facets, n_corners, gdim) [m]."""
        return self.nodes[:, corner_nodes(self.order, self.kind)]

    @property
    def extent(self) -> float:
        """Size of the face [m]."""
        return float(np.ptp(self.nodes.reshape(-1, self.nodes.shape[-1]), axis=0).max())

    @cached_property
    def _shape(self) -> np.ndarray:
        """Nodes relative to the first one of each facet: rounding as small as the facet [m]."""
        return self.nodes - self.nodes[:, :1]

    @cached_property
    def _corrections(self) -> np.ndarray:
        return corner_corrections(self.kind, self._shape, self.outward, self.corner_numbers)


class FacetTable(NamedTuple):
    """Facets of a surface from all ranks: nodes, their numbers, centre of the cell, and owner."""

    nodes: np.ndarray
    numbers: np.ndarray
    inside: np.ndarray
    original_cell: np.ndarray
    rank: np.ndarray
    cell: np.ndarray
    local_facet: np.ndarray
    softness: np.ndarray
    group: np.ndarray


def gather_facets(
    body: BodyMesh, surface: str, nodes_of_facet: np.ndarray, of_parts: PartValues
) -> FacetTable:
    """Gather the facets of a surface from the ranks that own their cells; every rank calls.

    Parameters
    ----------
    body : BodyMesh
    surface : str
    nodes_of_facet : ndarray of int, shape (n_facets, n_nodes)
        Indices of the nodes of each facet of a cell.
    of_parts : PartValues
    """
    mesh, topology = body.mesh, body.mesh.topology
    tdim, fdim = topology.dim, topology.dim - 1
    to_cells, to_facets = topology.connectivity(fdim, tdim), topology.connectivity(tdim, fdim)
    found = [(to_cells.links(facet)[0], facet) for facet in body.facets(surface)]
    mine = [(c, facet) for c, facet in found if c < body.n_cells]
    cells = np.array([c for c, _ in mine], dtype=np.int32)
    local = np.array([np.flatnonzero(to_facets.links(c) == f)[0] for c, f in mine], dtype=np.int32)
    of_cells, x = geometry_dofmap(mesh)[cells], mesh.geometry.x[:, :tdim]
    of_facets = np.take_along_axis(of_cells, nodes_of_facet[local], axis=1)
    part, other = body.parts_of_cells(cells), np.nan if of_parts.softness else 1.0
    soft = np.array([of_parts.softness.get(name, other) for name in body.names])
    group = np.array([of_parts.group.get(name, 0) for name in body.names])
    columns = FacetTable(
        x[of_facets],
        np.asarray(mesh.geometry.input_global_indices)[of_facets],
        x[of_cells].mean(axis=1),
        topology.original_cell_index[cells],
        np.full(len(cells), mesh.comm.rank),
        cells,
        local,
        soft[part],
        group[part],
    )
    parts = mesh.comm.allgather(columns)
    table = FacetTable(*(np.concatenate(column) for column in zip(*parts, strict=True)))
    if len(table.rank) == 0:
        raise CaseError(f"geometry: the contact face {surface} has no facets in the mesh")
    return table


_SLENDER = 0.2
"""Deviation of the edges from chords, relative to the width of a facet, of slender facets."""
_PIECES = 10.0
"""Squared number of pieces along the sides of a facet, relative to that deviation."""
_MOST_PIECES = 8
_MARGIN = 1.05
"""Radius of a sphere round a piece relative to the distance of the points in it."""
_AT_ONCE = 4096
"""Number of points that are searched together."""


def slenderness(face: FacetSet) -> np.ndarray:
    """Deviation of nodes from plane facets with straight edges, relative to the width, (n,)."""
    every = np.arange(len(face.nodes))[:, None]
    off = np.linalg.norm(
        face.flattened.points(every, lattice(face.order, face.kind)) - face.nodes, axis=2
    )
    first, second = face.flattened.sides.swapaxes(0, 1)
    sides = [first, second, first - second] if face.kind == "triangle" else [first, second]
    longest = np.max([np.linalg.norm(side, axis=1) for side in sides], axis=0)
    return off.max(axis=1) * longest / np.linalg.norm(np.cross(first, second), axis=1)


class SampledFacets:
    """Points on the facets, and spheres round the pieces of facets about them.

    Parameters
    ----------
    face : FacetSet
        Surface.
    slender : ndarray of bool, shape (n_facets,)
        Facets that are divided into pieces.
    pieces : int
        Number of pieces along their sides.
    """

    def __init__(self, face: FacetSet, slender: np.ndarray, pieces: int):
        self._face, self._slender = face, slender
        parts = [(np.flatnonzero(~slender), 1), (np.flatnonzero(slender), pieces)]
        found = [_pieces(face, facets, count) for facets, count in parts]
        self._facet, self._t, points, radii = (np.concatenate(v) for v in zip(*found, strict=True))
        octave = np.floor(np.log2(radii / radii.min())).astype(int)
        groups = [np.flatnonzero(octave == k) for k in np.unique(octave)]
        self._trees = [(g, cKDTree(points[g]), _MARGIN * float(radii[g].max())) for g in groups]

    def near(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Pairs of a point (n, 3) and a facet that can be its closest one.

        Returns
        -------
        point, facet : ndarray of int, shape (n_pairs,)
            Ascending.
        start : ndarray, shape (n_pairs, 2)
            Parameters on the facet near the closest place.
        """
        starts = range(0, len(points), _AT_ONCE)
        parts = [self._near(points[i : i + _AT_ONCE], i) for i in starts]
        point, facet, start = (np.concatenate(column) for column in zip(*parts, strict=True))
        plane = np.flatnonzero(~self._slender[facet])
        flat = self._face.flattened.parameters(facet[plane], points[point[plane]])
        start[plane] = self._face.inside(flat)
        return point, facet, start

    def _near(self, points: np.ndarray, offset: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        bound = np.min([tree.query(points)[0] for _, tree, _ in self._trees], axis=0)
        found, pieces, distances = [], [], []
        for members, tree, radius in self._trees:
            lists = tree.query_ball_point(points, bound + radius)
            point = np.repeat(np.arange(len(points)), [len(part) for part in lists])
            local = np.concatenate(lists).astype(np.int64)
            found.append(point)
            pieces.append(members[local])
            distances.append(np.linalg.norm(points[point] - tree.data[local], axis=1))
        point, piece = np.concatenate(found), np.concatenate(pieces)
        facet = self._facet[piece]
        order = np.lexsort((np.concatenate(distances), facet, point))
        point, facet, piece = point[order], facet[order], piece[order]
        new = (np.diff(point, prepend=-1) != 0) | (np.diff(facet, prepend=-1) != 0)
        return point[new] + offset, facet[new], self._t[piece[new]]


def sampled(face: FacetSet) -> SampledFacets | None:
    """Sampled facets of a surface; None if no facet is slender and curved."""
    found = slenderness(face) if face.order > 1 else np.zeros(1)
    if found.max() <= _SLENDER:
        return None
    pieces = min(int(np.ceil(np.sqrt(_PIECES * found.max()))), _MOST_PIECES)
    return SampledFacets(face, found > _SLENDER, pieces)


def _pieces(face: FacetSet, facets: np.ndarray, count: int) -> tuple[np.ndarray, ...]:
    """Pieces of facets: facet, parameters of the middle, its place, and radius about it [m]."""
    origin, size = _division(face.kind, count)
    middle = origin + size[:, None] * lattice(1, face.kind).mean(axis=0)
    rim = origin[:, None] + size[:, None, None] * lattice(2, face.kind)
    facet, t = np.repeat(facets, len(middle)), np.tile(middle, (len(facets), 1))
    points = face.points(facet, t)
    around = face.points(
        np.repeat(facet, rim.shape[1]), np.tile(rim.reshape(-1, 2), (len(facets), 1))
    )
    apart = around.reshape(len(points), rim.shape[1], 3) - points[:, None]
    return facet, t, points, np.linalg.norm(apart, axis=2).max(axis=1, initial=0.0)


def _division(kind: str, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Origins (n, 2) and sizes (n,) of equal parts of a facet; negative if turned by 180°."""
    steps = np.stack(np.meshgrid(*[np.arange(count)] * 2, indexing="ij"), axis=-1).reshape(-1, 2)
    if kind != "triangle":
        return steps / count, np.full(len(steps), 1 / count)
    total = steps.sum(axis=1)
    upright, turned = steps[total < count], steps[total < count - 1] + 1
    sizes = np.repeat([1 / count, -1 / count], [len(upright), len(turned)])
    return np.concatenate([upright, turned]) / count, sizes

"""Contact face in space, gathered from all ranks as a set of curved triangles or quadrilaterals.

The facets are replicated on all ranks in an order that does not depend on the number of ranks.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import basix
import numpy as np
from dolfinx import fem
from scipy.spatial import cKDTree

from ...bulk.bodies import Bodies
from ...bulk.field import reference_element
from ...compat import coordinate_element
from ...lagrange import (
    corner_nodes,
    edge_nodes,
    equispaced,
    lattice,
    matching,
    order_of,
)
from .facets import FacetSet, FacetTable, gather_facets

_FLATNESS_TOLERANCE = 1e-9
"""Largest deviation of a facet treated as a parallelogram, relative to its shorter side."""
_CANDIDATES = 4
"""Number of candidates for the closest facet to a point: the nearest in flat approximation."""
_NEAREST_CENTRES = 12
"""Number of facets of similar size, nearest by their centres, among which these are chosen."""


@dataclass(frozen=True, eq=False)
class Surface(FacetSet):
    """Surface of facets with two parameters t that run 0…1 along their edges, as in the cells.

    Attributes
    ----------
    corners : ndarray of int, shape (n_facets, n_corners)
        Corner numbers, shared by adjacent facets.
    """

    corners: np.ndarray

    @property
    def corner_numbers(self) -> np.ndarray:
        return self.corners

    def nearby(self, points: np.ndarray) -> np.ndarray:
        close = np.hstack(
            [
                alike[tree.query(points, np.arange(1, min(_NEAREST_CENTRES, len(alike)) + 1))[1]]
                for alike, tree, _ in self._trees
            ]
        )
        count = min(_CANDIDATES, close.shape[1])
        nearest = np.argpartition(self.flat_distances(close, points), count - 1, axis=1)[:, :count]
        return np.sort(np.take_along_axis(close, nearest, axis=1), axis=1)

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

    @cached_property
    def centres(self) -> np.ndarray:
        """Means of the nodes of the facets, shape (n_facets, 3) [m]."""
        return self.nodes.mean(axis=1)

    @cached_property
    def radii(self) -> np.ndarray:
        """Radii of the spheres round the facets, shape (n_facets,) [m]."""
        return np.linalg.norm(self.nodes - self.centres[:, None], axis=2).max(axis=1)

    @cached_property
    def _trees(self) -> list[tuple[np.ndarray, cKDTree, float]]:
        """Facets of similar size, search tree of their centres, and radius of the largest."""
        octave = np.floor(np.log2(self.radii / self.radii.min())).astype(int)
        groups = [np.flatnonzero(octave == k) for k in np.unique(octave)]
        return [(g, cKDTree(self.centres[g]), float(self.radii[g].max())) for g in groups]

    def position(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """NaN: points of a surface have no order."""
        return np.full(len(facet), np.nan)

    def in_cell(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Parameters in the directions of the facet in its cell, shape (n, 2)."""
        return t

    @cached_property
    def flat(self) -> np.ndarray:
        """True for plane facets with uniform tangents, shape (n_facets,)."""
        every = np.arange(len(self.nodes))[:, None]
        off = np.abs(self.flattened.points(every, lattice(self.order, self.kind)) - self.nodes)
        shortest = np.linalg.norm(self.flattened.sides, axis=2).min(axis=1)
        return off.max(axis=(1, 2)) < _FLATNESS_TOLERANCE * shortest

    @cached_property
    def middle_normals(self) -> np.ndarray:
        """Outward unit normals in the middle of the facets, shape (n_facets, 3)."""
        return self.normals(*self.on_each(lattice(1, self.kind).mean(axis=0, keepdims=True)))

    def numbers(self, degree: int) -> np.ndarray:
        """Coefficient numbers of continuous polynomials, shape (n_facets, n_functions).

        In the order of `lagrange.lattice`. Numbers at common corners and along common edges are
        shared, for any orientation of the facets.
        """
        count, inner = len(self.nodes), degree - 1
        _, corners = np.unique(self.corners, return_inverse=True)
        edges = edge_nodes(degree, self.kind)
        result = np.full((count, len(lattice(degree, self.kind))), -1)
        result[:, corner_nodes(degree, self.kind)] = corners.reshape(self.corners.shape)
        first, last = np.moveaxis(result[:, edges[:, [0, -1]]], 2, 0)
        pairs = np.column_stack([np.minimum(first, last).ravel(), np.maximum(first, last).ravel()])
        _, edge = np.unique(pairs, axis=0, return_inverse=True)
        steps = np.where((first < last)[..., None], np.arange(inner), np.arange(inner)[::-1])
        offset = corners.max() + 1
        result[:, edges[:, 1:-1]] = offset + edge.reshape(*first.shape, 1) * inner + steps
        inside = np.flatnonzero(result[0] < 0)
        offset += (edge.max() + 1) * inner
        result[:, inside] = offset + np.arange(count * len(inside)).reshape(count, -1)
        return result


def gather_surface(bodies: Bodies, surface: str, softness: fem.Function | None = None) -> Surface:
    """Gather the facets of a surface from all ranks, in the order of cells in the mesh file."""
    kind, nodes_of_facet = _facet_nodes(bodies.mesh)
    table = gather_facets(bodies, surface, nodes_of_facet, softness)
    order = np.lexsort((table.local_facet, table.original_cell))
    table = FacetTable(*(column[order] for column in table))
    at_corners = corner_nodes(order_of(kind, table.nodes.shape[1]), kind)
    origin, second, first, *_ = table.nodes[:, at_corners].swapaxes(0, 1)
    from_inside = table.nodes.mean(axis=1) - table.inside
    outward = np.sign(np.einsum("fi,fi->f", np.cross(first - origin, second - origin), from_inside))
    return Surface(
        table.nodes,
        outward,
        table.rank,
        table.cell,
        table.local_facet,
        table.numbers[:, at_corners],
        kind=kind,
        softness=table.softness,
        name=surface,
    )


def _facet_nodes(mesh) -> tuple[str, np.ndarray]:
    """Kind of the facets of a cell, and their node indices, shape (n_facets, n_nodes)."""
    kind, order = reference_element(mesh, 1).cell_type, coordinate_element(mesh).degree
    corners, facets = np.asarray(basix.geometry(kind)), np.array(basix.topology(kind)[-2])
    of_facets = "triangle" if facets.shape[1] == 3 else "quadrilateral"
    a, b, c = np.moveaxis(corners[facets[:, :3]], 1, 0)[:, :, None]
    s, t = lattice(order, of_facets).T[..., None]
    nodes = a + s * (b - a) + t * (c - a)
    return of_facets, matching(nodes, equispaced(kind.name, order).points)

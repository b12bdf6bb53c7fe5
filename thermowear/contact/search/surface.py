"""Contact face in space, gathered from all ranks as a set of curved quadrilaterals.

The facets are replicated on all ranks in an order that does not depend on the number of ranks.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import basix
import numpy as np
from dolfinx import fem

from ...bulk.bodies import Bodies
from ...bulk.field import reference_element
from ...compat import coordinate_element
from ...lagrange import equispaced, lattice, matching
from .facets import FacetSet, FacetTable, gather_facets

_FLATNESS_TOLERANCE = 1e-9
"""Largest deviation of a facet treated as a parallelogram, relative to its shorter side."""
_CANDIDATES = 4
"""Number of candidates for the closest facet to a point: the nearest in flat approximation."""


@dataclass(frozen=True, eq=False)
class Surface(FacetSet):
    """Surface of facets with two parameters t that run 0…1 along their edges, as in the cells.

    Attributes
    ----------
    corners : ndarray of int, shape (n_facets, 2, 2)
        Corner numbers by both parameters, shared by adjacent facets.
    """

    corners: np.ndarray

    @property
    def corner_numbers(self) -> np.ndarray:
        return self.corners

    def nearby(self, distance: np.ndarray) -> np.ndarray:
        count = min(_CANDIDATES, distance.shape[1])
        return np.sort(np.argpartition(distance, count - 1, axis=1)[:, :count], axis=1)

    def position(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """NaN: points of a surface have no order."""
        return np.full(len(facet), np.nan)

    def in_cell(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Parameters in the directions of the facet in its cell, shape (n, 2)."""
        return t

    @cached_property
    def flat(self) -> np.ndarray:
        """True for facets that are parallelograms, shape (n_facets,)."""
        as_flat = self.flattened.points(lattice(self.order, dim=2)[:, None])
        off = np.abs(as_flat.swapaxes(0, 1) - self._listed).max(axis=(1, 2))
        return off < _FLATNESS_TOLERANCE * np.linalg.norm(self.flattened.sides, axis=2).min(axis=1)

    @cached_property
    def middle_normals(self) -> np.ndarray:
        """Outward unit normals in the middle of the facets, shape (n_facets, 3)."""
        return self.normals(*self.on_each(np.full((1, 2), 0.5)))

    def numbers(self, degree: int) -> np.ndarray:
        """Coefficient numbers of continuous polynomials.

        Shape (n_facets, degree + 1, degree + 1). Numbers at common corners and along common edges
        are shared, for any orientation of the facets.
        """
        count, inner = len(self.nodes), degree - 1
        _, corners = np.unique(self.corners, return_inverse=True)
        corners = corners.reshape(self.corners.shape)
        result = np.empty((count, degree + 1, degree + 1), dtype=np.int64)
        result[:, ::degree, ::degree] = corners
        first = corners.max() + 1
        sides = (corners[:, :, 0], corners[:, :, 1], corners[:, 0, :], corners[:, 1, :])
        along = result[:, 1:-1, 0], result[:, 1:-1, -1], result[:, 0, 1:-1], result[:, -1, 1:-1]
        pairs = np.sort(np.concatenate(sides), axis=1)
        _, edge = np.unique(pairs, axis=0, return_inverse=True)
        for ends, on, view in zip(sides, np.split(edge.ravel(), 4), along, strict=True):
            steps = np.where(ends[:, :1] < ends[:, 1:], np.arange(inner), np.arange(inner)[::-1])
            view[:] = first + on[:, None] * inner + steps
        first += (edge.max() + 1) * inner
        within = first + np.arange(count * inner**2)
        result[:, 1:-1, 1:-1] = within.reshape(count, inner, inner)
        return result


def gather_surface(bodies: Bodies, surface: str, softness: fem.Function | None = None) -> Surface:
    """Gather the facets of a surface from all ranks, in the order of cells in the mesh file."""
    table = gather_facets(bodies, surface, _grids(bodies.mesh), softness)
    order = np.lexsort((table.local_facet, table.original_cell))
    table = FacetTable(*(column[order] for column in table))
    n = int(np.sqrt(table.nodes.shape[1]))
    nodes = table.nodes.reshape(-1, n, n, 3)
    corners = table.numbers.reshape(-1, n, n)[:, :: n - 1, :: n - 1]
    first, second = nodes[:, -1, 0] - nodes[:, 0, 0], nodes[:, 0, -1] - nodes[:, 0, 0]
    from_inside = nodes.mean(axis=(1, 2)) - table.inside
    outward = np.sign(np.einsum("fi,fi->f", np.cross(first, second), from_inside))
    owner = table.rank, table.cell, table.local_facet
    return Surface(nodes, outward, *owner, corners, softness=table.softness, name=surface)


def _grids(mesh) -> np.ndarray:
    """Node indices of each facet of a cell on a parameter grid, shape (6, (order + 1)²)."""
    kind, order = reference_element(mesh, 1).cell_type, coordinate_element(mesh).degree
    corners, facets = np.asarray(basix.geometry(kind)), np.array(basix.topology(kind)[-2])
    a, b, c = np.moveaxis(corners[facets[:, :3]], 1, 0)[:, :, None]
    s, t = lattice(order, dim=2).T[..., None]
    return matching(a + s * (b - a) + t * (c - a), equispaced(kind.name, order).points)

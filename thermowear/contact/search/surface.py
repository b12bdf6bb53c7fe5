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
from ...compat import coordinate_element, geometry_dofmap
from ...errors import CaseError
from ...lagrange import equispaced, gauss, lattice, matching, on_lattice
from .facets import owned_facets, softness_behind
from .smooth_normals import corner_corrections, smooth_normals

_FLAT = 1e-9
"""Largest deviation of a facet treated as a parallelogram, relative to its shorter side."""


@dataclass(frozen=True)
class Parallelograms:
    """Parallelograms that approximate the facets.

    Attributes
    ----------
    middle : ndarray, shape (n_facets, 3) [m]
    sides : ndarray, shape (n_facets, 2, 3)
        Tangents along both parameters [m].
    inverse : ndarray, shape (n_facets, 2, 3)
        Parameters per coordinate [1/m].
    """

    middle: np.ndarray
    sides: np.ndarray
    inverse: np.ndarray

    def only(self, facet: int) -> Parallelograms:
        """Parallelogram of one facet."""
        chosen = slice(facet, facet + 1)
        return Parallelograms(self.middle[chosen], self.sides[chosen], self.inverse[chosen])

    def points(self, t: np.ndarray) -> np.ndarray:
        """Coordinates at parameters of every facet, of shape (..., n_facets, 2) [m]."""
        return self.middle + np.einsum("...fk,fki->...fi", t - 0.5, self.sides)

    def parameters(self, points: np.ndarray) -> np.ndarray:
        """Parameters of points (n, 3) projected on every facet, shape (n, n_facets, 2)."""
        return 0.5 + np.einsum("fki,nfi->nfk", self.inverse, points[:, None] - self.middle)


@dataclass(frozen=True, eq=False)
class Surface:
    """Surface of facets with two parameters t that run 0…1 along their edges, as in the cells.

    Attributes
    ----------
    nodes : ndarray, shape (n_facets, order + 1, order + 1, 3) [m]
        Geometry nodes of each facet, at equal steps of the first and of the second parameter.
    corners : ndarray of int, shape (n_facets, 2, 2)
        Corner numbers by both parameters, shared by adjacent facets.
    outward : ndarray, shape (n_facets,)
        +1 if the outward normal is the cross product of both tangents, -1 if it is the opposite.
    rank, cell, local_facet : ndarray of int, shape (n_facets,)
        Rank that owns the cell of the facet, local cell index, and local facet index.
    softness : float or ndarray, shape (n_facets,)
        ``(1 - ν²) / E`` of the material at each facet [1/Pa]; only its ratio to that of the other
        face matters.
    name : str
        Name of the surface.
    wears : bool
        True if the softness is that of wear, see `common_face`.
    """

    nodes: np.ndarray
    corners: np.ndarray
    outward: np.ndarray
    rank: np.ndarray
    cell: np.ndarray
    local_facet: np.ndarray
    softness: float | np.ndarray = 1.0
    name: str = "the contact face"
    wears: bool = False

    def points(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Coordinates at parameters t of shape (n, 2) of facets, shape (n, 3) [m]."""
        return np.einsum("nk,nki->ni", on_lattice(self._order, t)[0], self._listed[facet])

    def tangents(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Derivatives of the coordinates along both parameters, shape (n, 2, 3) [m]."""
        slopes = on_lattice(self._order, t, 1)[1:]
        return np.einsum("dnk,nki->ndi", slopes, self._listed[facet])

    def normals(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Outward unit normals, shape (n, 3)."""
        normal = self._across(facet, t) * self.outward[facet, None]
        return normal / np.linalg.norm(normal, axis=1, keepdims=True)

    def smooth_normals(self, facet: np.ndarray, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Normals that are continuous across facets, and their derivatives along t.

        Shapes (n, 3) and (n, 2, 3).
        """
        return smooth_normals(self.nodes, self.outward, self._corrections, facet, t)

    def soft(self, facet: np.ndarray) -> np.ndarray:
        """Softness at facets, shape (n,) [1/Pa]."""
        return np.broadcast_to(self.softness, len(self.nodes))[facet]

    def stretch(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Area per parameter area, shape (n,) [m²]."""
        return np.linalg.norm(self._across(facet, t), axis=1)

    def position(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """NaN: points of a surface have no order."""
        return np.full(len(facet), np.nan)

    def in_cell(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Parameters in the directions of the facet in its cell, shape (n, 2)."""
        return t

    @cached_property
    def sizes(self) -> np.ndarray:
        """Areas of the facets, shape (n_facets,) [m²]."""
        t, w = gauss(self._order + 4, dim=2)
        facet = np.repeat(np.arange(len(self.nodes)), len(w))
        return self.stretch(facet, np.tile(t, (len(self.nodes), 1))).reshape(-1, len(w)) @ w

    @cached_property
    def flattened(self) -> Parallelograms:
        """Best-fit parallelograms to the corners of the facets."""
        corners = self.nodes[:, :: self._order, :: self._order]
        along = (corners[:, 1] - corners[:, 0]).mean(axis=1)
        across = (corners[:, :, 1] - corners[:, :, 0]).mean(axis=1)
        sides = np.stack([along, across], axis=1)
        return Parallelograms(corners.mean(axis=(1, 2)), sides, np.linalg.pinv(sides).mT)

    @cached_property
    def flat(self) -> np.ndarray:
        """True for facets that are parallelograms, shape (n_facets,)."""
        as_flat = self.flattened.points(lattice(self._order, dim=2)[:, None])
        off = np.abs(as_flat.swapaxes(0, 1) - self._listed).max(axis=(1, 2))
        return off < _FLAT * np.linalg.norm(self.flattened.sides, axis=2).min(axis=1)

    @cached_property
    def middle_normals(self) -> np.ndarray:
        """Outward unit normals in the middle of the facets, shape (n_facets, 3)."""
        every = np.arange(len(self.nodes))
        return self.normals(every, np.full((len(every), 2), 0.5))

    @property
    def extent(self) -> float:
        """Size of the face [m]."""
        return float(np.ptp(self.nodes.reshape(-1, 3), axis=0).max())

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

    @property
    def _order(self) -> int:
        return self.nodes.shape[1] - 1

    @property
    def _listed(self) -> np.ndarray:
        """Nodes of each facet in one list, shape (n_facets, (order + 1)², 3) [m]."""
        return self.nodes.reshape(len(self.nodes), -1, 3)

    @cached_property
    def _corrections(self) -> np.ndarray:
        return corner_corrections(self.nodes, self.outward, self.corners)

    def _across(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        return np.cross(*np.moveaxis(self.tangents(facet, t), 1, 0))


def gather_surface(bodies: Bodies, surface: str, softness: fem.Function | None = None) -> Surface:
    """Gather the facets of a surface from all ranks, in the order of cells in the mesh file."""
    mesh = bodies.mesh
    cells, local = owned_facets(bodies, surface)
    of_cells = geometry_dofmap(mesh)[cells]
    of_facets = np.take_along_axis(of_cells, _grids(mesh)[local], axis=1)
    numbers = np.asarray(mesh.geometry.input_global_indices)
    x = mesh.geometry.x
    part = (
        mesh.topology.original_cell_index[cells],
        x[of_facets],
        numbers[of_facets],
        x[of_cells].mean(axis=1),
        np.full(len(cells), mesh.comm.rank),
        cells,
        local,
        softness_behind(cells, softness),
    )
    parts = mesh.comm.allgather(part)
    original, nodes, numbers, inside, rank, cells, local, soft = (
        np.concatenate([part[k] for part in parts]) for k in range(len(part))
    )
    if len(nodes) == 0:
        raise CaseError(f"geometry: the contact face {surface} has no facets in the mesh")
    order = np.lexsort((local, original))
    n = int(np.sqrt(nodes.shape[1]))
    nodes = nodes[order].reshape(-1, n, n, 3)
    corners = numbers[order].reshape(-1, n, n)[:, :: n - 1, :: n - 1]
    first, second = nodes[:, -1, 0] - nodes[:, 0, 0], nodes[:, 0, -1] - nodes[:, 0, 0]
    from_inside = nodes.mean(axis=(1, 2)) - inside[order]
    outward = np.sign(np.einsum("fi,fi->f", np.cross(first, second), from_inside))
    owner = rank[order], cells[order], local[order]
    return Surface(nodes, corners, outward, *owner, soft[order], surface)


def _grids(mesh) -> np.ndarray:
    """Node indices of each facet of a cell on a parameter grid, shape (6, (order + 1)²)."""
    kind, order = reference_element(mesh, 1).cell_type, coordinate_element(mesh).degree
    corners, facets = np.asarray(basix.geometry(kind)), np.array(basix.topology(kind)[-2])
    a, b, c = np.moveaxis(corners[facets[:, :3]], 1, 0)[:, :, None]
    s, t = lattice(order, dim=2).T[..., None]
    return matching(a + s * (b - a) + t * (c - a), equispaced(kind.name, order).points)

"""Curved facets of a contact face: geometry, and the facets that a rank owns."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from dolfinx import fem

from ...bulk.bodies import Bodies
from ...compat import geometry_dofmap
from ...errors import CaseError
from ...lagrange import lobatto, on_lattice
from .smooth_normals import across, corner_corrections, smooth_normals


@dataclass(frozen=True)
class Parallelograms:
    """Parallelograms, or lines in a section, that approximate the facets.

    Attributes
    ----------
    middle : ndarray, shape (n_facets, gdim) [m]
    sides : ndarray, shape (n_facets, dim, gdim)
        Tangents along the parameters [m].
    inverse : ndarray, shape (n_facets, dim, gdim)
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
        """Coordinates at parameters of every facet, of shape (..., n_facets, dim) [m]."""
        return self.middle + np.einsum("...fk,fki->...fi", t - 0.5, self.sides)

    def parameters(self, points: np.ndarray) -> np.ndarray:
        """Parameters of points (n, gdim) projected on every facet, shape (n, n_facets, dim)."""
        return 0.5 + np.einsum("fki,nfi->nfk", self.inverse, points[:, None] - self.middle)


@dataclass(frozen=True, eq=False)
class FacetSet(ABC):
    """Curved facets with parameters t that run 0…1, replicated on all ranks.

    Attributes
    ----------
    nodes : ndarray, shape (n_facets, order + 1, …, gdim) [m]
        Geometry nodes of each facet, at equal steps of one or two parameters.
    outward : ndarray, shape (n_facets,)
        Sign of the outward normal: +1 along the tangent turned clockwise or the cross product of
        both tangents, -1 opposite to it.
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
    outward: np.ndarray
    rank: np.ndarray
    cell: np.ndarray
    local_facet: np.ndarray
    _: KW_ONLY
    softness: float | np.ndarray = 1.0
    name: str = "the contact face"
    wears: bool = False

    @property
    @abstractmethod
    def corner_numbers(self) -> np.ndarray:
        """Corner numbers shared by adjacent facets, shape (n_facets, 2) or (n_facets, 2, 2)."""

    @abstractmethod
    def nearby(self, distance: np.ndarray) -> np.ndarray:
        """Candidates for the closest facet by the distances (n, n_facets) from `flattened` ones."""

    def points(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Coordinates at parameters t of facets, shape (n, gdim) [m]."""
        return np.einsum("nk,nki->ni", on_lattice(self.order, t)[0], self._listed[facet])

    def tangents(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Derivatives of the coordinates along the parameters, shape (n, dim, gdim) [m]."""
        slopes = on_lattice(self.order, t, 1)[1:]
        return np.einsum("dnk,nki->ndi", slopes, self._listed[facet])

    def normals(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Outward unit normals, shape (n, gdim)."""
        normal = across(self.tangents(facet, t)) * self.outward[facet, None]
        return normal / np.linalg.norm(normal, axis=1, keepdims=True)

    def smooth_normals(self, facet: np.ndarray, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Normals that are continuous across facets, and their derivatives along t.

        Shapes (n, gdim) and (n, gdim - 1, gdim).
        """
        t = t.reshape(len(t), self.dim)
        return smooth_normals(self.nodes, self.outward, self._corrections, facet, t)

    def softness_at(self, facet: np.ndarray) -> np.ndarray:
        """Softness at facets, shape (n,) [1/Pa]."""
        return np.broadcast_to(self.softness, len(self.nodes))[facet]

    def stretch(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Length per parameter or area per parameter area, shape (n,) [m or m²]."""
        return np.linalg.norm(across(self.tangents(facet, t)), axis=1)

    @property
    def dim(self) -> int:
        """Number of parameters of a facet."""
        return self.nodes.ndim - 2

    @property
    def order(self) -> int:
        """Order of the geometry."""
        return self.nodes.shape[1] - 1

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
        t, weights = lobatto(self.order + 5, self.dim)
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
    def flattened(self) -> Parallelograms:
        """Best-fit parallelograms, or lines, to the corners of the facets."""
        inner = tuple(range(1, self.dim + 1))
        corners = self.nodes[(slice(None), *[slice(None, None, self.order)] * self.dim)]
        sides = np.stack([np.diff(corners, axis=k).mean(axis=inner) for k in inner], axis=1)
        return Parallelograms(corners.mean(axis=inner), sides, np.linalg.pinv(sides).mT)

    @property
    def extent(self) -> float:
        """Size of the face [m]."""
        return float(np.ptp(self.nodes.reshape(-1, self.nodes.shape[-1]), axis=0).max())

    @property
    def _listed(self) -> np.ndarray:
        """Nodes of each facet in one list, shape (n_facets, n_nodes, gdim) [m]."""
        return self.nodes.reshape(len(self.nodes), -1, self.nodes.shape[-1])

    @cached_property
    def _corrections(self) -> np.ndarray:
        return corner_corrections(self.nodes, self.outward, self.corner_numbers)


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


def gather_facets(
    bodies: Bodies, surface: str, nodes_of_facet: np.ndarray, softness: fem.Function | None
) -> FacetTable:
    """Gather the facets of a surface from the ranks that own their cells; every rank calls.

    Parameters
    ----------
    bodies : Bodies
    surface : str
    nodes_of_facet : ndarray of int, shape (n_facets, n_nodes)
        Indices of the nodes of each facet of a cell.
    softness : dolfinx.fem.Function or None
        Constant on each cell; None: 1.
    """
    mesh, topology = bodies.mesh, bodies.mesh.topology
    tdim, fdim = topology.dim, topology.dim - 1
    to_cells, to_facets = topology.connectivity(fdim, tdim), topology.connectivity(tdim, fdim)
    found = [(to_cells.links(facet)[0], facet) for facet in bodies.facets(surface)]
    mine = [(c, facet) for c, facet in found if c < topology.index_map(tdim).size_local]
    cells = np.array([c for c, _ in mine], dtype=np.int32)
    local = np.array([np.flatnonzero(to_facets.links(c) == f)[0] for c, f in mine], dtype=np.int32)
    of_cells, x = geometry_dofmap(mesh)[cells], mesh.geometry.x[:, :tdim]
    of_facets = np.take_along_axis(of_cells, nodes_of_facet[local], axis=1)
    soft = np.ones(len(cells))
    if softness is not None:
        soft = softness.x.array[softness.function_space.dofmap.list[cells, 0]].astype(float)
    columns = FacetTable(
        x[of_facets],
        np.asarray(mesh.geometry.input_global_indices)[of_facets],
        x[of_cells].mean(axis=1),
        topology.original_cell_index[cells],
        np.full(len(cells), mesh.comm.rank),
        cells,
        local,
        soft,
    )
    parts = mesh.comm.allgather(columns)
    table = FacetTable(*(np.concatenate(column) for column in zip(*parts, strict=True)))
    if len(table.rank) == 0:
        raise CaseError(f"geometry: the contact face {surface} has no facets in the mesh")
    return table

"""Contact faces, gathered from all ranks: chains of curved facets, in space sets of them.

Faces are replicated on all ranks, in an order that does not depend on the number of ranks, so that
pairing needs no communication. Contact points of a plane body are ordered along its chain from the
first end to the last; a closed curve (full pin in a full bush) is cut at the vertex farthest from
the other face.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import basix
import numpy as np
from dolfinx import fem

from ...bulk.bodies import Bodies
from ...bulk.field import reference_element
from ...compat import coordinate_element
from ...errors import CaseError
from ...lagrange import equispaced, lattice, lobatto, matching
from .facets import FacetSet, FacetTable, gather_facets
from .projection import project

ONWARD = (1.0, 0.3)
"""Direction of a chain: along x; upright faces begin at the lower end, also if slightly worn."""
_FLATNESS_TOLERANCE = 1e-9
"""Largest deviation of a facet treated as a parallelogram, relative to its shorter side."""
_CANDIDATES = 4
"""Number of candidates for the closest facet to a point: the nearest in flat approximation."""


@dataclass(frozen=True, eq=False)
class Face(FacetSet):
    """Chain of facets in order along the face; the parameter t of a facet runs 0…1 along it.

    Attributes
    ----------
    reversed : ndarray of bool, shape (n_facets,)
        True if t is opposite to the direction of the facet in its cell.
    """

    reversed: np.ndarray

    def position(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Arc length along the face from its first end, shape (n,) [m]."""
        start = np.concatenate([[0.0], np.cumsum(self.sizes)])
        x, w = lobatto(self.order + 5)
        within = self.stretch(np.repeat(facet, len(x)), (t[:, None] * x).ravel())
        return start[facet] + t * (within.reshape(-1, len(x)) @ w)

    def in_cell(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Parameters in the direction of the facet in its cell, shape (n, 1)."""
        return np.where(self.reversed[facet], 1 - t, t)[:, None]

    @property
    def closed(self) -> bool:
        """True if the chain is a closed curve."""
        return bool(np.all(self.nodes[0, 0] == self.nodes[-1, -1]))

    def numbers(self, degree: int) -> np.ndarray:
        """Coefficient numbers of continuous polynomials, shape (n_facets, degree + 1)."""
        return np.arange(len(self.nodes))[:, None] * degree + np.arange(degree + 1)

    @property
    def corner_numbers(self) -> np.ndarray:
        corners = np.arange(len(self.nodes))[:, None] + np.arange(2)
        return corners % len(self.nodes) if self.closed else corners

    def nearby(self, distance: np.ndarray) -> np.ndarray:
        # the nearest chord may belong to a neighbour of the nearest curved facet
        return np.clip(distance.argmin(axis=1)[:, None] + (0, -1, 1), 0, len(self.nodes) - 1)


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


def gather_faces(
    bodies: Bodies, surfaces: tuple[str, str], softness: fem.Function | None = None
) -> tuple[Face | Surface, Face | Surface]:
    """Gather both contact faces, closed curves cut; see `gather_face`. Every rank calls."""
    first, second = (gather_face(bodies, surface, softness) for surface in surfaces)
    return _opened(first, second), _opened(second, first)


def _opened(face: Face | Surface, other: Face | Surface) -> Face | Surface:
    """Face; a closed curve is cut far from the other face and runs along `ONWARD` past it."""
    if isinstance(face, Surface) or not face.closed:
        return face
    first = int(np.linalg.norm(project(other, face.nodes[:, 0])[2], axis=1).argmax())
    order = np.roll(np.arange(len(face.nodes)), -first)
    position = np.concatenate([[0.0], np.cumsum(face.sizes[order])])
    middle = order[np.searchsorted(position, position[-1] / 2, side="right") - 1]
    onward = (face.nodes[middle, -1] - face.nodes[middle, 0]) @ ONWARD
    order = order if onward > 0 else order[::-1]
    names = ("nodes", "outward", "rank", "cell", "local_facet", "reversed")
    columns = {name: getattr(face, name)[order] for name in names}
    face = replace(face, **columns, softness=face.softness_at(order))
    if onward > 0:
        return face
    nodes = face.nodes[:, ::-1]
    return replace(face, nodes=nodes, outward=-face.outward, reversed=~face.reversed)


def gather_face(
    bodies: Bodies, surface: str, softness: fem.Function | None = None
) -> Face | Surface:
    """Gather the facets of a surface from all ranks in order; every rank calls.

    Parameters
    ----------
    bodies : Bodies
    surface : str
    softness : dolfinx.fem.Function, optional
        ``(1 - ν²) / E``, constant on each cell; by default equal for all materials [1/Pa].
    """
    gather = _gather_surface if bodies.mesh.topology.dim == 3 else _gather_chain
    return gather(bodies, surface, softness)


def _gather_chain(bodies: Bodies, surface: str, softness: fem.Function | None) -> Face:
    table = gather_facets(bodies, surface, _grids(bodies.mesh), softness)
    order, flip = _chain(table.numbers[:, [0, -1]], table.nodes, surface)
    table, flip = FacetTable(*(column[order] for column in table)), flip[order]
    nodes = np.where(flip[:, None, None], table.nodes[:, ::-1], table.nodes)
    tangent, inward = nodes[:, -1] - nodes[:, 0], table.inside - nodes.mean(axis=1)
    turned = tangent[:, 1] * inward[:, 0] - tangent[:, 0] * inward[:, 1]
    owner = table.rank, table.cell, table.local_facet
    return Face(nodes, -np.sign(turned), *owner, flip, softness=table.softness, name=surface)


def _chain(ends: np.ndarray, nodes: np.ndarray, surface: str) -> tuple[np.ndarray, np.ndarray]:
    """Order of the facets from the first end to the last, and mask of those to reverse.

    A closed curve begins at an arbitrary vertex, see `_opened`.
    """
    vertices, compact = np.unique(ends, return_inverse=True)
    ends = compact.reshape(ends.shape)
    at: list[list[int]] = [[] for _ in vertices]
    for facet, pair in enumerate(ends):
        for vertex in pair:
            at[vertex].append(facet)
    loose = [v for v, facets in enumerate(at) if len(facets) == 1]
    if len(loose) not in (0, 2) or max(len(facets) for facets in at) > 2:
        raise CaseError(_disconnected_message(surface))
    where = {v: nodes[at[v][0], 0 if ends[at[v][0], 0] == v else -1] for v in loose or (0,)}
    vertex = min(where, key=lambda v: float(where[v] @ ONWARD))
    order, flip, facet = [], np.zeros(len(ends), dtype=bool), at[vertex][0]
    for _ in ends:
        order.append(facet)
        flip[facet] = ends[facet, 0] != vertex
        vertex = ends[facet, 0] if flip[facet] else ends[facet, 1]
        following = [f for f in at[vertex] if f != facet]
        if not following or following[0] == order[0]:
            break
        facet = following[0]
    if len(order) < len(ends):
        raise CaseError(_disconnected_message(surface))
    return np.array(order), flip


def _disconnected_message(surface: str) -> str:
    return (
        f"geometry: the contact face {surface} is not one connected curve, open or closed; give "
        "each part that touches a run of its own, or name one part only"
    )


def _gather_surface(bodies: Bodies, surface: str, softness: fem.Function | None) -> Surface:
    """Curved facets in the order of their cells in the mesh file."""
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
    """Node indices of each facet of a cell on a parameter grid, shape (n_facets, n_nodes)."""
    kind, order = reference_element(mesh, 1).cell_type, coordinate_element(mesh).degree
    dim = mesh.topology.dim - 1
    corners, facets = np.asarray(basix.geometry(kind)), np.array(basix.topology(kind)[-2])
    first, *others = np.moveaxis(corners[facets[:, : dim + 1]], 1, 0)[:, :, None]
    places = first
    for t, other in zip(lattice(order, dim).reshape(-1, dim).T, others, strict=True):
        places = places + t[:, None] * (other - first)
    return matching(places, equispaced(kind.name, order).points)

"""Contact faces, gathered from all ranks: chains of curved facets, or surfaces in space.

Faces are replicated on all ranks, in an order that does not depend on the number of ranks, so that
pairing needs no communication. Contact points of a plane body are ordered along its chain from the
first end to the last; a closed curve (full pin in a full bush) is cut at the vertex farthest from
the other face.

A body whose cells have another order has the same facets, corners and nodes with other numbers, see
`Renumbering`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import basix
import numpy as np
from scipy.spatial import cKDTree

from ...bulk.bodies import Bodies, BodyMesh
from ...bulk.spaces import reference_element
from ...compat import coordinate_element
from ...errors import CaseError
from ...lagrange import (
    corner_nodes,
    edge_nodes,
    equispaced,
    lattice,
    lobatto,
    matching,
    on_lattice,
    order_of,
)
from .facets import (
    EQUAL,
    FacetSet,
    FacetTable,
    FacetTree,
    PartValues,
    SampledFacets,
    gather_facets,
    sampled,
)
from .projection import project

ONWARD = (1.0, 0.3)
"""Direction of a chain: along x; upright faces begin at the lower end, also if slightly worn."""
_BLOCK_SIZE = 1_000_000
"""Number of pairs of a point and a facet of a chain processed at once."""
_FACETS = {2: "interval", 3: "triangle", 4: "quadrilateral"}
"""Kind of a facet by its number of corners."""
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

    def nearby(self, points: np.ndarray) -> np.ndarray:
        every, step = np.arange(len(self.nodes))[None], max(1, _BLOCK_SIZE // len(self.nodes))
        parts = [points[i : i + step] for i in range(0, max(len(points), 1), step)]
        nearest = np.concatenate([self.flat_distances(every, p).argmin(axis=1) for p in parts])
        # the nearest chord may belong to a neighbour of the nearest curved facet
        return np.clip(nearest[:, None] + (0, -1, 1), 0, len(self.nodes) - 1)


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
        close = self.tree.nearest(points)
        count = min(_CANDIDATES, close.shape[1])
        nearest = np.argpartition(self.flat_distances(close, points), count - 1, axis=1)[:, :count]
        return np.sort(np.take_along_axis(close, nearest, axis=1), axis=1)

    @cached_property
    def tree(self) -> FacetTree:
        return FacetTree(self.nodes)

    def sampled_nearby(self, points):
        return None if self._samples is None else self._samples.near(points)

    @cached_property
    def _samples(self) -> SampledFacets | None:
        return sampled(self)

    def position(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """NaN: points of a surface have no order."""
        return np.full(len(facet), np.nan)

    def in_cell(self, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Parameters in the directions of the facet in its cell, shape (n, 2)."""
        return t

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


def gather_faces(
    bodies: Bodies, surfaces: tuple[str, str], of_parts: PartValues = EQUAL
) -> tuple[Face | Surface, Face | Surface]:
    """Gather both contact faces, closed curves cut; see `gather_face`. Every rank calls."""
    first, second = (gather_face(bodies, surface, of_parts) for surface in surfaces)
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
    face = replace(face, **columns, softness=face.softness_at(order), group=face.group_at(order))
    if onward > 0:
        return face
    nodes = face.nodes[:, ::-1]
    return replace(face, nodes=nodes, outward=-face.outward, reversed=~face.reversed)


def gather_face(bodies: Bodies, surface: str, of_parts: PartValues = EQUAL) -> Face | Surface:
    """Gather the facets of a surface from all ranks in order; every rank calls.

    Parameters
    ----------
    bodies : Bodies
    surface : str
    of_parts : PartValues, optional
        By default equal for all materials.
    """
    gather, index = _gather_surface if bodies.dim == 3 else _gather_chain, bodies.index_of(surface)
    return replace(gather(bodies.each[index], surface, of_parts), body=index)


def _gather_chain(body: BodyMesh, surface: str, of_parts: PartValues) -> Face:
    table = gather_facets(body, surface, facet_nodes(body.mesh)[1], of_parts)
    order, flip = _chain(table.numbers[:, [0, -1]], table.nodes, surface)
    table, flip = FacetTable(*(column[order] for column in table)), flip[order]
    nodes = np.where(flip[:, None, None], table.nodes[:, ::-1], table.nodes)
    tangent, inward = nodes[:, -1] - nodes[:, 0], table.inside - nodes.mean(axis=1)
    turned = tangent[:, 1] * inward[:, 0] - tangent[:, 0] * inward[:, 1]
    owner = table.rank, table.cell, table.local_facet
    outward, soft, group = -np.sign(turned), table.softness, table.group
    return Face(nodes, outward, *owner, flip, softness=soft, group=group, name=surface)


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


def _gather_surface(body: BodyMesh, surface: str, of_parts: PartValues) -> Surface:
    """Curved facets in the order of their cells in the mesh file."""
    kind, nodes_of_facet = facet_nodes(body.mesh)
    table = gather_facets(body, surface, nodes_of_facet, of_parts)
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
        group=table.group,
        name=surface,
    )


def facet_nodes(mesh) -> tuple[str, np.ndarray]:
    """Kind of the facets of a cell, and their node indices, shape (n_facets, n_nodes)."""
    kind, order = reference_element(mesh, 1).cell_type, coordinate_element(mesh).degree
    corners, facets = np.asarray(basix.geometry(kind)), np.array(basix.topology(kind)[-2])
    of_facets = _FACETS[facets.shape[1]]
    t = lattice(order, of_facets)
    first, *others = np.moveaxis(corners[facets[:, : mesh.topology.dim]], 1, 0)[:, :, None]
    places = first
    for part, other in zip(t.reshape(len(t), -1).T, others, strict=True):
        places = places + part[:, None] * (other - first)
    return of_facets, matching(places, equispaced(kind.name, order).points)


@dataclass(frozen=True)
class Renumbering:
    """New numbers of a surface.

    Attributes
    ----------
    kind : str
        Kind of its facets.
    nodes : ndarray of int, shape (n_nodes,)
        Former number of each node.
    facets : ndarray of int, shape (n_facets,)
        New number of each former facet.
    corners : ndarray of int, shape (n_facets, n_corners)
        Former corner at each new corner of a former facet, in the order of `lagrange.lattice`.
    """

    kind: str
    nodes: np.ndarray
    facets: np.ndarray
    corners: np.ndarray

    def place(self, facet: np.ndarray, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """New facets (n,) and parameters (n, 2) of points given by the former ones."""
        former = on_lattice(1, t, kind=self.kind)[0]
        weights = np.take_along_axis(former, self.corners[facet], axis=1)
        return self.facets[facet], weights @ lattice(1, self.kind)

    def of_facets(self, values: np.ndarray) -> np.ndarray:
        """Values by new facet, given by former facet (n_facets, ...)."""
        result = np.empty_like(values)
        result[self.facets] = values
        return result


def renumbering(former: Surface, places: np.ndarray, new: Surface) -> Renumbering:
    """Match the facets of a surface to those of another mesh with the same nodes.

    Parameters
    ----------
    former : Surface
    places : ndarray, shape (n_nodes, 3)
        Places of its nodes in the new mesh, see `contact.wear.worn_face.nodes_of` [m].
    new : Surface

    Raises
    ------
    ValueError
        If the facets differ.
    """
    own, order = new.numbers(new.order), new.order
    at = np.empty((own.max() + 1, 3))
    at[own] = new.nodes
    nodes = cKDTree(places).query(at)[1]
    ends = corner_nodes(order, new.kind)
    before, after = former.numbers(order)[:, ends], nodes[own][:, ends]
    each = [np.sort(corners, axis=1) for corners in (before, after)]
    first, second = (np.lexsort(corners.T) for corners in each)
    if not np.array_equal(each[0][first], each[1][second]):
        raise ValueError(f"the facets of {former.name} differ")
    facets = np.empty(len(before), dtype=np.int64)
    facets[first] = second
    same = before[:, None] == after[facets][:, :, None]
    return Renumbering(new.kind, nodes, facets, same.argmax(axis=2))

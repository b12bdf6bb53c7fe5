"""Contact face of a plane body, gathered from all ranks as a chain of curved facets.

The chain is replicated on all ranks, so that pairing needs no communication. Contact points are
ordered along it from its first end to its last; a closed curve (full pin in a full bush) is cut at
the vertex farthest from the other face. Faces in space: see `surface`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from dolfinx import fem

from ...bulk.bodies import Bodies
from ...compat import entities_to_geometry_layout
from ...errors import CaseError
from ...lagrange import lobatto
from .facets import FacetSet, FacetTable, gather_facets
from .projection import project
from .surface import Surface, gather_surface

ONWARD = (1.0, 0.3)
"""Direction of a chain: along x; upright faces begin at the lower end, also if slightly worn."""


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
    gather = gather_surface if bodies.mesh.topology.dim == 3 else _gather_chain
    return gather(bodies, surface, softness)


def _gather_chain(bodies: Bodies, surface: str, softness: fem.Function | None) -> Face:
    layout = np.array(entities_to_geometry_layout(bodies.mesh, 1))
    # closure dofs list both ends first, then the interior nodes
    along = np.concatenate([layout[:, :1], layout[:, 2:], layout[:, 1:2]], axis=1)
    table = gather_facets(bodies, surface, along, softness)
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

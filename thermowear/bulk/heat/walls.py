"""Walls of a body that passes through the frame: none may carry heat out.

The shape of the body must be the same in the frame at all times: that of a body of revolution that
turns about its axis, or of a bar that moves along itself, whose ends let material in and out. Each
facet is then a line in the coordinates across the motion (radius and height, or y and z). Meshes
approximate walls that are curved across the motion: as far as neighbouring facets differ in slope,
facets may be inclined to the motion.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import dolfinx
import numpy as np
import scipy.sparse as sp

from ...errors import CaseError
from ..bodies import Bodies
from ..body_mesh import BodyMesh
from .passage import Passage

_ROUNDING = 1e-3
"""Inclination to the motion that positions of nodes explain."""
_TURN, _MOST = 0.7, 0.6
"""Inclination by the difference in slope of neighbours, measured on coarse spheres, rings and
fillets (at most 0.5 of it), and the largest: walls across the motion have facets of nearly 1."""
_CORNERS = {"triangle": (3, 2), "tetrahedron": (4, 3), "quadrilateral": (4, 2)}
_CORNERS["hexahedron"] = (8, 4)
"""Corners of a cell, and of each of its facets."""
_SMOOTH = 0.2
"""Least cosine of the angle between neighbours on a curved wall, which others meet at edges."""


@dataclass(frozen=True)
class Facets:
    """Facets at which a body, or one of its materials, ends.

    Attributes
    ----------
    corners : ndarray, shape (n, k, 3) [m]
    inside : ndarray, shape (n, 3)
        Midpoints of the corners of a cell of each [m].
    surface : ndarray of int, shape (n,)
        Tag of its surface, 0 without one; -1 between two materials.
    """

    corners: np.ndarray
    inside: np.ndarray
    surface: np.ndarray

    @property
    def middle(self) -> np.ndarray:
        """Midpoints of the corners, shape (n, 3) [m]."""
        return self.corners.mean(axis=1)

    @property
    def normals(self) -> np.ndarray:
        """Outward unit normals, shape (n, 3)."""
        normals = _areas(self.corners)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        inward = np.sum(normals * (self.middle - self.inside), axis=1) < 0
        return np.where(inward[:, None], -normals, normals)


def require_swept(
    bodies: Bodies, passage: Passage, kinds: Mapping[str, int], mirrors: Sequence[str] = ()
) -> None:
    """Require a passing body to keep its shape in the frame. Every rank calls.

    Parameters
    ----------
    bodies : Bodies
    passage : Passage
    kinds : mapping of str to int
        Parts of the body with their kind of thermal material.
    mirrors : sequence of str
        Surfaces on planes of symmetry: paths go on in the mirror image, in the limit of high speed.

    Raises
    ------
    CaseError
    """
    for body in bodies.each:
        if not set(passage.parts) & set(body.parts):
            continue
        facets = _gathered(body, kinds)
        inclined, allowed = _inclination(facets.corners, passage)
        mirror = np.isin(facets.surface, [body.surfaces.index(name) + 1 for name in mirrors])
        end = passage.is_end(facets.middle, facets.normals) & (facets.surface >= 0)
        passed = end | mirror if passage.spread else end & ~mirror
        wrong = np.flatnonzero((inclined > allowed) & ~passed)
        if len(wrong):
            worst = wrong[np.argmax(inclined[wrong])]
            tags = np.unique(facets.surface[wrong][facets.surface[wrong] > 0])
            raise CaseError(_message(passage, facets, worst, [body.surfaces[t - 1] for t in tags]))


def lets_through(body: BodyMesh, passage: Passage) -> bool:
    """Test for walls across the motion, which no error of the mesh explains. Every rank calls."""
    facets = _gathered(body, {})
    inclined, _ = _inclination(facets.corners, passage)
    return bool(np.any((inclined > _MOST) & ~passage.is_end(facets.middle, facets.normals)))


def _message(passage: Passage, facets: Facets, worst: int, surfaces: list[str]) -> str:
    """Fault of walls that carry heat out, by the surfaces concerned or the worst place."""
    place = facets.corners[worst].mean(axis=0)
    where = ", ".join(map(repr, surfaces)) or ", ".join(
        f"{axis} = {value:.4g} m" for axis, value in zip("xyz", place, strict=True)
    )
    kind = "a border of materials" if facets.surface[worst] < 0 else "a wall"
    shape = "along its motion" if passage.center is None else "round about its axis"
    return (
        f"heat.advection: {passage.parts[0]!r} has {kind} at {where} that is not {shape} and would "
        "carry heat away, so that there are no steady temperatures in the frame of the contact; "
        'use a body without it, or heat.advection = "none"'
    )


def outer_facets(body: BodyMesh) -> tuple[np.ndarray, Facets]:
    """Outer facets of a body that this rank owns: their local indices, and their places."""
    mesh = body.mesh
    mesh.topology.create_connectivity(mesh.topology.dim - 1, mesh.topology.dim)
    outer = dolfinx.mesh.exterior_facet_indices(mesh.topology)
    known, tags = body.facet_tags.indices, np.zeros(len(outer), dtype=np.int64)
    tagged = np.isin(outer, known)
    tags[tagged] = body.facet_tags.values[np.searchsorted(known, outer[tagged])]
    return outer, _at(body, outer, tags)


def _at(body: BodyMesh, facets: np.ndarray, surface: np.ndarray) -> Facets:
    """Places of local facets with the tags of their surfaces."""
    mesh, tdim = body.mesh, body.mesh.topology.dim
    of_cell, of_facet = _CORNERS[body.cell_type]
    if not len(facets):
        return Facets(np.empty((0, of_facet, 3)), np.empty((0, 3)), surface)
    cells = mesh.topology.connectivity(tdim - 1, tdim)
    first = np.array([cells.links(facet)[0] for facet in facets], dtype=np.int32)
    at = dolfinx.mesh.entities_to_geometry(mesh, tdim - 1, facets)
    of = dolfinx.mesh.entities_to_geometry(mesh, tdim, first)
    x = mesh.geometry.x
    return Facets(x[at[:, :of_facet]], x[of[:, :of_cell]].mean(axis=1), surface)


def _gathered(body: BodyMesh, kinds: Mapping[str, int]) -> Facets:
    """Outer facets of a body and those between its materials, of all ranks."""
    _, outer = outer_facets(body)
    inner = _between(body, kinds) if len(set(kinds.values())) > 1 else np.empty(0, dtype=np.int32)
    border = _at(body, inner, np.full(len(inner), -1))
    own = [(f.corners, f.inside, f.surface) for f in (outer, border)]
    every = [part for parts in body.mesh.comm.allgather(own) for part in parts]
    return Facets(*(np.concatenate(part) for part in zip(*every, strict=True)))


def _between(body: BodyMesh, kinds: Mapping[str, int]) -> np.ndarray:
    """Local indices of the owned facets between cells of different kinds of parts."""
    tdim = body.mesh.topology.dim
    cells = body.mesh.topology.connectivity(tdim - 1, tdim)
    count = body.mesh.topology.index_map(tdim - 1).size_local
    starts = cells.offsets[: count + 1]
    inner = np.flatnonzero(np.diff(starts) == 2)
    pairs = np.stack([cells.array[starts[inner]], cells.array[starts[inner] + 1]], axis=1)
    kind = np.array([kinds.get(name, -1) for name in body.names])
    of = kind[body.parts_of_cells(pairs.ravel())].reshape(-1, 2)
    return inner[of[:, 0] != of[:, 1]].astype(np.int32)


def _inclination(corners: np.ndarray, passage: Passage) -> tuple[np.ndarray, np.ndarray]:
    """Sine of the inclination of facets to the motion, and the largest allowed one, (n,) each."""
    areas = _areas(corners)
    sizes = np.linalg.norm(areas, axis=1)
    inclined = np.linalg.norm(_areas(passage.across(corners)), axis=1) / sizes
    normals, sides = areas / sizes[:, None], passage.directions(corners.mean(axis=1))
    slopes = np.stack([np.sum(normals * side, axis=1) for side in sides], axis=1)
    slopes /= np.maximum(np.linalg.norm(slopes, axis=1), 0.5)[:, None]
    extent = np.ptp(corners.reshape(-1, 3), axis=0).max()
    _, node = np.unique(np.round(corners.reshape(-1, 3) / extent, 9), axis=0, return_inverse=True)
    facet = np.repeat(np.arange(len(corners)), corners.shape[1])
    at = sp.csr_matrix((np.ones(len(facet)), (facet, node.ravel())))
    one, other = (at @ at.T).nonzero()
    cosine = np.sum(normals[one] * normals[other], axis=1)
    turned = np.linalg.norm(slopes[one] - np.sign(cosine)[:, None] * slopes[other], axis=1)
    turn = np.zeros(len(corners))
    np.maximum.at(turn, one, np.where(np.abs(cosine) > _SMOOTH, turned, 0.0))
    return inclined, _ROUNDING + np.minimum(_TURN * turn, _MOST)


def _areas(corners: np.ndarray) -> np.ndarray:
    """Area vectors (n, 3) of edges in the plane, triangles or quadrilaterals by their corners."""
    if corners.shape[1] == 2:
        along = corners[:, 1] - corners[:, 0]
        return np.stack([along[:, 1], -along[:, 0], np.zeros(len(along))], axis=1)
    first, last = ((0, 1), (0, 2)) if corners.shape[1] == 3 else ((0, 3), (1, 2))
    return np.cross(*(corners[:, b] - corners[:, a] for a, b in (first, last))) / 2

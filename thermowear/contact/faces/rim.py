"""Rim of a contact face: sharp edges, and edges beyond which the surface of the body goes on.

Contact ends at the rim. At a sharp edge that is its real end; where the surface goes on smoothly,
contact beyond the rim is left out.
"""

from __future__ import annotations

from collections.abc import Sequence

import basix
import dolfinx
import numpy as np
from scipy.spatial import cKDTree

from ...bulk.bodies import BodyMesh
from ...compat import geometry_dofmap
from ...lagrange import corner_nodes, lattice
from .face import facet_nodes
from .facets import FacetSet
from .normals import across

_SMOOTH = np.cos(np.radians(10.0))
"""Cosine of the angle from which on an edge is sharp: chamfers are at least that steep."""
_SAME = 1e-9
"""Largest distance of the middles of one edge in two facets, relative to the size of the face."""
_ON_EDGE = 1e-3
"""Largest distance of a point on an edge of its facet, in parameters."""
_ALONG = 9
"""Number of places along an edge that stand for it."""
_NEAR_EDGE = 1e-2
"""Such a distance of points in slivers beside curved edges of the other face."""


def edges_of(kind: str) -> np.ndarray:
    """Corners of each edge of a facet, shape (n_edges, 2); the two ends of an interval, (2, 1)."""
    return np.array(basix.topology(basix.CellType[kind])[-2])


def on_edges(face: FacetSet, t: np.ndarray, within: float = _ON_EDGE) -> np.ndarray:
    """True where points lie on an edge of their facets, shape (n, n_edges).

    Parameters
    ----------
    face : FacetSet
    t : ndarray, shape (n,) or (n, 2)
        Parameters of the points.
    within : float
        Largest distance, in parameters.
    """
    corners = lattice(1, face.kind).reshape(-1, face.dim)
    first, *others = np.moveaxis(corners[edges_of(face.kind)], 1, 0)
    away = t.reshape(len(t), 1, face.dim) - first
    if not others:
        return np.abs(away[..., 0]) < within
    along = others[0] - first
    across_edge = along[:, 0] * away[..., 1] - along[:, 1] * away[..., 0]
    return np.abs(across_edge) < within * np.linalg.norm(along, axis=1)


def near_chosen(face: FacetSet, chosen: np.ndarray, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
    """True where points lie on chosen edges of a face or at their ends, nearly, shape (n,).

    Parameters
    ----------
    face : FacetSet
    chosen : ndarray of bool, shape (n_facets, n_edges)
    facet, t : ndarray
        Points. At an end of an edge their facet may be one that shares only this corner with it.
    """
    numbers = face.corner_numbers
    ends = np.isin(numbers, numbers[:, edges_of(face.kind)][chosen])
    corners = lattice(1, face.kind).reshape(-1, face.dim)
    away = np.abs(t.reshape(len(t), 1, face.dim) - corners).max(axis=2)
    at_ends = np.any((away < _NEAR_EDGE) & ends[facet], axis=1)
    return at_ends | np.any(on_edges(face, t, _NEAR_EDGE) & chosen[facet], axis=1)


def beside_edges(face: FacetSet, chosen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Facets and parameters of places on a face right beside chosen edges (n_facets, n_edges)."""
    facet, edge = np.nonzero(chosen)
    corners = lattice(1, face.kind).reshape(-1, face.dim)
    ends = corners[edges_of(face.kind)[edge]]
    part = np.linspace(0.0, 1.0, _ALONG if face.dim > 1 else 1)[:, None]
    t = ends[:, :1] + part * (ends[:, -1:] - ends[:, :1])
    t = (t + _NEAR_EDGE * (corners.mean(axis=0) - t)).reshape(-1, face.dim)
    return np.repeat(facet, len(part)), t[:, 0] if face.dim == 1 else t


def rim_edges(face: FacetSet) -> tuple[np.ndarray, np.ndarray]:
    """Facets and edges at the rim of a face: edges of one facet only, shape (n,) each."""
    edges = edges_of(face.kind)
    keys = np.sort(face.corner_numbers[:, edges].reshape(-1, edges.shape[1]), axis=1)
    _, number, count = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    facet, edge = np.nonzero((count[number.ravel()] == 1).reshape(-1, len(edges)))
    return facet, edge


def rim(face: FacetSet, body: BodyMesh, paired: Sequence[str]) -> tuple[np.ndarray, np.ndarray]:
    """Sharp edges at the rim of a face, and edges where the surface goes on. Every rank calls.

    Parameters
    ----------
    face : FacetSet
    body : BodyMesh
    paired : sequence of str
        Surfaces in contact or glued, this face among them: they do not count as a surface that
        goes on.

    Returns
    -------
    sharp, goes_on : ndarray of bool, shape (n_facets, n_edges)
    """
    edges = edges_of(face.kind)
    facet, edge = rim_edges(face)
    at_rim = np.zeros((len(face.nodes), len(edges)), dtype=bool)
    at_rim[facet, edge] = True
    middles = face.corner_points[facet[:, None], edges[edge]].mean(axis=1)
    ends = lattice(1, face.kind).reshape(-1, face.dim)[edges[edge]].mean(axis=1)
    t = ends[:, 0] if face.dim == 1 else ends
    beside, normals = _other_facets(body, face, paired)
    distance, nearest = cKDTree(middles).query(beside.reshape(-1, beside.shape[2]))
    close = np.flatnonzero(distance < _SAME * face.extent)
    at = nearest[close]
    cosine = np.einsum("ni,ni->n", face.normals(facet[at], t[at]), normals[close // len(edges)])
    found = np.concatenate(body.mesh.comm.allgather(at[cosine > _SMOOTH]))
    goes_on = np.zeros_like(at_rim)
    goes_on[facet[found], edge[found]] = True
    return at_rim & ~goes_on, goes_on


def _other_facets(
    body: BodyMesh, face: FacetSet, paired: Sequence[str]
) -> tuple[np.ndarray, np.ndarray]:
    """Middles of the edges (m, n_edges, gdim) and outward normals (m, gdim) of other facets.

    Those of this rank on the surface of the body that are neither in contact nor glued.
    """
    topology, dim = body.mesh.topology, body.mesh.topology.dim
    for one, other in ((dim - 1, dim), (dim, dim - 1)):
        topology.create_connectivity(one, other)
    taken = np.concatenate([body.facets(surface) for surface in paired])
    outside = np.setdiff1d(dolfinx.mesh.exterior_facet_indices(topology), taken)
    to_cells, to_facets = topology.connectivity(dim - 1, dim), topology.connectivity(dim, dim - 1)
    cells = to_cells.array[to_cells.offsets[outside]]
    kind, nodes_of_facet = facet_nodes(body.mesh)
    of_cells = to_facets.array.reshape(-1, len(nodes_of_facet))[cells]
    local = np.argmax(of_cells == outside[:, None], axis=1)
    corners = nodes_of_facet[:, corner_nodes(face.order, kind)]
    nodes, x = geometry_dofmap(body.mesh)[cells], body.mesh.geometry.x[:, :dim]
    points = x[np.take_along_axis(nodes, corners[local], axis=1)]
    normals = across(points[:, 1:dim] - points[:, :1])
    inward = x[nodes].mean(axis=1) - points.mean(axis=1)
    normals *= -np.sign(np.einsum("ni,ni->n", normals, inward))[:, None]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return points[:, edges_of(kind)].mean(axis=2), normals

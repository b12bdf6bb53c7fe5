"""Nodal displacements of a worn face from the worn depth, along its unworn normals.

Each node moves along the normal of the unworn face, by the offset that displaces the face by the
worn depth along its present normal. Nodes of initially matching faces stay opposite each other, and
end nodes of a face move along the sides of its body.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from ...lagrange import lattice, neighbour_nodes
from ..faces.face import Face, Surface
from ..search.pairing import PairedFace, Pairing

_ROUGH = 1e-8
"""Relative weight of the smoothing term, which determines nodes without contact points nearby."""


@dataclass(frozen=True)
class Paths:
    """Directions of motion of the nodes of a face, in the order of `nodes_of`.

    Attributes
    ----------
    directions : ndarray, shape (n_nodes, gdim)
        Unit vectors out of the unworn body.
    held : ndarray of bool, shape (n_nodes,)
        Fixed nodes.
    """

    directions: np.ndarray
    held: np.ndarray


def nodes_of(face: Face | Surface) -> np.ndarray:
    """Geometry nodes, in a plane model in order along the face, shape (n_nodes, gdim) [m]."""
    number, gdim = face.numbers(face.order), face.nodes.shape[-1]
    result = np.empty((number.max() + 1, gdim))
    result[number] = face.nodes
    return result


def node_normals(face: Face | Surface) -> np.ndarray:
    """Outward unit normals at the nodes, averaged over facets, shape (n_nodes, gdim)."""
    number = face.numbers(face.order).ravel()
    normals = _at(face, face.normals, face.order)
    summed = np.column_stack([np.bincount(number, n) for n in normals.reshape(len(number), -1).T])
    return _unit(summed)


def directions_between(
    sides: tuple[PairedFace, PairedFace], directions: tuple[np.ndarray, ...], recession: np.ndarray
) -> np.ndarray:
    """Unit vectors from contact points to body 2 along the nodal directions, shape (n, gdim).

    Mean of the directions out of body 1 and into body 2, weighted by the recession of each face.

    Parameters
    ----------
    sides : tuple of PairedFace
    directions : tuple of ndarray, shape (n_nodes, gdim)
        Directions of the nodes of both faces, see `Paths`.
    recession : ndarray, shape (2,)
        Recession of each face; only the ratio matters.
    """
    at = (_nodes_at(side) for side in sides)
    out_1, out_2 = (
        _unit(np.einsum("nk,nki->ni", values, along[node]))
        for (node, values), along in zip(at, directions, strict=True)
    )
    return _unit(recession[0] * out_1 - recession[1] * out_2)


def curvatures(face: Face | Surface) -> np.ndarray:
    """Largest curvature of each facet, from pairs of its corners, shape (n_facets,) [1/m]."""
    points, normals = _at(face, face.points, 1), _at(face, face.normals, 1)
    pairs = np.array(list(itertools.combinations(range(points.shape[1]), 2))).T
    chord, turn = (np.subtract(*v[:, pairs].swapaxes(0, 1)) for v in (points, normals))
    return (np.linalg.norm(turn, axis=2) / np.linalg.norm(chord, axis=2)).max(axis=1)


class WornFace:
    """Map from worn depths at the contact points to nodal displacements of one face.

    Parameters
    ----------
    pairing : Pairing
    index : int
        0 for body 1, 1 for body 2.
    paths : Paths
    """

    def __init__(self, pairing: Pairing, index: int, paths: Paths):
        side = pairing.sides[index]
        self._paths = paths
        out = pairing.normals if index == 0 else -pairing.normals
        node, values = _nodes_at(side)
        values = values * np.einsum("ni,nki->nk", out, paths.directions[node])
        point = np.broadcast_to(np.arange(len(node))[:, None], node.shape)
        shape = len(node), len(paths.directions)
        # depths at the points per displacement of the nodes
        self._depths = sp.csr_matrix((values.ravel(), (point.ravel(), node.ravel())), shape=shape)
        self._weights = pairing.weights
        share = pairing.weights.sum() / side.face.sizes[np.unique(side.facet)].sum()
        self._smoothing = _ROUGH * share * _roughness(side.face)

    def offsets(self, depth: np.ndarray) -> np.ndarray:
        """Nodal displacements for a worn depth (n,), shape (n_nodes,) [m].

        Area-weighted least-squares fit with the same volume. Nodes hardly supported by contact
        points follow their neighbours, those without support are fixed.
        """
        weighted = sp.diags(self._weights) @ self._depths
        volume = weighted.sum(axis=0).A1
        free = ~self._paths.held & (abs(weighted).sum(axis=0).A1 > 0.0)
        weighted, depths, volume = weighted[:, free], self._depths[:, free], volume[free]
        factor = splu((weighted.T @ depths + self._smoothing[free][:, free]).tocsc())
        nearest, fuller = factor.solve(weighted.T @ depth), factor.solve(volume)
        missing = self._weights @ depth - volume @ nearest
        result = np.zeros(len(free))
        result[free] = nearest + missing / (volume @ fuller) * fuller
        return result

    def depths(self, offsets: np.ndarray) -> np.ndarray:
        """Worn depth at the contact points, shape (n,) [m]."""
        return self._depths @ offsets

    def displacement(self, offsets: np.ndarray) -> np.ndarray:
        """Displacement vectors of the nodes, into the body, shape (n_nodes, gdim) [m]."""
        return -offsets[:, None] * self._paths.directions


def _roughness(face: Face | Surface) -> sp.csr_matrix:
    """Matrix of squared differences between neighbouring nodes, weighted by facet sizes."""
    numbers = face.numbers(face.order)
    pairs = neighbour_nodes(face.order, face.kind)
    a, b = (numbers[:, ends].ravel() for ends in pairs.T)
    size = np.repeat(face.sizes, len(pairs))
    values = np.concatenate([size, size, -size, -size])
    where = np.concatenate([a, b, a, b]), np.concatenate([a, b, b, a])
    return sp.csr_matrix((values, where), shape=(numbers.max() + 1,) * 2)


def _at(face: Face | Surface, values, order: int) -> np.ndarray:
    """Values of a face's method on the lattice of each facet, (n_facets, n_places, …)."""
    t = lattice(order, face.kind)
    return values(*face.on_each(t)).reshape(len(face.nodes), len(t), -1)


def _nodes_at(side: PairedFace) -> tuple[np.ndarray, np.ndarray]:
    """Nodes of the facet at each point, and their shape functions, (n, nodes_per_facet) each."""
    face = side.face
    return face.numbers(face.order)[side.facet], face.shape_functions(side.t)[0]


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)

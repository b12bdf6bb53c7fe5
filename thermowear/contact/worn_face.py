"""How the nodes of a worn face move: by the depth worn off it, along its unworn normals.

Each node goes along the normal of the unworn face so far that the face moves by the depth along
its present normal. Nodes of faces that matched when they were new so stay opposite each other, and
those at the ends of a face go along the sides of its body.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .face import Face
from .facets import lagrange
from .pairing import Pairing


@dataclass(frozen=True)
class Paths:
    """Ways of the nodes of a face, in order along it.

    Attributes
    ----------
    directions : ndarray, shape (n_nodes, 2)
        Unit vectors out of the unworn body.
    held : ndarray of bool, shape (n_nodes,)
        Nodes that stay where they are.
    """

    directions: np.ndarray
    held: np.ndarray


def nodes_of(face: Face) -> np.ndarray:
    """Geometry nodes in order along the face, shape (n_nodes, 2) [m]."""
    order = face.nodes.shape[1] - 1
    return (
        np.concatenate([face.nodes[:, :-1].reshape(-1, 2), face.nodes[-1:, -1]])
        if order
        else face.nodes
    )


def node_normals(face: Face) -> np.ndarray:
    """Outward unit normals at the nodes, means where facets meet, shape (n_nodes, 2)."""
    count, order = len(face.nodes), face.nodes.shape[1] - 1
    facet = np.repeat(np.arange(count), order + 1)
    normals = face.normals(facet, np.tile(np.linspace(0.0, 1.0, order + 1), count))
    number = face.numbers(order).ravel()
    summed = np.column_stack([np.bincount(number, n) for n in normals.T])
    return summed / np.linalg.norm(summed, axis=1, keepdims=True)


def curvatures(face: Face) -> np.ndarray:
    """Of each facet: how far its normal turns, by its length, shape (n_facets,) [1/m]."""
    every = np.arange(len(face.nodes))
    first, last = (face.normals(every, np.full(len(every), t)) for t in (0.0, 1.0))
    turn = np.arccos(np.clip(np.einsum("ni,ni->n", first, last), -1.0, 1.0))
    return turn / face.sizes


class WornFace:
    """One face of a pairing, as depths at the contact points move its nodes.

    Parameters
    ----------
    pairing : Pairing
    index : int
        0 for body 1, 1 for body 2.
    paths : Paths
    """

    def __init__(self, pairing: Pairing, index: int, paths: Paths):
        side = pairing.sides[index]
        assert isinstance(side.face, Face)
        self.face = side.face
        self._paths = paths
        order = side.face.nodes.shape[1] - 1
        out = pairing.normals if index == 0 else -pairing.normals
        numbers = side.face.numbers(order)[side.facet]
        shape = np.zeros((len(side.t), len(paths.directions)))
        np.put_along_axis(shape, numbers, lagrange(order, side.t), axis=1)
        self._weights = pairing.weights
        self._depths = shape * (out @ paths.directions.T)  # at the points, by amounts of the nodes

    def amounts(self, depth: np.ndarray) -> np.ndarray:
        """How far the nodes go so that the face loses a depth (n,), shape (n_nodes,) [m].

        Nearest to it in the mean of squares over the area, with the same volume.
        """
        weighted = self._weights[:, None] * self._depths
        free = ~self._paths.held & (np.abs(weighted).sum(axis=0) > 0.0)
        matrix = weighted[:, free].T @ self._depths[:, free]
        volume = weighted[:, free].sum(axis=0)
        n = len(volume)
        bordered = np.zeros((n + 1, n + 1))
        scale = np.abs(matrix).max()
        volume_scale = np.abs(volume).max()
        bordered[:n, :n] = matrix / scale
        bordered[:n, n] = bordered[n, :n] = volume / volume_scale
        right = np.append(weighted[:, free].T @ depth / scale, self._weights @ depth / volume_scale)
        result = np.zeros(len(free))
        result[free] = np.linalg.lstsq(bordered, right, rcond=1e-13)[0][:n]
        return result

    def depths(self, amounts: np.ndarray) -> np.ndarray:
        """Depth that the face loses at the contact points, shape (n,) [m]."""
        return self._depths @ amounts

    def displacement(self, amounts: np.ndarray) -> np.ndarray:
        """Of the nodes, into the body, shape (n_nodes, 2) [m]."""
        return -amounts[:, None] * self._paths.directions

    def tilt(self, amounts: np.ndarray) -> float:
        """Largest difference of the depth between the ends of a facet, by its length."""
        order = self.face.nodes.shape[1] - 1
        return float((np.abs(np.diff(amounts[::order])) / self.face.sizes).max())

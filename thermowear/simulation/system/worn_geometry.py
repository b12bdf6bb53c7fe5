"""State of meshes that have been moved to the worn faces."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field

import numpy as np
import scipy

from ...contact.search.face import Surface
from ...contact.search.pairing import Pairing
from ...contact.search.refinement import Rule
from ...geometry.mesh.mixed import AnyMesh
from ...geometry.moving.new_face import NewFace

_SAME = 1e-9
_TWICE = 1e-12
"""Largest distance of the same position on two facets, relative to a facet."""


@dataclass(frozen=True)
class WornGeometry:
    """Meshes moved to the worn faces, and the wear depths transferred to them from the gap.

    Attributes
    ----------
    mesh : TaggedMesh or MixedMesh
        Present mesh.
    directions : tuple of ndarray, shape (n_nodes, 2)
        Motion directions of the nodes of both faces, see `contact.wear.worn_face.Paths`.
    held : tuple of ndarray of bool, shape (n_nodes,)
        Nodes of both faces that are held fixed, see there.
    sizes : tuple of ndarray, shape (n_facets,)
        Lengths of the facets of both faces in the initial mesh [m].
    best : ndarray, shape (2,)
        Smallest scaled Jacobian of the cells of both bodies in the initial mesh.
    at : ndarray, shape (n_before,) or (n_before, 3)
        Positions on the face of body 1 of the contact points before the last update, see `along`.
    depth : ndarray, shape (2, n_before)
        Wear depth removed from the mesh of each body at these points [m].
    missing_shape : ndarray, shape (n_before,)
        Depth of the initial shape that the initial mesh does not contain [m].
    holder : tuple of ndarray, shape (3,)
        Translation and rotation of body 1 at the last pairing of the faces [m, rad].
    lost : ndarray, shape (2,)
        Volume removed from each mesh [m³].
    updates : int
        Number of mesh motions.
    quality : float
        Smallest scaled Jacobian of the cells so far.
    pieces : Rule or None
        Quadrature of surfaces, and of sections with pointwise contact at the edge of the wear:
        contact points keep their positions on the facets. None where a section is paired again.
    volume_error : float
        Largest difference so far of the volume removed in an update and the wear volume, relative
        to the volume removed so far.
    renewed : dict of int to NewFace
        Faces redivided by the last update, by index of the body. Their depth is that of the smooth
        curve through the nodes of the former face.
    change : float
        Largest change so far of pressure and temperatures by an update, relative to their means.
    heat_error : float
        Largest transfer error so far of temperatures, relative to the largest rise.
    meshed_anew : int
        Number of times that a body was remeshed because of distorted cells.
    carrying_error : float
        Largest transfer error so far of depths to remeshed faces, relative to the largest depth.
    """

    mesh: AnyMesh
    directions: tuple[np.ndarray, ...]
    held: tuple[np.ndarray, ...]
    sizes: tuple[np.ndarray, ...]
    best: np.ndarray
    at: np.ndarray
    depth: np.ndarray
    missing_shape: np.ndarray
    holder: tuple[np.ndarray, np.ndarray]
    lost: np.ndarray
    updates: int
    quality: float
    volume_error: float
    pieces: Rule | None
    renewed: dict[int, NewFace] = field(default_factory=dict)
    change: float = 0.0
    heat_error: float = 0.0
    meshed_anew: int = 0
    carrying_error: float = 0.0

    def carried(self, values: np.ndarray, pairing: Pairing) -> np.ndarray:
        """Interpolate values (..., n_before) to the points of a new pairing of the same faces.

        In a section not across borders of materials, where points exist twice.
        """
        before, after = self.at, along(pairing)
        if before.shape == after.shape and np.abs(before - after).max() < _SAME:
            return values
        parts = zip(_between_jumps(before), _between_jumps(after), strict=True)
        found = [_interpolated(before[old], values[..., old], after[new]) for old, new in parts]
        return np.concatenate(found, axis=-1)

    def moved(self, pairing: Pairing) -> np.ndarray:
        """Wear depths removed from both meshes at the points of a pairing, shape (2, n) [m]."""
        depth = self.carried(self.depth, pairing).copy()
        for index, new in self.renewed.items():
            side = pairing.sides[index]
            out = side.face.normals(side.facet, side.t)
            behind = new.on_curve(side.facet + side.t) - side.face.points(side.facet, side.t)
            depth[index] += np.einsum("ni,ni->n", behind, out)
        return depth


def _between_jumps(at: np.ndarray) -> list[slice]:
    """Ranges of increasing positions (n,) between those that occur twice."""
    ends = [0, *(np.flatnonzero(np.diff(at) <= _TWICE) + 1), len(at)]
    return [slice(*ends) for ends in itertools.pairwise(ends)]


def _interpolated(before: np.ndarray, values: np.ndarray, after: np.ndarray) -> np.ndarray:
    curve = scipy.interpolate.Akima1DInterpolator(before, values, axis=-1, method="makima")
    return curve(np.clip(after, before[0], before[-1]))


def along(pairing: Pairing) -> np.ndarray:
    """Positions of the contact points on the face of body 1.

    Facet plus parameter, shape (n,); on a surface the facet and both parameters, shape (n, 3).
    """
    side = pairing.sides[0]
    if isinstance(side.face, Surface):
        return np.column_stack([side.facet, side.t])
    return side.facet + side.t

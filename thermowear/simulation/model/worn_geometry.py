"""What is known of meshes that have been moved to their worn faces."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.interpolate import Akima1DInterpolator

from ...contact.search.pairing import PairedFace, Pairing
from ...contact.search.refinement import Rule
from ...contact.search.surface import Surface
from ...geometry.mesh.tagged import TaggedMesh
from ...geometry.moving.new_face import NewFace

_SAME = 1e-9


@dataclass(frozen=True)
class WornGeometry:
    """Meshes moved to the worn faces, and the depths that are in them and no more in the gap.

    Attributes
    ----------
    mesh : TaggedMesh
        The mesh as it is now.
    directions : tuple of ndarray, shape (n_nodes, 2)
        Ways of the nodes of both faces, see `contact.worn_face.Paths`.
    held : tuple of ndarray of bool, shape (n_nodes,)
        Likewise.
    sizes : tuple of ndarray, shape (n_facets,)
        Lengths of the facets of both faces when they were meshed [m].
    best : ndarray, shape (2,)
        Smallest scaled Jacobian of the cells of both bodies when they were meshed.
    at : ndarray, shape (n_before,) or (n_before, 3)
        Places on the face of body 1 of the contact points before the last update, see `along`.
    depth : ndarray, shape (2, n_before)
        Depth off each body that the mesh has lost, at these points [m].
    lacking : ndarray, shape (n_before,)
        Depth that the initial shape lacks of the unworn face [m].
    holder : tuple of ndarray, shape (3,)
        Translation and rotation of body 1 when the faces were paired anew [m, rad].
    lost : ndarray, shape (2,)
        Volume that each mesh has lost [m³].
    updates : int
        How often the mesh was moved.
    quality : float
        Smallest scaled Jacobian of its cells so far.
    pieces : Rule or None
        Of surfaces, and of sections with contact point by point at the edge of the wear: contact
        points stay where they are on their facets. None where a section is paired anew.
    volume_error : float
        Largest difference so far of what a mesh has lost in an update and the volume worn off,
        relative to what is lost so far.
    renewed : dict of int to NewFace
        Faces that the last update has divided anew, by index of the body. Their depth is that of
        the smooth curve through the nodes of the former face.
    change : float
        Largest change so far of pressure and temperatures by an update, relative to their means.
    heat_error : float
        Largest error so far of temperatures carried over, relative to the largest rise.
    meshed_anew : int
        How often a body was meshed anew, as its cells had become slanted.
    carrying_error : float
        Largest error so far of depths carried over to faces meshed anew, relative to the largest.
    """

    mesh: TaggedMesh
    directions: tuple[np.ndarray, ...]
    held: tuple[np.ndarray, ...]
    sizes: tuple[np.ndarray, ...]
    best: np.ndarray
    at: np.ndarray
    depth: np.ndarray
    lacking: np.ndarray
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
        """Values (..., n_before) at the points of a new pairing of the same faces."""
        return carried(values, self.at, pairing)

    def moved(self, pairing: Pairing) -> np.ndarray:
        """Depths off both bodies that the mesh has lost at the points of a pairing, (2, n) [m]."""
        depth = self.carried(self.depth, pairing)
        for index, new in self.renewed.items():
            depth[index] += behind(pairing.sides[index], new)
        return depth


def behind(side: PairedFace, new: NewFace) -> np.ndarray:
    """How far a face divided anew lies behind the curve that it is on, at points of it [m]."""
    on_curve = new.on_curve(side.facet + side.t)
    out = side.face.normals(side.facet, side.t)
    return np.einsum("ni,ni->n", on_curve - side.face.points(side.facet, side.t), out)


def along(pairing: Pairing) -> np.ndarray:
    """Where on the face of body 1 the contact points lie.

    Facet plus parameter, shape (n,); on a surface the facet and both parameters, shape (n, 3).
    """
    side = pairing.sides[0]
    if isinstance(side.face, Surface):
        return np.column_stack([side.facet, side.t])
    return side.facet + side.t


def carried(values: np.ndarray, before: np.ndarray, pairing: Pairing) -> np.ndarray:
    """Values (..., n) at places of a face, see `along`, at the points of another pairing."""
    after = along(pairing)
    if before.shape == after.shape and np.abs(before - after).max() < _SAME:
        return values
    curve = Akima1DInterpolator(before, values, axis=-1, method="makima")
    return curve(np.clip(after, before[0], before[-1]))

"""State of meshes that have been moved to the worn faces."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field, replace

import numpy as np
import scipy

from ...contact.faces.face import Surface
from ...contact.search.pairing import Contacts, Pairing
from ...contact.search.refinement import Rule
from ...geometry.mesh.mixed import AnyMesh
from ...geometry.moving.new_face import NewFace
from ...laws.motions import RigidMotion

_SAME = 1e-9
_TWICE = 1e-12
"""Largest distance of the same position on two facets, relative to a facet."""


@dataclass(frozen=True)
class WornContact:
    """Faces of an interface on moved meshes, and the wear depths transferred from its gap to them.

    Attributes
    ----------
    directions : tuple of ndarray, shape (n_nodes, gdim)
        Motion directions of the nodes of both faces, see `contact.wear.worn_face.Paths`.
    held : tuple of ndarray of bool, shape (n_nodes,)
        Nodes of both faces that are held fixed, see there.
    sizes : tuple of ndarray, shape (n_facets,)
        Lengths of the facets of both faces in the initial mesh [m].
    at : ndarray, shape (n_before,) or (n_before, 3)
        Positions on the carrying face of the contact points before the last update, see `along`.
    depth : ndarray, shape (2, n_before)
        Wear depth removed from the mesh behind each face at these points [m].
    missing_shape : ndarray, shape (n_before,)
        Depth of the initial shape that the initial mesh does not contain [m].
    lost : ndarray, shape (2,)
        Volume removed from the mesh behind each face [m³].
    pieces : Rule or None
        Quadrature of surfaces, and of sections with pointwise contact at the edge of the wear:
        contact points keep their positions on the facets. None where a section is paired again.
    carrier : int
        Side whose facets carry the contact points, see `Pairing`.
    renewed : dict of int to NewFace
        Faces redivided by the last update, by side. Their depth is that of the smooth curve through
        the nodes of the former face.
    """

    directions: tuple[np.ndarray, ...]
    held: tuple[np.ndarray, ...]
    sizes: tuple[np.ndarray, ...]
    at: np.ndarray
    depth: np.ndarray
    missing_shape: np.ndarray
    lost: np.ndarray
    pieces: Rule | None
    carrier: int
    renewed: dict[int, NewFace] = field(default_factory=dict)

    @property
    def exchanged(self) -> WornContact:
        """Interface with the bodies in the other order."""
        return replace(
            self,
            directions=self.directions[::-1],
            held=self.held[::-1],
            sizes=self.sizes[::-1],
            depth=self.depth[::-1],
            lost=self.lost[::-1],
            carrier=1 - self.carrier,
            renewed={1 - side: new for side, new in self.renewed.items()},
        )

    @property
    def is_moved(self) -> bool:
        """True if the mesh behind one of the faces has been moved."""
        return bool(np.any(self.depth != 0.0))

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
        for side, new in self.renewed.items():
            paired = pairing.sides[side]
            out = paired.face.normals(paired.facet, paired.t)
            on_face = paired.face.points(paired.facet, paired.t)
            behind = new.on_curve(paired.facet + paired.t) - on_face
            depth[side] += np.einsum("ni,ni->n", behind, out)
        return depth


@dataclass(frozen=True)
class WornGeometry:
    """Meshes moved to the worn faces of all bodies.

    Attributes
    ----------
    mesh : TaggedMesh or MixedMesh
        Present mesh.
    contacts : tuple of WornContact
        Faces of the interfaces.
    motions : tuple of tuple of ndarray, shape (3,)
        Translation and rotation of each body at the last pairing of the faces [m, rad].
    best : ndarray, shape (n_bodies,)
        Smallest scaled Jacobian of the cells of each body in the initial mesh.
    updates : int
        Number of mesh motions.
    quality : float
        Smallest scaled Jacobian of the cells so far.
    volume_error : float
        Largest difference so far of the volume removed in an update and the wear volume, relative
        to the volume removed so far.
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
    contacts: tuple[WornContact, ...]
    motions: tuple[tuple[np.ndarray, np.ndarray], ...]
    best: np.ndarray
    updates: int
    quality: float
    volume_error: float
    change: float = 0.0
    heat_error: float = 0.0
    meshed_anew: int = 0
    carrying_error: float = 0.0

    @property
    def lost(self) -> np.ndarray:
        """Volumes removed from the meshes behind both faces, shape (n_interfaces, 2) [m³]."""
        return np.array([contact.lost for contact in self.contacts])

    @property
    def keeps_points(self) -> bool:
        """True if the contact points keep their positions on the facets."""
        return all(contact.pieces is not None for contact in self.contacts)

    @property
    def placements(self) -> list[RigidMotion]:
        """Motions of the bodies at the last pairing of the faces."""
        return [RigidMotion(*motion, np.zeros(3)) for motion in self.motions]

    def relative_motion(self, bodies: tuple[int, int]) -> RigidMotion:
        """Motion of the first of two bodies relative to the second one at this pairing."""
        first, second = (self.motions[body] for body in bodies)
        return RigidMotion(first[0] - second[0], first[1] - second[1], np.zeros(3))

    def carried(self, values: np.ndarray, contacts: Contacts) -> np.ndarray:
        """Values (..., n_before) at the points of new pairings, see `WornContact.carried`."""
        ends = np.cumsum([len(contact.at) for contact in self.contacts])
        parts = zip(self.contacts, np.split(values, ends[:-1], axis=-1), contacts.each, strict=True)
        return np.concatenate([one.carried(part, pairing) for one, part, pairing in parts], axis=-1)

    def moved(self, contacts: Contacts) -> np.ndarray:
        """Wear depths removed from the meshes at the points of pairings, shape (2, n) [m]."""
        pairs = zip(self.contacts, contacts.each, strict=True)
        return np.concatenate([one.moved(pairing) for one, pairing in pairs], axis=1)


def _between_jumps(at: np.ndarray) -> list[slice]:
    """Ranges of increasing positions (n,) between those that occur twice."""
    ends = [0, *(np.flatnonzero(np.diff(at) <= _TWICE) + 1), len(at)]
    return [slice(*ends) for ends in itertools.pairwise(ends)]


def _interpolated(before: np.ndarray, values: np.ndarray, after: np.ndarray) -> np.ndarray:
    curve = scipy.interpolate.Akima1DInterpolator(before, values, axis=-1, method="makima")
    return curve(np.clip(after, before[0], before[-1]))


def along(pairing: Pairing) -> np.ndarray:
    """Positions of the contact points on the face that carries them.

    Facet plus parameter, shape (n,); on a surface the facet and both parameters, shape (n, 3).
    """
    side = pairing.carrying
    if isinstance(side.face, Surface):
        return np.column_stack([side.facet, side.t])
    return side.facet + side.t

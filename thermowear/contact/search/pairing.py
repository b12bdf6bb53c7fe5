"""Contact points of one interface, and of all interfaces of a model.

Sign convention (the only place where it is stated)
---------------------------------------------------
``n`` is the normal of the common face, see `common_face`, outward from body 1, the held body.
Positive gaps are open::

    g = g0 + (u2 - u1)·n

Pressure ``p >= 0`` and sliding friction act as the traction ``-p (n + mu e)`` on body 1 and the
opposite on body 2, with the unit direction ``e`` of sliding of body 1 over body 2. The nodal loads
of a pressure are ``B_tᵀ w p``, ``B_t u = (u2 - u1)·(n + mu e)``; without friction in the section
that is ``B u = (u2 - u1)·n``. The holder moves body 1 by ``m d``, where ``m`` is a unit rigid
motion along its load; that changes the gap by ``-R d`` with ``R = m·n``, and the load ``F`` is in
equilibrium when ``Tᵀ w p = F`` with ``T = m·(n + mu e)``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ...bulk.kinematics import Kinematics
from ...errors import CaseError
from ..faces.face import Face, Surface
from .common_face import opposite, stretch
from .refinement import OVERHANG_TOLERANCE, SLIVER, Rule, ambiguity_message, rule

_COINCIDENCE_TOLERANCE = 1e-10
"""Largest distance of coincident points, relative to the size of the face."""
_AT_EDGE = 1e-2
"""Largest distance of points at the edge of a facet, relative to it."""
_ROUNDING, _MAX_OVERLAP = 1e-3, 0.2
"""Fraction of a facet that may be covered twice, by rounding and curved edges, without notice; and
by normals that turn within distorted facets; any on facets that are shorter than the gap."""


@dataclass(frozen=True)
class PairedFace:
    """Positions of the contact points on one face.

    Attributes
    ----------
    face : Face or Surface
    facet : ndarray of int, shape (n,)
    t : ndarray, shape (n,), on a surface (n, 2)
        Parameters.
    """

    face: Face | Surface
    facet: np.ndarray
    t: np.ndarray

    @property
    def points(self) -> np.ndarray:
        """Coordinates, shape (n, gdim) [m]."""
        return self.face.points(self.facet, self.t)

    @property
    def position(self) -> np.ndarray:
        """Arc length along the face, shape (n,), NaN on a surface [m]."""
        return self.face.position(self.facet, self.t)


@dataclass(frozen=True)
class Pairing:
    """Contact points; in a plane model, in order along the face that carries them.

    Attributes
    ----------
    points : ndarray, shape (n, gdim) [m]
        Points on the common face.
    weights : ndarray, shape (n,)
        Area of the common face at each point [m²].
    normals : ndarray, shape (n, gdim)
        Unit normals of the common face, outward from body 1.
    gap : ndarray, shape (n,)
        Gap of the unloaded, unworn bodies along the normal [m].
    share : ndarray, shape (n,)
        s_1: share of body 1 in the approach of opposite points.
    sides : tuple of PairedFace
        Points on body 1 and on body 2.
    unpaired : float
        Fraction of the carrying face without an opposite face, which cannot touch.
    groups : ndarray of int, shape (2, n)
        Group of equally wearing materials of body 1 and of body 2 at each point. Points at a border
        of groups exist once for each.
    pieces : Rule
        Quadrature rule on all pieces of the facets of the carrying face, and the points merged from
        it.
    carrier : int
        Side (0 or 1) whose facets carry the points and the pressure space.
    """

    points: np.ndarray
    weights: np.ndarray
    normals: np.ndarray
    gap: np.ndarray
    share: np.ndarray
    sides: tuple[PairedFace, PairedFace]
    unpaired: float
    groups: np.ndarray
    pieces: Rule
    carrier: int = 0

    @property
    def carrying(self) -> PairedFace:
        """Points on the face whose facets carry them and the pressure space."""
        return self.sides[self.carrier]

    @property
    def opposite(self) -> PairedFace:
        """Points on the other face."""
        return self.sides[1 - self.carrier]

    @property
    def outward(self) -> np.ndarray:
        """Unit normals of the common face, outward from the carrying body, shape (n, gdim)."""
        return -self.normals if self.carrier else self.normals

    @property
    def exchanged(self) -> Pairing:
        """Pairing of the same points with the bodies in the other order."""
        first, second = self.sides
        return replace(
            self,
            normals=-self.normals,
            share=1.0 - self.share,
            sides=(second, first),
            groups=self.groups[::-1],
            carrier=1 - self.carrier,
        )

    @property
    def extent(self) -> float:
        """Size of the carrying face [m]."""
        return self.carrying.face.extent

    @property
    def position(self) -> np.ndarray:
        """Arc length along the face of body 1 from its first end, shape (n,), NaN on a surface [m].

        For output: the points are in order along the carrying face, which may begin elsewhere.
        """
        return self.sides[0].position

    @property
    def on_body_1(self) -> np.ndarray:
        """Contact points on the face of body 1, shape (n, gdim) [m]."""
        return self.sides[0].points

    @property
    def on_body_2(self) -> np.ndarray:
        """Contact points on the face of body 2, shape (n, gdim) [m]."""
        return self.sides[1].points

    def locate(self, position) -> np.ndarray:
        """Coordinates of positions along the face of a plane body, shape (n, 2) [m]."""
        columns = [np.interp(position, self.position, x) for x in self.points.T]
        return np.column_stack(columns)


def with_carrying_face(pairing: Pairing, face: Face | Surface) -> Pairing:
    """Pairing of the same points with another place of the carrying face."""
    own, other = replace(pairing.carrying, face=face), pairing.opposite
    return replace(pairing, sides=(other, own) if pairing.carrier else (own, other))


def pair(
    face_1: Face | Surface,
    face_2: Face | Surface,
    kinematics: Kinematics,
    order: int,
    refine: bool = True,
    sliver: float = SLIVER,
    max_overhang: float = OVERHANG_TOLERANCE,
    comm=None,
    carrier: int = 0,
) -> Pairing:
    """Pair two faces on their common refinement.

    The facets of the carrying face are cut at the ends of facets of the other one, see
    `refinement`. Each piece has a Gauss-Lobatto rule; points shared by pieces are merged.

    Parameters
    ----------
    face_1, face_2 : Face or Surface
    kinematics : thermowear.bulk.kinematics.Kinematics
    order : int
        Points per piece, on a surface per direction; the rule is exact to degree
        ``2 order - 3``.
    refine : bool
        False: no cuts, one rule per facet of the carrying face.
    sliver : float
        Smallest distance of a cut from the ends of a facet, relative to it; plane models only.
    max_overhang : float
        Linear extrapolation of body 2 beyond its ends, relative to the face; plane models only.
    comm : mpi4py.MPI.Comm, optional
        Ranks that share the work, each with both faces; every rank calls.
    carrier : int, optional
        Side whose facets carry the points, see `common_face.carrying_side`.

    Raises
    ------
    CaseError
        If no point of body 1 faces body 2, or it is not clear which points meet.
    """
    if carrier:
        given = kinematics, order, refine, sliver, max_overhang, comm
        return pair(face_2, face_1, *given).exchanged
    pieces = rule(face_1, face_2, order, refine, sliver, max_overhang)
    if len(pieces.facet) == 0:
        raise CaseError(
            f"geometry.contact: {face_1.name} and {face_2.name} do not lie opposite each other; "
            "their outward normals must point against each other where they are to touch"
        )
    return paired(face_1, face_2, kinematics, pieces, comm)


def paired(
    face_1: Face | Surface,
    face_2: Face | Surface,
    kinematics: Kinematics,
    pieces: Rule,
    comm=None,
) -> Pairing:
    """Pair two faces at given points of the face of body 1, merging coincident points.

    Points merged before stay merged. Parameters as in `pair`.
    """
    facet, t = pieces.facet, pieces.t
    on_face = face_1.points(facet, t)
    pairs = opposite(face_1, facet, t, face_2, comm)
    weights = pieces.weight * stretch(face_1, facet, t, face_2, pairs)
    on_common = on_face + pairs.share[:, None] * pairs.offset
    weights *= np.maximum(kinematics.area_factor(on_common), 0.0)  # rounding on the axis
    covered: np.ndarray = np.bincount(
        facet, pieces.weight / face_1.measure, minlength=len(face_1.sizes)
    )
    if covered.max() > 1.0 + _ROUNDING:
        nearest = np.full(len(covered), np.inf)
        np.minimum.at(nearest, facet, np.abs(pairs.gap))
        # the opposite points of facets far apart are those of their continuation: not unique
        if np.any((covered > 1.0 + _MAX_OVERLAP) & (nearest <= face_1.lengths)):
            raise CaseError(ambiguity_message(face_1, face_2))
        share = 1 / np.maximum(covered, 1.0)
        pieces = replace(pieces, weight=pieces.weight * share[facet])
        weights, covered = weights * share[facet], covered * share
    unpaired = 1.0 - float(covered @ face_1.sizes / face_1.sizes.sum())
    groups, point = _groups(face_1, facet, t, face_2.group_at(pairs.facet)), pieces.point
    if point is None:
        # on a curve by arc length: both ends of a closed one coincide in space
        places = on_face if isinstance(face_1, Surface) else face_1.position(facet, t)[:, None]
        point = _merged(places, _COINCIDENCE_TOLERANCE * face_1.extent, groups)
    _, first = np.unique(point, return_index=True)
    summed = np.column_stack([np.bincount(point, n) for n in pairs.normals.T])
    normals = summed / np.linalg.norm(summed, axis=1, keepdims=True)
    sides = (
        PairedFace(face_1, facet[first], t[first]),
        PairedFace(face_2, pairs.facet[first], pairs.t[first]),
    )
    return Pairing(
        points=on_common[first],
        weights=np.bincount(point, weights),
        normals=normals,
        gap=pairs.gap[first],
        share=pairs.share[first],
        sides=sides,
        unpaired=max(unpaired, 0.0),
        groups=groups[:, first],
        pieces=replace(pieces, point=point),
    )


def _groups(
    face_1: Face | Surface, facet: np.ndarray, t: np.ndarray, opposite_group: np.ndarray
) -> np.ndarray:
    """Groups of the materials of body 1 and of body 2 at points (n,), shape (2, n).

    Both are those of the facet of body 1: its inner points lie opposite to one group of body 2.

    Raises
    ------
    CaseError
        If they lie opposite to several.
    """
    if not opposite_group.any():
        return np.array([face_1.group_at(facet), opposite_group])
    t = t.reshape(len(t), -1)
    inner = np.all((t > _AT_EDGE) & (t < 1 - _AT_EDGE), axis=1)
    if face_1.kind == "triangle":
        inner &= t.sum(axis=1) < 1 - _AT_EDGE
    low, high = np.full(len(face_1.nodes), opposite_group.max()), np.zeros(len(face_1.nodes), int)
    np.minimum.at(low, facet[inner], opposite_group[inner])
    np.maximum.at(high, facet[inner], opposite_group[inner])
    if np.any(low[facet] < high[facet]):
        raise CaseError(
            f"geometry.contact: elements of {face_1.name} lie across a border between materials of "
            "the other face that wear by different laws; end elements of both faces at the border"
        )
    return np.array([face_1.group_at(facet), low[facet]])


def _merged(points: np.ndarray, near: float, groups: np.ndarray) -> np.ndarray:
    """Merge coincident points (n, gdim) of the same groups of materials.

    Returns
    -------
    ndarray of int, shape (n,)
        Merged point of each, numbered in the order of appearance.
    """
    pairs = cKDTree(points).query_pairs(near, output_type="ndarray")
    pairs = pairs[np.all(groups[:, pairs[:, 0]] == groups[:, pairs[:, 1]], axis=0)]
    links = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(points), len(points)))
    _, label = connected_components(links, directed=False)
    _, first, group = np.unique(label, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    return rank[group]


@dataclass(frozen=True)
class Contacts:
    """Pairings of all interfaces; arrays list their points one interface after the other.

    Attributes
    ----------
    each : tuple of Pairing
    bodies : tuple of tuple of int
        Indices of the first and of the second body of each interface.
    """

    each: tuple[Pairing, ...]
    bodies: tuple[tuple[int, int], ...] = ((0, 1),)

    def __iter__(self) -> Iterator[tuple[Pairing, slice]]:
        """Pairings with the ranges of their points."""
        return zip(self.each, self.ranges, strict=True)

    @property
    def only(self) -> Pairing:
        """Pairing of a single interface.

        Raises
        ------
        CaseError
            If there are several.
        """
        if len(self.each) > 1:
            raise CaseError(
                f"the model has {len(self.each)} interfaces; what is asked for is supported for "
                "one interface only"
            )
        return self.each[0]

    @cached_property
    def ranges(self) -> tuple[slice, ...]:
        """Range of the points of each interface."""
        counts = [len(pairing.weights) for pairing in self.each]
        return tuple(slice(a, b) for a, b in pairwise([0, *np.cumsum(counts)]))

    @cached_property
    def points(self) -> np.ndarray:
        """Points on the common faces, shape (n, gdim) [m]."""
        return self._joined("points")

    @cached_property
    def position(self) -> np.ndarray:
        """Arc length along the face of the first body of the interface, shape (n,) [m]."""
        return self._joined("position")

    @cached_property
    def weights(self) -> np.ndarray:
        """Area at each point, shape (n,) [m²]."""
        return self._joined("weights")

    @cached_property
    def normals(self) -> np.ndarray:
        """Unit normals outward from the first body of the interface, shape (n, gdim)."""
        return self._joined("normals")

    @cached_property
    def gap(self) -> np.ndarray:
        """Gap of the unloaded, unworn bodies, shape (n,) [m]."""
        return self._joined("gap")

    @cached_property
    def on_body_1(self) -> np.ndarray:
        """Points on the face of the first body of the interface, shape (n, gdim) [m]."""
        return self._joined("on_body_1")

    @cached_property
    def on_body_2(self) -> np.ndarray:
        """Points on the face of the second body of the interface, shape (n, gdim) [m]."""
        return self._joined("on_body_2")

    @cached_property
    def facets(self) -> sp.csr_array:
        """Points on each facet of the carrying faces, bool (n_facets, n).

        One interface after the other. A point between facets is on each of them, so that which one
        comes first does not matter.
        """
        return sp.csr_array(sp.block_diag([_on_facets(p) for p in self.each], format="csr"))

    @cached_property
    def carriers(self) -> np.ndarray:
        """Side (0 or 1) of the face of each interface that carries the points."""
        return np.array([pairing.carrier for pairing in self.each])

    def by_side(self, values: np.ndarray) -> np.ndarray:
        """Values of the first and of the second faces from those of the carrying and of the others.

        By interface or by point, (2, n_interfaces) or (2, n).
        """
        each = values.shape[1] == len(self.each)
        second = self.carriers if each else self.per_point(self.carriers)
        return np.where(second == 0, values, values[::-1])

    @cached_property
    def in_space(self) -> bool:
        """True for bodies in space."""
        return isinstance(self.each[0].sides[0].face, Surface)

    def per_point(self, values) -> np.ndarray:
        """Values by interface at the points, shape (n,)."""
        counts = [len(pairing.weights) for pairing in self.each]
        return np.repeat(np.asarray(values, dtype=float), counts)

    def of_body(self, index: int) -> list[tuple[int, slice]]:
        """Sides (0 or 1) and ranges of the points at which a body is in contact."""
        parts = zip(self.bodies, self.ranges, strict=True)
        return [(pair.index(index), points) for pair, points in parts if index in pair]

    def _joined(self, name: str) -> np.ndarray:
        return _concatenated([getattr(pairing, name) for pairing in self.each])


def _on_facets(pairing: Pairing) -> sp.csr_array:
    """Points on each facet of the carrying face, bool (n_facets, n)."""
    pieces, shape = pairing.pieces, (len(pairing.carrying.face.sizes), len(pairing.weights))
    ones = np.ones(len(pieces.facet), dtype=bool)
    return sp.csr_array((ones, (pieces.facet, pieces.point)), shape=shape)


def _concatenated(parts: list[np.ndarray]) -> np.ndarray:
    return parts[0] if len(parts) == 1 else np.concatenate(parts)

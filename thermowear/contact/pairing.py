"""Contact points: where both faces are compared, with what weight, and which way is up.

Sign convention (the only place where it is stated)
---------------------------------------------------
``n`` is the outward normal of body 1, the held body. The gap is open where positive::

    g = g0 + (u2 - u1)·n

A pressure ``p >= 0`` presses and sliding friction drags: traction ``-p (n + mu e)`` on body 1 and
the opposite on body 2, where ``e`` is the unit direction in which body 1 slides over body 2. The
nodal loads of a pressure are ``B_tᵀ w p``, ``B_t u = (u2 - u1)·(n + mu e)``; where there is no
friction in the section that is ``B u = (u2 - u1)·n``. The holder moves body 1 by ``m d``, where
``m`` is a unit rigid motion along its load; that changes the gap by ``-R d`` with ``R = m·n``, and
the load ``F`` is in equilibrium when ``Tᵀ w p = F`` with ``T = m·(n + mu e)``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..bulk.kinematics import Model
from ..errors import CaseError
from .face import Face
from .quadrature import lobatto


@dataclass(frozen=True)
class Side:
    """Where the contact points lie on one face: facet and parameter, shape (n,) each."""

    face: Face
    facet: np.ndarray
    t: np.ndarray


@dataclass(frozen=True)
class Pairing:
    """The contact points, in order along the face of body 1.

    Attributes
    ----------
    points : ndarray, shape (n, 2) [m]
    position : ndarray, shape (n,)
        Length along the face from its first end [m].
    weights : ndarray, shape (n,)
        Area each point stands for [m²].
    normals : ndarray, shape (n, 2)
        Outward unit normals of body 1.
    gap : ndarray, shape (n,)
        Of the unloaded, unworn bodies along the normal [m].
    sides : tuple of Side
        On body 1 and body 2.
    unpaired : float
        Part of the face of body 1 that has nothing opposite and cannot touch.
    """

    points: np.ndarray
    position: np.ndarray
    weights: np.ndarray
    normals: np.ndarray
    gap: np.ndarray
    sides: tuple[Side, Side]
    unpaired: float

    def locate(self, position) -> np.ndarray:
        """Coordinates of positions along the face, shape (n, 2) [m]."""
        columns = [np.interp(position, self.position, x) for x in self.points.T]
        return np.column_stack(columns)


def pair(face_1: Face, face_2: Face, model: Model, order: int, refine: bool = True) -> Pairing:
    """Pair two faces on their common refinement.

    The facets of body 1 are cut where facets of body 2 end, so that everything that is smooth
    between the ends of elements is integrated accurately, whether the faces match or not. Each
    piece gets a Gauss-Lobatto rule; points that two pieces share are merged.

    Parameters
    ----------
    face_1, face_2 : Face
    model : thermowear.bulk.kinematics.Model
    order : int
        Points on each piece; the rule is exact to degree ``2 order - 3``.
    refine : bool
        False: the facets of body 1 are not cut, each has the points of one rule.

    Raises
    ------
    CaseError
        If no point of body 1 faces body 2.
    """
    whole = [np.array([0.0, 1.0])] * len(face_1.nodes)
    cuts = _common_refinement(face_1, face_2) if refine else whole
    facet, t, weight = _rule_on_pieces(cuts, order)
    speed = np.linalg.norm(face_1.tangents(facet, t), axis=1)
    points = face_1.points(facet, t)
    weights = weight * speed * model.area_factor(points)
    normals = face_1.normals(facet, t)
    other, other_t, offset = project(face_2, points)
    beside = _beside(face_2, other, other_t, offset).reshape(-1, order)
    # whole pieces: the end of one outside the contact is a point of the next one inside
    inner = beside[:, 1:-1] if order > 2 else beside
    facing = np.repeat(inner.max(axis=1) <= 1e-9 * _extent(face_1), order)
    if not facing.any():
        raise CaseError("geometry: the contact faces do not lie opposite each other")
    lengths = np.bincount(facet, weight * speed, minlength=len(face_1.nodes))
    start = np.concatenate([[0.0], np.cumsum(lengths)])
    position = start[facet] + _length_within(face_1, facet, t)
    gap = np.einsum("ni,ni->n", offset, normals)
    unpaired = 1.0 - float(np.sum((weight * speed)[facing]) / lengths.sum())
    columns = (points, position, weights, normals, gap, facet, t, other, other_t)
    merged = _merge(*(column[facing] for column in columns))
    points, position, weights, normals, gap, facet, t, other, other_t = merged
    sides = (Side(face_1, facet, t), Side(face_2, other, other_t))
    return Pairing(points, position, weights, normals, gap, sides, max(unpaired, 0.0))


def project(face: Face, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Closest points of a face.

    Parameters
    ----------
    face : Face
    points : ndarray, shape (n, 2) [m]

    Returns
    -------
    facet, t : ndarray, shape (n,)
    offset : ndarray, shape (n, 2)
        From each point to its projection [m].
    """
    a, b = face.nodes[:, 0], face.nodes[:, -1]
    chord = b - a
    along = np.einsum("nfi,fi->nf", points[:, None] - a, chord) / (chord**2).sum(axis=1)
    along = np.clip(along, 0.0, 1.0)
    distance = np.linalg.norm(a + along[..., None] * chord - points[:, None], axis=2)
    nearest = distance.argmin(axis=1)
    # the nearest chord may belong to a neighbour of the nearest curved facet
    trials = [_project_on(face, points, np.clip(nearest + k, 0, len(a) - 1)) for k in (0, -1, 1)]
    best = np.argmin([np.linalg.norm(trial[2], axis=1) for trial in trials], axis=0)
    facet, t = (np.choose(best, [trial[k] for trial in trials]) for k in (0, 1))
    return facet, t, face.points(facet, t) - points


def _project_on(face: Face, points: np.ndarray, facet: np.ndarray):
    """Closest points of given facets: parameter and offset, by Newton's method from the chord."""
    start, end = face.nodes[facet, 0], face.nodes[facet, -1]
    chord = end - start
    t = ((points - start) * chord).sum(axis=1) / (chord**2).sum(axis=1)
    t = np.clip(t, 0.0, 1.0)
    for _ in range(0 if face.nodes.shape[1] == 2 else 20):
        offset, tangent = face.points(facet, t) - points, face.tangents(facet, t)
        step = (offset * tangent).sum(axis=1) / (tangent**2).sum(axis=1)
        t = np.clip(t - step, 0.0, 1.0)
    return facet, t, face.points(facet, t) - points


def _common_refinement(face_1: Face, face_2: Face) -> list[np.ndarray]:
    """Parameters at which each facet of body 1 is cut, its own ends included."""
    ends = np.concatenate([face_2.nodes[:, 0], face_2.nodes[-1:, -1]])
    facet, t, _ = project(face_1, ends)
    cuts = []
    for f in range(len(face_1.nodes)):
        inner = np.sort(t[facet == f])
        inner = inner[(inner > 1e-9) & (inner < 1 - 1e-9)]
        if len(inner):
            inner = inner[np.concatenate([[True], np.diff(inner) > 1e-9])]
        cuts.append(np.concatenate([[0.0], inner, [1.0]]))
    return cuts


def _rule_on_pieces(cuts: list[np.ndarray], order: int):
    """Facet, parameter and parameter weight of every point of every piece."""
    x, w = lobatto(order)
    start = np.concatenate([c[:-1] for c in cuts])
    size = np.concatenate([np.diff(c) for c in cuts])
    facet = np.repeat(np.arange(len(cuts)), [len(c) - 1 for c in cuts])
    t = start[:, None] + size[:, None] * x
    return np.repeat(facet, order), t.ravel(), (size[:, None] * w).ravel()


def _length_within(face: Face, facet: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Length of each facet from its start to t [m]."""
    x, w = lobatto(face.nodes.shape[1] + 4)
    at = (t[:, None] * x).ravel()
    speed = np.linalg.norm(face.tangents(np.repeat(facet, len(x)), at), axis=1)
    return t * (speed.reshape(-1, len(x)) @ w)


def _merge(points, position, weights, normals, *rest):
    """One point for those that neighbouring pieces share: weights added, normals averaged."""
    first = np.concatenate([[True], np.diff(position) > 1e-10 * (position[-1] - position[0])])
    group = np.cumsum(first) - 1
    normal = np.column_stack([np.bincount(group, normals[:, i]) for i in range(2)])
    normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    kept = (column[first] for column in rest)
    return points[first], position[first], np.bincount(group, weights), normal, *kept


def _beside(face: Face, facet: np.ndarray, t: np.ndarray, offset: np.ndarray) -> np.ndarray:
    """How far each point lies beside its closest point: more than 0 beyond the face's ends [m]."""
    tangent = face.tangents(facet, t)
    return np.abs((offset * tangent).sum(axis=1)) / np.linalg.norm(tangent, axis=1)


def _extent(face: Face) -> float:
    return float(np.ptp(face.nodes.reshape(-1, 2), axis=0).max())

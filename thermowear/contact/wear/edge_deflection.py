"""Deflection of the faces at the edge of the wear that full systems of elements do not resolve.

Where the edge of the wear crosses a facet its points are reached one by one. Each begins to press
at once, and takes over in the time in which its wear catches up with the deflection of the bodies.
For elements that deflection is a polynomial on the facet: under a point that begins to press it
lifts others, and presses these by a part of the pressure that no finer mesh makes smaller.

A pressure is as rough as that where it leaves the pressure space Ψ. What is left, ``p - Π p``, is
shorter than any wave of that space; half-spaces yield to it about as they do to the shortest of
these, whose compliance is ε. So the faces have a deflection v of their own at these points::

    gap = g + B u - R d + v,    v = ε (p - Π p):    min ½ ∫ v²/ε,    ∫ Ψ v = 0

These are motions on springs. Where faces fit and the pressure is smooth, as it is behind the edge,
v is zero, and as elements become smaller so does ε. The pressure is that of the condensed method
at such points, see `wear_edge`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import null_space

from ...bulk.mechanics.elasticity import Elasticity
from ..operators.traction import at_points
from ..search.pairing import Pairing


@dataclass(frozen=True)
class EdgeDeflection:
    """Motions of points of the faces on springs.

    Attributes
    ----------
    modes : ndarray, shape (n, k)
        How much a unit of each closes the gap at the points.
    stiffness : ndarray, shape (k, k)
        Generalised force of the springs per unit.
    """

    modes: np.ndarray
    stiffness: np.ndarray


def edge_deflection(
    basis: np.ndarray, weights: np.ndarray, points: np.ndarray, compliance: np.ndarray
) -> EdgeDeflection:
    """Deflection of some points that the pressure space does not see.

    Parameters
    ----------
    basis : ndarray, shape (n, m)
        Ψ.
    weights : ndarray, shape (n,) [m²]
    points : ndarray of bool, shape (n,)
        From `wear_edge.edge_points`.
    compliance : ndarray, shape (n,)
        ε [m/Pa].
    """
    moving = points & (weights > 0.0)  # not the point on an axis, which has no area
    root = np.sqrt(weights[moving])
    unseen = null_space((root[:, None] * basis[moving]).T)
    modes = np.zeros((len(points), unseen.shape[1]))
    modes[moving] = unseen / root[:, None]
    return EdgeDeflection(modes, unseen.T @ (unseen / compliance[moving, None]))


def wave_compliance(elastic: Elasticity, pairing: Pairing, degree: int) -> np.ndarray:
    """ε of the shortest waves of a pressure on the facets of body 1, shape (n,) [m/Pa].

    Half-spaces under a pressure ``cos κ x`` are deflected by ``2/(E* κ)`` times that (Johnson,
    Contact Mechanics, 1985, section 13.2); the shortest wave has a sign for each of the `degree`
    parts of a facet of the length h: ``κ = π degree / h``. Every rank calls.
    """
    softness = np.zeros(len(pairing.weights))
    for side in pairing.sides:
        λ, μ = (at_points(function, side) for function in elastic.lame[:2])
        softness += (λ + 2 * μ) / (4 * μ * (λ + μ))
    side = pairing.sides[0]
    return 2 * softness * side.face.sizes[side.facet] / (np.pi * degree)

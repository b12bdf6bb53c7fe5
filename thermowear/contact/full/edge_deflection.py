"""Subgrid deflection of the faces at the edge of the worn zone, for full finite-element systems.

When the edge of the worn zone crosses a facet, its points come into contact one by one. Each takes
up pressure within the time in which its wear catches up with the deflection of the bodies. In
finite elements that deflection is a polynomial on the facet: a newly loaded point displaces the
others, and changes their pressures by a fraction that mesh refinement does not reduce.

Such a pressure is outside of the pressure space Ψ. The remainder ``p - Π p`` has shorter
wavelengths than that space; the response of half-spaces to it is about that to the shortest wave of
Ψ, whose compliance is ε. The faces therefore have a local deflection v at these points::

    gap = g + B u - R d + v,    v = ε (p - Π p):    min ½ ∫ v²/ε,    ∫ Ψ v = 0

These are degrees of freedom on springs. Where faces conform and the pressure is smooth, as behind
the edge, v is zero, and ε decreases with the element size. The pressure agrees with that of the
condensed method at such points, see `wear_edge`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import null_space

from ...bulk.elasticity.elasticity import Elasticity
from ..operators.pressure import Basis, dense, scaled
from ..search.pairing import Pairing
from .nitsche import lame_at_points, on_every_facet


@dataclass(frozen=True)
class EdgeDeflection:
    """Spring-supported degrees of freedom of face points.

    Attributes
    ----------
    modes : ndarray, shape (n, k)
        Gap closure at the points per unit of each.
    stiffness : ndarray, shape (k, k)
        Generalised force of the springs per unit.
    """

    modes: np.ndarray
    stiffness: np.ndarray


def edge_deflection(
    basis: Basis, weights: np.ndarray, points: np.ndarray, compliance: np.ndarray
) -> EdgeDeflection:
    """Deflection of given points, orthogonal to the pressure space.

    Parameters
    ----------
    basis : ndarray or csr_array, shape (n, m)
        Basis Ψ.
    weights : ndarray, shape (n,) [m²]
    points : ndarray of bool, shape (n,)
        Points from `wear_edge.edge_points`.
    compliance : ndarray, shape (n,)
        Compliance ε [m/Pa].
    """
    moving = points & (weights > 0.0)  # without points on an axis, which have no area
    root = np.sqrt(weights[moving])
    orthogonal = null_space(scaled(root, dense(basis[moving])).T)
    modes = np.zeros((len(points), orthogonal.shape[1]))
    modes[moving] = orthogonal / root[:, None]
    return EdgeDeflection(modes, orthogonal.T @ (orthogonal / compliance[moving, None]))


def wave_compliance(elastic: Elasticity, pairing: Pairing, degree: int) -> np.ndarray:
    """Compliance ε of the shortest pressure waves on the carrying facets, shape (n,) [m/Pa].

    The deflection of half-spaces under a pressure ``cos κ x`` is ``2/(E* κ)`` times it (Johnson,
    Contact Mechanics, 1985, section 13.2); the shortest wave has `degree` half-waves on a facet of
    length h: ``κ = π degree / h``, the mean of both between two. Every rank calls.
    """
    side, point, share = on_every_facet(pairing)
    length = np.bincount(point, share * side.face.lengths[side.facet])
    return 2 * softness(elastic, pairing) * length / (np.pi * degree)


def softness(elastic: Elasticity, pairing: Pairing) -> np.ndarray:
    """``1/E*`` of both bodies at the points, shape (n,) [1/Pa]. Every rank calls."""
    found = np.zeros(len(pairing.weights))
    for side in pairing.sides:
        λ, μ, _ = lame_at_points(elastic, side)
        found += (λ + 2 * μ) / (4 * μ * (λ + μ))
    return found

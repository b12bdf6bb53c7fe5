"""Elliptical contact of two smooth bodies without friction (Hertz).

Johnson, Contact Mechanics (1985), sections 3.5 and 4.2. Close to the first point of contact the gap
of the undeformed bodies is ``h = x²/(2 Rx) + y²/(2 Ry)`` along its principal directions; for two
cylinders that cross at right angles the radii are those of the cylinders. The pressure
``p0 √(1 - x²/a² - y²/b²)`` displaces half-spaces by the potential of an ellipsoid::

    u = p0 a b/(2 E*) ∫ (1 - x²/(a² + s) - y²/(b² + s)) ds/√((a² + s)(b² + s) s),   s from 0 to ∞

for both bodies together. The contact is closed where ``u + h`` equals the approach δ. With the
symmetric elliptic integrals RF and RD of Carlson (DLMF, section 19.16)::

    1/(2 Rx) = p0 a b/(3 E*) RD(0, b², a²)
    1/(2 Ry) = p0 a b/(3 E*) RD(0, a², b²)
    δ = p0 a b/E* RF(0, a², b²)

These are equations (4.26) of Johnson, without a difference of elliptic integrals that would vanish
for a circle, and without an order of the half-axes.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, log, pi

import numpy as np
from scipy.optimize import brentq
from scipy.special import elliprd, elliprf

_MOST_SLENDER = 1e6
"""Largest ratio of the half-axes."""


@dataclass(frozen=True)
class EllipticalContact:
    """Contact under a force.

    Attributes
    ----------
    half_axes : tuple of float
        a along x and b along y [m].
    peak : float
        Largest pressure p0 [Pa].
    approach : float
        δ, of distant points of two half-spaces [m].
    """

    half_axes: tuple[float, float]
    peak: float
    approach: float

    def pressure(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Pressure ``p0 √(1 - x²/a² - y²/b²)`` [Pa]."""
        a, b = self.half_axes
        return self.peak * np.sqrt(np.maximum(1 - (x / a) ** 2 - (y / b) ** 2, 0.0))


def elliptical_contact(
    force: float, radii: tuple[float, float], modulus: float
) -> EllipticalContact:
    """Contact of two bodies under a force.

    Parameters
    ----------
    force : float [N]
    radii : tuple of float
        Relative radii of curvature Rx and Ry [m].
    modulus : float
        E* [Pa].

    Raises
    ------
    ValueError
        If the half-axes would differ by a factor of more than a million.
    """
    slenderness = _slenderness(radii[0] / radii[1])
    # p0 a b = 3 F/(2 π) in the equation for Rx, whose RD scales with 1/a³
    a = (force * radii[0] / (pi * modulus) * elliprd(0.0, slenderness**2, 1.0)) ** (1 / 3)
    b = slenderness * a
    peak = 3 * force / (2 * pi * a * b)
    return EllipticalContact((a, b), peak, peak * a * b / modulus * elliprf(0.0, a**2, b**2))


def _slenderness(ratio: float) -> float:
    """Half-axes b/a for a ratio Rx/Ry of the radii."""

    def excess(logarithm: float) -> float:
        square = exp(2 * logarithm)
        return log(elliprd(0.0, 1.0, square) / elliprd(0.0, square, 1.0) / ratio)

    most = log(_MOST_SLENDER)
    return exp(brentq(excess, -most, most, xtol=1e-15, rtol=1e-15))

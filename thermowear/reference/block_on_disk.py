"""Block on a disk, and segment inside a ring, with vertical guidance (special cases 3 and 4).

The block rests on the arc ``start < α < end``, α measured from the vertical; its face descends
at a uniform vertical rate, so that ``p = (F/I) cos^(1/b) α`` with ``I = ∫ cos^(1/b) α (cos α ± mu
sin α) R t dα`` (Páczelt and Mróz, Int. J. Solids Struct. 44 (2007) 895). Plus is a disk under the
block rotating towards decreasing α, or a ring around the segment rotating towards increasing α:
for ``α > 0`` friction then supports part of the load.
"""

from __future__ import annotations

from math import cos, sin

import numpy as np
from scipy.integrate import quad

RADIUS, WIDTH, FORCE, FRICTION = 0.02, 0.01, 1000.0, 0.3
"""Data of the tables [m, m, N]."""

SYMMETRIC = {0.5: "5.647245", 1.0: "5.430441", 2.0: "5.322369"}
"""Largest pressure on the arc of ±0.5 rad, by b [MPa]; equal in both senses and for any mu."""

ASYMMETRIC = {1: "5.882013", -1: "6.780719"}
"""Largest pressure on -0.2 < α < 0.7 for b = 1, by sense [MPa]."""


def bearing_integral(
    radius: float, width: float, start: float, end: float, friction: float, b: float
) -> float:
    """Bearing integral ``I`` [m²]; the friction is negative in the sense of minus."""

    def integrand(α: float) -> float:
        return cos(α) ** (1 / b) * (cos(α) + friction * sin(α))

    return radius * width * quad(integrand, start, end, epsabs=0.0, epsrel=1e-13)[0]


def steady_pressure(
    α,
    force: float,
    radius: float,
    width: float,
    start: float,
    end: float,
    friction: float,
    b: float,
) -> np.ndarray:
    """Steady pressure at angles [Pa].

    Parameters
    ----------
    α : array_like [rad]
    force : float
        Vertical force [N].
    radius, width : float [m]
    start, end : float
        Limits of the arc, within ±π/2 [rad].
    friction : float
        mu, negative in the sense of minus.
    b : float
    """
    integral = bearing_integral(radius, width, start, end, friction, b)
    return force / integral * np.cos(α) ** (1 / b)


def vertical_rate(force: float, integral: float, factor: float, b: float) -> float:
    """Rate of descent of the block ``Z (F/I)^b`` [m/s]; the normal rate is its cos α."""
    return factor * (force / integral) ** b


def symmetric_peak(force: float, radius: float, width: float, half_angle: float) -> float:
    """Largest pressure on ``|α| < α0`` for b = 1, ``F/(R t (α0 + sin(2 α0)/2))`` [Pa]."""
    return force / (radius * width * (half_angle + sin(2 * half_angle) / 2))

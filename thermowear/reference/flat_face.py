"""Wear of a flat face under a centred or an eccentric load (special cases 1, 2 and 6).

The steady pressure follows from ``p^b = V·n/Z``, which is constant for a translating body and
linear along the face for one that also tilts (Páczelt and Mróz, Int. J. Solids Struct. 44 (2007)
895), with constants from equilibrium. The tables are closed forms evaluated with high precision.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

TILTING_PUNCH = {
    0.5: ("1.427931", "0.255437", "3.213694", "2.038987", "1.130360"),
    1.0: ("2.083333", "0.5", "3.125000", "2.083333", "1.041667"),
    2.0: ("4.709998", "0.886126", "2.980545", "2.170253", "0.732357"),
}
"""Punch of 60 x 80 mm (x and y) under 10 kN at x = 25, y = 40 mm: by b, the c and κ of
``p^b = c (1 - κ (x - 30 mm)/30 mm)`` [MPa^b], and p at x = 0, 30 and 60 mm [MPa]."""


def centred_pressure(force: float, area: float) -> float:
    """Uniform pressure ``p = F/S`` [Pa]."""
    return force / area


def volume_rate(force: float, area: float, factor: float, b: float) -> float:
    """Wear volume per time under a centred load, ``Z F^b S^(1-b)`` [m³/s].

    Parameters
    ----------
    force, area : float
    factor : float
        Z of the wear rate ``Z p^b`` [m/(s Pa^b)].
    b : float
    """
    return factor * force**b * area ** (1 - b)


def tilted_pressure(
    place, force: float, moment: float, length: float, width: float, b: float
) -> np.ndarray:
    """Pressure ``A (1 + κ s)^(1/b)``, ``s = place/(length/2)``, with or without separation [Pa].

    With ``m = 1/b``, the centre of pressure in full contact follows from integrals of powers. If
    it is closer to an edge than ``length/(m + 2)``, the contact is partial; the pressure is then
    proportional to ``t^m`` from the end of the contact, whose distance from the loaded edge is
    ``(m + 2)`` times that of the centre of pressure.

    Parameters
    ----------
    place : array_like
        Position along the face, from its middle [m].
    force, moment : float
        Resultants of the pressure about the middle [N, N m]; minus friction's moment in case 6,
        ``M_c = M_0 - F (z_c - z_0) ∓ mu h F``.
    length, width : float [m]
    b : float
    """
    m, s = 1 / b, np.asarray(place, dtype=float) * 2 / length
    arm = 2 * abs(moment) / (force * length)  # of the force, relative to half the length
    s = s if moment >= 0 else -s
    if (1 - arm) * (m + 2) >= 2:
        κ = brentq(lambda κ: _mean(κ, m, 1) / _mean(κ, m, 0) - arm, 0.0, 1.0, xtol=1e-15)
        return force / (length * width * _mean(κ, m, 0)) * (1 + κ * s) ** m
    zone = (1 - arm) * (m + 2)  # relative to half the length
    peak = 2 * force * (m + 1) / (zone * length * width)
    return peak * np.maximum((s - 1) / zone + 1, 0.0) ** m


def linear_pressure(place, force: float, moment: float, length: float, width: float) -> np.ndarray:
    """Pressure for b = 1 while ``|M| < F L/6``: ``F/(t L) + 12 M ζ/(t L³)`` [Pa]."""
    return force / (width * length) + 12 * moment * np.asarray(place) / (width * length**3)


def contact_length(force: float, moment: float, length: float, b: float) -> float:
    """Length of the contact [m]."""
    return min(length, (length / 2 - abs(moment) / force) * (1 / b + 2))


def _mean(κ: float, m: float, power: int) -> float:
    """Mean of ``s^power (1 + κ s)^m`` over ``-1 < s < 1``, power 0 or 1."""
    if κ < 1e-2:  # series, where the closed form suffers from cancellation
        total, term = 0.0, 1.0
        for i in range(12):
            total += term / (i + power + 1) if (i + power) % 2 == 0 else 0.0
            term *= (m - i) / (i + 1) * κ
        return total
    high, low = 1 + κ, 1 - κ
    first = (high ** (m + 1) - low ** (m + 1)) / (2 * κ * (m + 1))
    if power == 0:
        return first
    second = (high ** (m + 2) - low ** (m + 2)) / (2 * κ * (m + 2))
    return (second - first) / κ

"""Pad on a rotating disk (special case 9).

The pad covers ``ri < r < ro`` and an angle θ, symmetric about the x axis; the disk rotates at ω,
so that ``v = ω r``. Without tilting the pressure is that of a part of a ring, see
`annular_punch.steady_pressure`; with free tilting, ``p^b v^a`` is linear in x and y (Páczelt and
Mróz, Int. J. Solids Struct. 44 (2007) 895). For a = b the pad without tilting has
``p = p_a ri/r``, uniform wear in machine design.
"""

from __future__ import annotations

from math import sin

import numpy as np

from .annular_punch import power_integral


def uniform_wear_force(largest: float, inner: float, outer: float, angle: float) -> float:
    """Force for a = b: ``F = θ p_a ri (ro - ri)``, with p_a the pressure at the inner edge [N]."""
    return angle * largest * inner * (outer - inner)


def uniform_wear_torque(force: float, friction: float, inner: float, outer: float) -> float:
    """Torque for a = b: ``mu F (ri + ro)/2`` [N m]."""
    return friction * force * (inner + outer) / 2


def tilted_pressure(
    x,
    y,
    force: float,
    centre: tuple[float, float],
    inner: float,
    outer: float,
    angle: float,
    a: float,
    lift: float = 0.0,
) -> np.ndarray:
    """Pressure of a pad that may tilt, for b = 1 and full contact [Pa].

    ``p = (A + B x + C y) r^-a``, with A, B, C from the three equations of equilibrium, whose
    integrals over r and over the angle have closed forms.

    Parameters
    ----------
    x, y : array_like [m]
    force : float [N]
    centre : tuple of float
        Point of application of the load [m].
    inner, outer, angle
        Dimensions of the pad.
    a : float
    lift : float
        ``mu h``, friction times the height of the joint above the face, for a disk that rotates
        towards decreasing angles φ [m]: moments are ``∫ p (x + mu h sin φ) dS`` and
        ``∫ p (y - mu h cos φ) dS``.
    """
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    half = angle / 2
    c0, c1, c2, s2 = angle, 2 * sin(half), half + sin(angle) / 2, half - sin(angle) / 2
    r1, r2, r3 = (power_integral(power - a, inner, outer) for power in (2, 3, 4))
    # columns: A, B x, C y; rows: force and both moments
    system = np.array(
        [
            [r1 * c0, r2 * c1, 0.0],
            [r2 * c1, r3 * c2, lift * r2 * s2],
            [-lift * r1 * c1, -lift * r2 * c2, r3 * s2],
        ]
    )
    A, B, C = np.linalg.solve(system, force * np.array([1.0, *centre]))
    return (A + B * x + C * y) * np.hypot(x, y) ** -a

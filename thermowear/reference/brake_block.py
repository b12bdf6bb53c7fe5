"""Block on a lever, pressed against a moving strip (special case 5).

The lever rotates about the origin; the face is offset by ``l_x`` from it and extends from ``z_i``
to ``z_u``. Then ``p = (M/I) z^(1/b)`` with ``I = ∫ z^(1/b) (z ± mu l_x) t dz``, and the normal
wear rate is ``λ z`` (Páczelt and Mróz, Int. J. Solids Struct. 44 (2007) 895). In the sense of minus
friction increases the pressure; the block is self-locking where I is not positive.
"""

from __future__ import annotations

import numpy as np

INNER, OUTER, OFFSET, WIDTH, MOMENT, FRICTION = 0.05, 0.15, 0.04, 0.01, 200.0, 0.3
"""Data of the table [m, m, m, m, N m]."""

ENDS = {
    (1.0, 1): ("0.831025", "2.493075"),
    (1.0, -1): ("1.038062", "3.114187"),
    (2.0, 1): ("1.22949", "2.12954"),
}
"""Pressure at z_i and z_u by b and sense [MPa]."""


def bearing_integral(
    inner: float, outer: float, offset: float, width: float, friction: float, b: float
) -> float:
    """Bearing integral ``I`` [m^(3 + 1/b)]; the friction is negative in the sense of minus."""
    m = 1 / b
    with_arm = (outer ** (m + 2) - inner ** (m + 2)) / (m + 2)
    with_offset = (outer ** (m + 1) - inner ** (m + 1)) / (m + 1)
    return width * (with_arm + friction * offset * with_offset)


def steady_pressure(
    z,
    moment: float,
    inner: float,
    outer: float,
    offset: float,
    width: float,
    friction: float,
    b: float,
) -> np.ndarray:
    """Steady pressure at distances z [Pa].

    Parameters
    ----------
    z : array_like [m]
    moment : float
        Moment of the load about the pivot [N m].
    inner, outer : float
        ``z_i`` and ``z_u`` [m].
    offset, width : float
        ``l_x`` and t [m].
    friction : float
        mu, negative in the sense of minus.
    b : float
    """
    integral = bearing_integral(inner, outer, offset, width, friction, b)
    return moment / integral * np.asarray(z, dtype=float) ** (1 / b)


def locking_friction(inner: float, outer: float, offset: float, b: float) -> float:
    """Least mu of self-locking in the sense of minus, where I vanishes."""
    without, against = (
        bearing_integral(inner, outer, offset, 1.0, friction, b) for friction in (0.0, -1.0)
    )
    return without / (without - against)

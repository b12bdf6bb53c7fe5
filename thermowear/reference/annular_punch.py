"""Annular punch rotating on a plate, and pad on a rotating disk (special cases 8 and 9).

Closed forms of the flat face: Páczelt and Mróz, Int. J. Solids Struct. 44 (2007) 895, with the
constants from equilibrium. The tables are converged numerical solutions for the starter case of the
annular punch, obtained with other meshes and other pressure spaces.

The pad covers ``ri < r < ro`` and an angle θ, symmetric about the x axis; the disk rotates at ω, so
that ``v = ω r``. Without tilting its pressure is that of a part of a ring; with free tilting,
``p^b v^a`` is linear in x and y. For a = b the pad without tilting has ``p = p_a ri/r``, uniform
wear in machine design.
"""

from __future__ import annotations

from math import cos, log, pi, sin

import numpy as np
from scipy.integrate import quad

STEADY_PRESSURE = {
    0.5: (2.0, "390677", ("976.694", "244.173", "79.730", "27.130"), "2.4547e8"),
    1.0: (1.0, "7000", ("350", "175", "100", "58.3333"), "3.07876e8"),
    2.0: (0.5, "857.08", ("191.649", "135.516", "102.441", "78.240"), "3.35939e8"),
}
"""Flat ring under a mean pressure of 100 MPa, a = 1: by b, the n and c of ``p = c r^-n`` [MPa, mm],
p at 20, 40, 70 and 120 mm [MPa], and the torque over mu [N mm]."""


def steady_pressure(
    r, force: float, inner: float, outer: float, b: float, a: float = 1.0, angle: float = 2 * pi
) -> np.ndarray:
    """Steady pressure ``p = (F/I) r^(-a/b)``, ``I = θ ∫ r^(1 - a/b) dr``, on a flat face.

    Parameters
    ----------
    r : array_like [m]
    force : float [N]
    inner, outer : float
        Radii of the ring [m].
    b, a : float
        Pressure and velocity exponents of the wear law.
    angle : float
        θ, less than 2 π for a part of the ring [rad].

    Returns
    -------
    ndarray [Pa]
    """
    integral = power_integral(2.0 - a / b, inner, outer)
    return force / (angle * integral) * np.asarray(r, dtype=float) ** (-a / b)


def conical_pressure(
    r, force: float, inner: float, outer: float, α: float, transverse: float, b: float, a: float
) -> np.ndarray:
    """Steady pressure on a cone, ``(F/I) r^(-a/b) sin^(1/b) α`` [Pa].

    ``I = 2 π ∫ r^(1 - a/b) sin^(1/b) α (sin α + mu_d cos α) ds``, ``dr = sin α ds``;
    circumferential friction has no influence.

    Parameters
    ----------
    r : array_like [m]
    force, inner, outer, b, a
        See `steady_pressure`.
    α : float
        Angle between the face's normal and the radius; π/2 is flat [rad].
    transverse : float
        mu_d, coefficient of friction against the wear velocity along the face.
    """
    flat = steady_pressure(r, force, inner, outer, b, a)
    return flat / (1 + transverse * cos(α) / sin(α))


def toroidal_pressure(
    α,
    force: float,
    centre: float,
    rounding: float,
    start: float,
    end: float,
    transverse: float,
    b: float,
    a: float,
) -> np.ndarray:
    """Steady pressure on a torus, ``r = r_c + ρ cos α``, ``ds = ρ dα`` [Pa].

    Parameters
    ----------
    α : array_like [rad]
    force : float
    centre, rounding : float
        ``r_c`` and ρ [m].
    start, end : float
        Range of α on the face, within 0 and π/2.
    transverse, b, a
        See `conical_pressure`.
    """

    def shape(α: float) -> float:
        return (centre + rounding * cos(α)) ** (-a / b) * sin(α) ** (1 / b)

    def integrand(α: float) -> float:
        radius = centre + rounding * cos(α)
        return shape(α) * (sin(α) + transverse * cos(α)) * 2 * pi * radius * rounding

    integral = quad(integrand, start, end, epsabs=0.0, epsrel=1e-13)[0]
    return force / integral * np.array([shape(angle) for angle in np.atleast_1d(α)])


def torque(force: float, inner: float, outer: float, friction: float, b: float, a: float) -> float:
    """Torque ``mu ∫ p r dS`` on a flat face [N m]."""
    arm, area = 3.0 - a / b, 2.0 - a / b
    mean = power_integral(arm, inner, outer) / power_integral(area, inner, outer)
    return friction * force * mean


def power_integral(power: float, low: float, high: float) -> float:
    """Integral ``∫ r^(power - 1) dr``."""
    return log(high / low) if power == 0 else (high**power - low**power) / power


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


RADII = np.array([20, 25, 40, 70, 100, 115, 120]) * 1e-3
"""Radii of the steady tables [m]; the first and last are singular corners."""

STEADY_SHAPE = {
    (1.0, 0.0): [0.02526, 0.025557, 0.015713, 0, -0.008500, -0.011858, -0.013585],
    (1.0, 0.1): [0.018040, 0.017527, 0.007688, 0, 0.016949, 0.037571, 0.04547],
    (2.0, 0.0): [0.00748, 0.008916, 0.006447, 0, -0.004676, -0.007374, -0.00921],
    (2.0, 0.1): [0.00713, 0.007560, 0.003386, 0, 0.018313, 0.040769, 0.04939],
    (0.5, 0.0): [0.08266, 0.076017, 0.038414, 0, -0.013803, -0.017520, -0.01890],
    (0.5, 0.1): [0.05894, 0.052151, 0.019573, 0, 0.014437, 0.031229, 0.03756],
}
"""Steady worn shape relative to r = 70 mm [mm], by (b, ω); ω = 0: without heat."""

TEMPERATURE_RISE = [72.38, 74.040, 75.149, 74.675, 72.181, 69.233, 66.70]
"""Temperature rise of the punch's face for b = 1 and ω = 0.1 rad/s [K]."""

RUNNING_IN_RADII = np.array([21, 25, 40, 70, 100, 115, 119]) * 1e-3
"""Radii of the running-in pressures [m]."""

RUNNING_IN = {
    1: ([77.97, 58.79, 51.21, 48.86, 47.44, 52.69, 58.62], [0.7104, 1.6967, 3.0438], 90.12),
    5: ([88.20, 72.56, 59.12, 51.03, 45.79, 43.93, 42.79], [4.007, 8.705, 14.09], 441.74),
    20: ([123.80, 105.92, 76.25, 52.34, 39.00, 34.08, 32.88], [21.07, 36.11, 46.49], 1686.9),
    50: ([156.52, 132.23, 85.58, 50.64, 35.67, 31.01, 29.96], [66.83, 90.07, 101.76], 4048.9),
    100: ([165.90, 139.42, 87.37, 50.05, 35.05, 30.47, 29.45], [152.59, 177.98, 189.83], 7909.4),
    200: ([166.66, 140.00, 87.50, 50.00, 35.00, 30.43, 29.41], [327.45, 353.01, 364.87], 15607.0),
}
"""Running-in of a flat face without heat, ω = 10 rad/s, a = b = 1: by time [s], pressures [MPa],
wear depths at r = 25, 70 and 115 mm [µm], worn volume [mm³]."""

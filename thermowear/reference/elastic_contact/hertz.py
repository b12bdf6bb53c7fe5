"""Hertz's contact of cylinders, spheres and smooth bodies, and of flat punches.

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

Johnson, Contact Mechanics (1985), ch. 4 and 7. Hertz approximates both bodies by half-spaces. The
compliance of a sphere held at its equator differs: the peak pressure is lower by about 0.02 a/R,
more than the error of a fine mesh. Its displacement under a pressure is a series of Legendre
polynomials (Lur'e, Three-Dimensional Problems of the Theory of Elasticity, 1964, ch. 6), that of
the half-space a hypergeometric function for each power of ``1 - (r/a)²`` (Sneddon, 1946; Johnson,
section 3.4).

Tangential loads (Cattaneo, Mindlin) act on elastically similar bodies, so that shear does not
affect the pressure. P is the normal force, Q the tangential one, ``|Q| <= mu P``, per length. Under
Q the contact sticks in ``|x| < c`` and slips outside. On unloading, the shear due to the change of
Q is superposed, with the bound ``2 mu p`` (Masing's rule).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, log, pi, sqrt

import numpy as np
from scipy.optimize import brentq
from scipy.special import elliprd, elliprf, gamma, hyp2f1

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


_NODES = 240
"""Number of Gauss points over the contact."""
_WAVES = 240.0
"""Largest order of the series times a/R, as resolved by the Gauss rule."""
_TERMS = 3
"""Number of powers ``(1 - (r/a)²)^(j - 1/2)`` of the pressure."""


@dataclass(frozen=True)
class Hertz:
    """Hertzian contact.

    Attributes
    ----------
    half_width : float
        Half-width, or radius, of the contact [m].
    peak : float
        Largest pressure [Pa].
    """

    half_width: float
    peak: float

    def pressure(self, x: np.ndarray) -> np.ndarray:
        """Pressure ``p0 √(1 - (x/a)²)`` at distances from the middle [Pa]."""
        return self.peak * np.sqrt(np.maximum(1 - (x / self.half_width) ** 2, 0.0))


def contact_modulus(*materials: tuple[float, float]) -> float:
    """Contact modulus ``1/E* = Σ (1 - ν²)/E`` of pairs (E, ν) [Pa]."""
    return 1 / sum((1 - ν**2) / E for E, ν in materials)


def line_contact(force: float, radius: float, modulus: float) -> Hertz:
    """Cylinder on a flat under a force per length [N/m]: ``a = √(4 P R/(π E*))``."""
    a = sqrt(4 * force * radius / (pi * modulus))
    return Hertz(a, 2 * force / (pi * a))


def point_contact(force: float, radius: float, modulus: float) -> Hertz:
    """Sphere on a flat under a force [N]: ``a³ = 3 F R/(4 E*)``."""
    a = (3 * force * radius / (4 * modulus)) ** (1 / 3)
    return Hertz(a, 3 * force / (2 * pi * a**2))


def flat_punch(x: np.ndarray, force: float, half_width: float) -> np.ndarray:
    """Rigid flat punch on a half-plane, force per length: ``P/(π √(a² - x²))`` [Pa]."""
    return force / (pi * np.sqrt(half_width**2 - x**2))


def sphere_on_half_space(
    force: float, radius: float, sphere: tuple[float, float], half_space: tuple[float, float]
) -> Hertz:
    """Contact radius and peak pressure.

    Parameters
    ----------
    force : float [N]
    radius : float [m]
        Radius of the sphere.
    sphere, half_space : tuple of float
        Young's modulus [Pa] and Poisson's ratio.
    """
    flat = point_contact(force, radius, contact_modulus(sphere, half_space))

    def excess(a: float) -> float:
        terms = _pressure_terms(a, radius, sphere, half_space)
        return float(terms @ (pi * a**2 / (_powers() + 1.0))) / force - 1.0

    a = brentq(excess, 0.95 * flat.half_width, 1.05 * flat.half_width, xtol=1e-9 * radius)
    return Hertz(a, float(_pressure_terms(a, radius, sphere, half_space).sum()))


def normal_compliance(orders: np.ndarray, poisson: float) -> np.ndarray:
    """Radial displacement over radial stress, times 2G/R, of a sphere without surface shear.

    Parameters
    ----------
    orders : ndarray of int
        n of the Legendre polynomials; zero for n = 1, a resultant force.
    poisson : float
    """
    n, ν = orders.astype(float), poisson
    shear = n * (n**2 + 2 * n - 1 + 2 * ν)
    stress = (n + 1) * (n**2 - n - 2 - 2 * ν) - shear
    with np.errstate(divide="ignore", invalid="ignore"):
        displacement = (n + 1) * (n - 2 + 4 * ν) - shear / (n - 1)
        return np.where(orders == 1, 0.0, displacement / stress)


def _pressure_terms(
    a: float, radius: float, sphere: tuple[float, float], half_space: tuple[float, float]
) -> np.ndarray:
    """Coefficients of the powers that close the gap over a contact of radius a, (n,) [Pa].

    The approach of the bodies is an additional unknown of the least squares.
    """
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    angle = pi / 4 * (nodes + 1.0)
    r = a * np.sin(angle)
    cosine = np.sqrt(1.0 - (r / radius) ** 2)
    area = pi / 4 * weights * a * np.cos(angle) * r / (radius**2 * cosine)
    pressures = (1.0 - (r / a) ** 2)[:, None] ** _powers()
    yielding = _sphere_displacement(pressures, area, cosine, a, radius, sphere)
    yielding += _half_space_displacement(r, a, half_space)
    columns = np.hstack([yielding, -np.ones((_NODES, 1))])
    scale = np.abs(columns).max(axis=0)
    gap = radius - radius * cosine
    return (np.linalg.lstsq(columns / scale, -gap, rcond=None)[0] / scale)[:-1]


def _powers() -> np.ndarray:
    return np.arange(_TERMS) + 0.5


def _sphere_displacement(pressures, area, cosine, a, radius, material) -> np.ndarray:
    """Displacement by each pressure and its mirror image at the other pole, (nodes, terms) [m/Pa].

    Mirrored loads keep the equator plane: the lower half rests on a rigid, frictionless plane.
    """
    young, poisson = material
    orders = np.arange(0, int(_WAVES * radius / a), 2)
    legendre = _legendre(orders[-1], cosine)[::2]
    parts = 2.0 * (orders + 0.5)[:, None] * (legendre @ (pressures * area[:, None]))
    shear_modulus = young / (2.0 * (1.0 + poisson))
    compliance = normal_compliance(orders, poisson) * radius / (2.0 * shear_modulus)
    return legendre.T @ (compliance[:, None] * parts)


def _half_space_displacement(r: np.ndarray, a: float, material: tuple[float, float]) -> np.ndarray:
    """Displacement of a half-space by each power of the pressure, (nodes, terms) [m/Pa]."""
    young, poisson = material
    j = _powers() + 0.5
    shape = hyp2f1(0.5, -j, 1.0, (r[:, None] / a) ** 2)
    return (1.0 - poisson**2) / young * a * sqrt(pi) * gamma(j + 0.5) / gamma(j + 1.0) * shape


def _legendre(order: int, x: np.ndarray) -> np.ndarray:
    """Legendre polynomials up to an order, (order + 1, n), by their recurrence."""
    found = np.empty((order + 1, len(x)))
    found[0], found[1] = 1.0, x
    for n in range(1, order):
        found[n + 1] = ((2 * n + 1) * x * found[n] - n * found[n - 1]) / (n + 1)
    return found


@dataclass(frozen=True)
class MindlinLine:
    """Cylinder on a half-plane, or two parallel cylinders; forces per length.

    Attributes
    ----------
    force, radius, modulus, friction : float
        P [N/m], relative radius R, ``1/R = 1/R1 + 1/R2`` [m], contact modulus E*,
        ``1/E* = (1 - ν1²)/E1 + (1 - ν2²)/E2`` [Pa], and mu.
    """

    force: float
    radius: float
    modulus: float
    friction: float

    @property
    def normal(self) -> Hertz:
        """Half-width and pressure, which do not depend on the tangential force."""
        return line_contact(self.force, self.radius, self.modulus)

    @property
    def limit(self) -> float:
        """Tangential force of gross slip ``mu P`` [N/m]."""
        return self.friction * self.force

    def stick_half_width(self, tangential: float) -> float:
        """Half-width of the stick zone on first loading, ``c = a sqrt(1 - |Q|/(mu P))`` [m]."""
        return self.normal.half_width * sqrt(1 - abs(tangential) / self.limit)

    def shear(self, x, tangential: float) -> np.ndarray:
        """Shear traction along Q exerted by the body pushed by Q, on first loading [Pa].

        ``mu p0 (sqrt(1 - x²/a²) - c/a sqrt(1 - x²/c²))`` (Johnson, section 7.2).
        """
        p0, a, c = self.normal.peak, self.normal.half_width, self.stick_half_width(tangential)
        stuck = Hertz(c, p0 * c / a).pressure(np.asarray(x)) if c > 0 else 0.0
        return np.sign(tangential) * self.friction * (self.normal.pressure(np.asarray(x)) - stuck)

    def shear_after(self, x, largest: float, tangential: float) -> np.ndarray:
        """Shear traction after loading to ``largest`` and back to ``tangential`` [Pa]."""
        change = (largest - tangential) / 2
        return self.shear(x, largest) - 2 * self.shear(x, change)

    def slip(self, x, tangential: float) -> np.ndarray:
        """Slip of the body pushed by Q, relative to the stick zone, on first loading [m].

        For similar half-planes, ``ds/dx = 2/(π E*) ∫ q(ξ)/(x - ξ) dξ`` (Johnson, section 2.5); the
        integrals of both elliptic parts of the shear have closed forms, which give
        ``ds/dx = 2 mu p0/(E* a) sqrt(x² - c²)`` in ``c < x < a``, thus
        ``s = mu p0/(E* a) (x sqrt(x² - c²) - c² arcosh(x/c))``.
        """
        p0, a, c = self.normal.peak, self.normal.half_width, self.stick_half_width(tangential)
        x = np.clip(np.abs(np.asarray(x, dtype=float)), c, None)
        lost = c**2 * np.arccosh(x / c) if c > 0 else 0.0
        scale = self.friction * p0 / (self.modulus * a)
        return np.sign(tangential) * scale * (x * np.sqrt(x**2 - c**2) - lost)

    def loss_on_loading(self, tangential: float) -> float:
        """Energy dissipated on first loading to Q [J/m].

        The slip of each point grows under a constant ``mu p``, so that the loss is
        ``2 ∫ mu p s dx`` from c to a. With ``k = c/a`` the first term of `slip` gives
        ``∫ x sqrt((1 - x²)(x² - k²)) dx = π (1 - k²)²/16`` from k to 1. The second,
        ``I = ∫ sqrt(1 - x²) arcosh(x/k) dx``, has ``dI/dk = -π (1 - k²)/(4 k)`` and vanishes for
        ``k = 1``: ``I = π/4 (-ln k - (1 - k²)/2)``. With ``p0 a = 2 P/π`` and
        ``k² = 1 - f``, ``f = |Q|/(mu P)``::

            (mu P)²/(2 π E*) (f (2 - f) + 2 (1 - f) ln(1 - f)).
        """
        f = abs(tangential) / self.limit
        decay = 2 * (1 - f) * log(1 - f) if f < 1 else 0.0
        return self.limit**2 / (2 * pi * self.modulus) * (f * (2 - f) + decay)

    def loss_per_cycle(self, amplitude: float) -> float:
        """Energy dissipated in a full cycle of Q between plus and minus the amplitude [J/m].

        Each half cycle changes Q by twice the amplitude, with twice the slip of first loading under
        the same ``mu p``: four times `loss_on_loading`.
        """
        return 4 * self.loss_on_loading(amplitude)

"""Contact of a cylinder and of a sphere with a flat (Johnson, Contact Mechanics, 1985, ch. 4).

Hertz approximates both bodies by half-spaces. The compliance of a sphere held at its equator
differs: the peak pressure is lower by about 0.02 a/R, more than the error of a fine mesh. Its
displacement under a pressure is a series of Legendre polynomials (Lur'e, Three-Dimensional
Problems of the Theory of Elasticity, 1964, ch. 6), that of the half-space a hypergeometric function
for each power of ``1 - (r/a)²`` (Sneddon, 1946; Johnson, Contact Mechanics, 1985, section 3.4).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from scipy.optimize import brentq
from scipy.special import gamma, hyp2f1

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

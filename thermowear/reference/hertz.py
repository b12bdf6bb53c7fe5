"""Contact of a cylinder and of a sphere with a flat (Johnson, Contact Mechanics, 1985, ch. 4)."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np


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

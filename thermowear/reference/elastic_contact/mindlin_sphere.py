"""Sphere under tangential force or twist: partial slip of a Hertzian contact (Cattaneo, Mindlin).

Two bodies with the moduli ``G_i, ν_i`` touch in a circle of the radius a under the force P, with
the pressure ``p = p_0 sqrt(1 - r²/a²)`` (Hertz). A tangential force Q displaces their far points by

    δ = K (1 - (1 - Q/μP)^(2/3)),     K = 3 μ P S / (16 a),     S = (2 - ν_1)/G_1 + (2 - ν_2)/G_2,

and slips outside the circle ``c = a (1 - Q/μP)^(1/3)``; the shear is ``μ p`` less that of a
Hertzian pressure on that circle (Johnson, Contact Mechanics, 1985, section 7.2). Slip across the
force, which is neglected, vanishes for ν = 0. For a force that has turned back from Q, Masing's
rule holds: changes are those of a first loading by half the force, twice.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from .hertz import contact_modulus


@dataclass(frozen=True)
class MindlinSphere:
    """Sphere on a flat under a tangential force.

    Attributes
    ----------
    force : float
        Normal force P [N].
    radius : float
        Relative radius of curvature [m].
    bodies : tuple of tuple of float
        Young's modulus [Pa] and Poisson's ratio of both bodies, such that pressure does not slip
        the faces.
    friction : float
        Coefficient of friction μ.
    """

    force: float
    radius: float
    bodies: tuple[tuple[float, float], tuple[float, float]]
    friction: float

    @property
    def contact_radius(self) -> float:
        """Radius a [m]."""
        modulus = contact_modulus(*self.bodies)
        return float((3 * self.force * self.radius / (4 * modulus)) ** (1 / 3))

    @property
    def peak(self) -> float:
        """Largest pressure p_0 [Pa]."""
        return 3 * self.force / (2 * pi * self.contact_radius**2)

    @property
    def limit(self) -> float:
        """Tangential force in gross slip, μ P [N]."""
        return self.friction * self.force

    @property
    def twist_limit(self) -> float:
        """Torque in gross slip, ``∫ μ p r dA = 3π/16 μ P a`` [N m]."""
        return 3 * pi / 16 * self.limit * self.contact_radius

    @property
    def twist_compliance(self) -> float:
        """Twist per torque while all sticks, ``3 (1/G_1 + 1/G_2)/(16 a³)`` [rad/(N m)].

        Reissner and Sagoci; Johnson, section 3.9.
        """
        soft = sum(2 * (1 + ν) / E for E, ν in self.bodies)
        return 3 * soft / (16 * self.contact_radius**3)

    @property
    def stretch(self) -> float:
        """Displacement K at the force of gross slip [m]."""
        soft = sum((2 - ν) * 2 * (1 + ν) / E for E, ν in self.bodies)
        return 3 * self.limit * soft / (16 * self.contact_radius)

    def stick_radius(self, tangential: float) -> float:
        """Radius c of the sticking circle on first loading [m]."""
        return float(self.contact_radius * (1 - abs(tangential) / self.limit) ** (1 / 3))

    def displacement(self, tangential: float) -> float:
        """Tangential displacement of far points on first loading [m]."""
        return self.stretch * (1 - (1 - tangential / self.limit) ** (2 / 3))

    def shear(self, r: np.ndarray, tangential: float) -> np.ndarray:
        """Magnitude of the shear on first loading at distances r from the middle [Pa]."""
        a, c = self.contact_radius, self.stick_radius(tangential)
        scale = self.friction * self.peak / a
        return scale * (np.sqrt(np.maximum(a**2 - r**2, 0)) - np.sqrt(np.maximum(c**2 - r**2, 0)))

    def displacement_after(self, largest: float, tangential: float) -> float:
        """Displacement at a force reached from the largest one [m]."""
        return self.displacement(largest) - 2 * self.displacement((largest - tangential) / 2)

    def slip(self, r: np.ndarray, tangential: float) -> np.ndarray:
        """Slip on first loading at distances r; the amplitude in cycles between ±Q [m].

        The displacement of the circle c less that by both Hertzian shears outside of it, which are
        proportional to those of Hertzian pressures (Johnson, sections 3.4 and 7.2).
        """
        c = self.stick_radius(tangential)
        inside = np.clip(c / np.maximum(r, c), 0.0, 1.0)
        beyond = (1 - 2 / pi * np.arcsin(inside)) * (1 - 2 * inside**2)
        beyond = beyond + 2 / pi * inside * np.sqrt(1 - inside**2)
        return self.stretch / 2 * np.where(r > c, beyond * (r / self.contact_radius) ** 2, 0.0)

    def loss_per_cycle(self, tangential: float) -> float:
        """Energy dissipated in a cycle between ±Q: the area of the loop of Masing's rule [J]."""
        f = tangential / self.limit
        left = 1 - f
        part = 1 - left ** (5 / 3) - 5 * f / 6 * (1 + left ** (2 / 3))
        return 24 / 5 * self.stretch * self.limit * part

"""Faces with a coating that is worn through, by linear laws of rigid bodies.

Flat face under a pressure p at a speed v: a layer of thickness h lasts ``h/(k p v)``; the depth is
a piecewise linear function of time.

Ball of radius R on a flat, either of them coated to a thickness h: faces conform, and the worn
depth is ``(a² - r²)/(2 R)`` up to a radius a. The layer is lost up to b, ``b² = a² - 2 R h``. The
volumes of caps ``π a⁴/(4 R)`` are those of the coating and of the substrate together, and (of the
cap of radius b) of the substrate::

    V_s = π b⁴/(4 R),      V_c = π (a⁴ - b⁴)/(4 R) = π h (a² - R h)

the geometry of ball-crater tests (Rutherford and Hutchings, Surf. Coat. Technol. 79 (1996) 231).
Per sliding distance the coating loses ``k_c ∫ p dA`` over the ring, the substrate ``k_s ∫ p dA``
over the disk inside; both integrals together are the force F, so that the sliding distance s
follows from ``V_c/k_c + V_s/k_s = F s``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np


def flat_face_depth(time: float, thickness: Sequence[float], rates: Sequence[float]) -> float:
    """Depth of a face under a constant pressure [m].

    Parameters
    ----------
    time : float
        [s]
    thickness : sequence of float
        Thickness of each layer, from the surface down [m].
    rates : sequence of float
        Wear rate of each layer and of the substrate [m/s].
    """
    ends = np.cumsum([h / rate for h, rate in zip(thickness, rates, strict=False)])
    depths = np.cumsum(thickness)
    if time >= ends[-1]:
        return float(depths[-1] + rates[-1] * (time - ends[-1]))
    return float(np.interp(time, np.append(0.0, ends), np.append(0.0, depths)))


@dataclass(frozen=True)
class CoatedBall:
    """Ball on a flat with a coating on one of them; symbols as in the module's docstring.

    Attributes
    ----------
    radius : float
        R [m].
    thickness : float
        h [m].
    coating, substrate : float
        k_c and k_s, coefficients of wear of the coated body [1/Pa].
    force : float
        F [N].
    """

    radius: float
    thickness: float
    coating: float
    substrate: float
    force: float

    @property
    def begin(self) -> float:
        """Sliding distance at which the coating is worn through in the middle [m]."""
        return pi * self.radius * self.thickness**2 / (self.coating * self.force)

    def worn_radius(self, distance: float) -> float:
        """Radius a of the worn zone [m]."""
        R, h, F = self.radius, self.thickness, self.force
        if distance <= self.begin:
            return (4 * R * self.coating * F * distance / pi) ** 0.25
        # π h (a² - R h)/k_c + π (a² - 2 R h)²/(4 R k_s) = F s, quadratic in b² = a² - 2 R h
        linear = 4 * R * h * self.substrate / self.coating
        constant = 4 * R * self.substrate * F * (distance - self.begin) / pi
        b2 = 2 * constant / (linear + sqrt(linear**2 + 4 * constant))
        return sqrt(b2 + 2 * R * h)

    def bare_radius(self, distance: float) -> float:
        """Radius b of the zone without coating [m]."""
        lost = self.worn_radius(distance) ** 2 - 2 * self.radius * self.thickness
        return sqrt(max(lost, 0.0))

    def volumes(self, distance: float) -> tuple[float, float]:
        """Volumes worn of the coating and of the substrate [m³]."""
        a, b = self.worn_radius(distance), self.bare_radius(distance)
        substrate = pi * b**4 / (4 * self.radius)
        return pi * a**4 / (4 * self.radius) - substrate, substrate

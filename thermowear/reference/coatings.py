"""Coatings that are worn through: of a flat face, of a ball, and of a bush.

Bush: a shaft of radius R that has approached the bush by d, from where they touch with a radial
clearance c, has worn it to the depth ``(c + d) cos θ - c`` up to an angle a of the approach, and
worn a coating of thickness h through up to b::

    cos a = c/(c + d),      cos b = (c + h)/(c + d)

Where the coefficient is k, the pressure is ``d' cos θ/(k v)``. Friction turns the resultant of the
pressure by ``tan φ = mu`` towards the load, so that the pressures along the approach carry
``F cos φ``. Integrated over the time, with the worn depths ``w`` of coating and substrate::

    ∫ w_c cos θ dA/k_c + ∫ w_s cos θ dA/k_s = F cos φ s

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
from math import acos, hypot, pi, sin, sqrt

import numpy as np
from scipy.optimize import brentq


@dataclass(frozen=True)
class CoatedBush:
    """Bush with a coating that wears, and a shaft that does not; symbols as in the docstring above.

    Attributes
    ----------
    radius, length : float
        R and the length of the bush [m].
    clearance, thickness : float
        c and h [m].
    coating, substrate : float
        k_c and k_s [1/Pa].
    force : float
        F [N].
    friction : float
        mu; 0 also where the shaft is guided along the load.
    """

    radius: float
    length: float
    clearance: float
    thickness: float
    coating: float
    substrate: float
    force: float
    friction: float = 0.0

    @property
    def begin(self) -> float:
        """Sliding distance at which the coating is worn through in the middle [m]."""
        return self.distance(self.thickness)

    def distance(self, depth: float) -> float:
        """Sliding distance after which the shaft has approached by a depth [m]."""
        (_, all_), (_, below) = self._worn(depth, 0.0), self._worn(depth, self.thickness)
        done = (all_ - below) / self.coating + below / self.substrate
        return done * hypot(1.0, self.friction) / self.force

    def depth(self, distance: float) -> float:
        """Largest depth [m]."""
        highest = self.clearance
        while self.distance(highest) < distance:
            highest *= 2.0
        return float(brentq(lambda d: self.distance(d) - distance, 0.0, highest, xtol=1e-15))

    def volumes(self, distance: float) -> tuple[float, float]:
        """Volumes worn of the coating and of the substrate [m³]."""
        depth = self.depth(distance)
        (all_, _), (below, _) = self._worn(depth, 0.0), self._worn(depth, self.thickness)
        return all_ - below, below

    def _worn(self, depth: float, above: float) -> tuple[float, float]:
        """Volume worn below a depth, ``∫ w dA``, and ``∫ w cos θ dA`` [m³]."""
        if depth <= above:
            return 0.0, 0.0
        circle, moved = self.clearance + above, self.clearance + depth
        end = acos(circle / moved)
        squares = end + sin(end) * circle / moved  # ∫ cos² θ dθ
        factor = self.radius * self.length
        plain = 2 * factor * (moved * sin(end) - circle * end)
        return plain, factor * (moved * squares - 2 * circle * sin(end))


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

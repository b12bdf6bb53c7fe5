"""Shaft that turns in a coated bush with clearance, by linear laws of rigid bodies.

A shaft of radius R that has approached the bush by d, from where they touch with a radial clearance
c, has worn it to the depth ``(c + d) cos θ - c`` up to an angle a of the approach, and worn a
coating of thickness h through up to b::

    cos a = c/(c + d),      cos b = (c + h)/(c + d)

Where the coefficient is k, the pressure is ``d' cos θ/(k v)``. Friction turns the resultant of the
pressure by ``tan φ = mu`` towards the load, so that the pressures along the approach carry
``F cos φ``. Integrated over the time, with the worn depths ``w`` of coating and substrate::

    ∫ w_c cos θ dA/k_c + ∫ w_s cos θ dA/k_s = F cos φ s
"""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, hypot, sin

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

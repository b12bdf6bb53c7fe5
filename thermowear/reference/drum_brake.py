"""Rigid pivoted shoe inside a drum (special case 7).

θ is measured at the axis of the drum, from the line to the pivot, which is at a distance a. The
shoe rotates about its pivot, so that the normal rate is proportional to ``a sin θ`` and
``p = p_a (sin θ/sin θ_a)^(1/b)`` (Páczelt and Mróz, Int. J. Solids Struct. 44 (2007) 895). For
b = 1 this is the long-shoe law of machine design (Budynas and Nisbett, Shigley's Mechanical
Engineering Design, section on internal expanding rim brakes), whose integrals have closed forms.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np
from scipy.integrate import quad


@dataclass(frozen=True)
class DrumBrakeShoe:
    """Dimensions of a shoe, friction and wear exponent.

    Attributes
    ----------
    radius : float
        Inner radius of the drum [m].
    pivot_distance : float
        a, distance of the pivot from the axis [m].
    width : float
        Width of the face [m].
    start, end : float
        Angles of the lining, within 0 and π [rad].
    friction : float
        mu; negative for the leading shoe, whose friction increases the pressure.
    b : float
        Pressure exponent.
    """

    radius: float
    pivot_distance: float
    width: float
    start: float
    end: float
    friction: float
    b: float = 1.0

    def bearing_integral(self) -> float:
        """Moment of ``p = sin^(1/b) θ`` about the pivot, including friction [m³]."""

        def integrand(θ: float) -> float:
            normal = self.pivot_distance * sin(θ)
            along = self.radius - self.pivot_distance * cos(θ)
            return sin(θ) ** (1 / self.b) * (normal + self.friction * along)

        moment = quad(integrand, self.start, self.end, epsabs=0.0, epsrel=1e-13)[0]
        return self.width * self.radius * moment

    def pressure(self, θ, moment: float) -> np.ndarray:
        """Steady pressure under an actuating moment about the pivot [Pa]."""
        return moment / self.bearing_integral() * np.sin(θ) ** (1 / self.b)

    # long-shoe law, b = 1, with the largest pressure p_a at θ_a

    def normal_moment(self, largest: float) -> float:
        """Moment of the pressure about the pivot, ``p_a t r a/sin θ_a ∫ sin² θ dθ`` [N m]."""
        span = self.end - self.start
        integral = span / 2 - (sin(2 * self.end) - sin(2 * self.start)) / 4
        return self._scale(largest) * self.pivot_distance * integral

    def friction_moment(self, largest: float) -> float:
        """Moment of friction, ``mu p_a t r/sin θ_a ∫ sin θ (r - a cos θ) dθ`` [N m]."""
        turned = self.radius * (cos(self.start) - cos(self.end))
        off = self.pivot_distance / 2 * (sin(self.end) ** 2 - sin(self.start) ** 2)
        return self.friction * self._scale(largest) * (turned - off)

    def actuating_moment(self, largest: float) -> float:
        """Moment of the load about the pivot for a given largest pressure [N m]."""
        return self.normal_moment(largest) + self.friction_moment(largest)

    def torque(self, largest: float) -> float:
        """Torque on the drum, ``|mu| p_a t r² (cos θ1 - cos θ2)/sin θ_a`` [N m]."""
        turned = self.radius * (cos(self.start) - cos(self.end))
        return abs(self.friction) * self._scale(largest) * turned

    def leading_over_trailing(self) -> float:
        """Ratio of pressures and torques of a leading to a trailing shoe under equal loads."""
        friction = abs(self.friction_moment(1.0))
        return (self.normal_moment(1.0) + friction) / (self.normal_moment(1.0) - friction)

    def _scale(self, largest: float) -> float:
        """Common factor ``p_a t r/sin θ_a``."""
        middle = pi / 2
        highest = 1.0 if self.start <= middle <= self.end else max(sin(self.start), sin(self.end))
        return largest * self.width * self.radius / highest

"""Tangential loading of a Hertzian contact with partial slip (Cattaneo, Mindlin).

Johnson, Contact Mechanics (1985), ch. 7. Both bodies are elastically similar, so that shear does
not affect the pressure. P is the normal force, Q the tangential one, ``|Q| <= mu P``; per length in
line contacts. Under Q the contact sticks in ``|x| < c`` and slips outside. On unloading, the shear
due to the change of Q is superposed, with the bound ``2 mu p`` (Masing's rule).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log, pi, sqrt

import numpy as np

from .hertz import Hertz, line_contact


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

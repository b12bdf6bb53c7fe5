"""Waves of pressure on a half-plane that conducts, sliding on a body that does not.

The pressure varies as ``cos(m x)`` along the face, on top of a mean one, and so do friction heat
and temperature of the conductor (plane strain). The heat raises the face where the pressure is
high: above a critical speed the wave grows (R. A. Burton, V. Nerlikar and S. R. Kilaparti, Wear 24
(1973) 177). The insulator may slide any way; it is elastic or rigid.

What grows as ``exp(s t)`` reaches down as ``exp(-λ y)`` with ``s = κ (λ² - m²)``. The thermoelastic
potential of that temperature and the stress function that frees the face lift it by
``2 α (1 + ν) T/(λ + m)`` where it is warmer by ``T = mu v p/(k λ)``; the pressure flattens both
bodies by ``2 p/(E* m)``, and wear removes ``k_w v p/s``. They are equal if ::

    2 s λ (λ + m)/(E* m) + k_w v λ (λ + m) = 2 α (1 + ν) mu v s/k.

Without wear that is ``λ (λ + m) = 2 m² v/vcr``, and ``λ = m`` at the critical speed.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np


@dataclass(frozen=True)
class ConductorOnInsulator:
    """A half-plane that conducts, what it slides on, and how.

    Attributes
    ----------
    wave_length : float
        ``2 π/m`` [m].
    modulus : float
        E* of both, ``1/E* = Σ (1 - ν²)/E``, without the part of a rigid insulator [Pa].
    poisson_ratio : float
        ν of the conductor.
    expansion : float
        α of the conductor [1/K].
    conductivity : float
        k of the conductor [W/(m K)].
    friction : float
        mu.
    capacity : float
        ρ c of the conductor [J/(m³ K)].
    wear : float
        k_w: depth worn off both together per pressure and distance [1/Pa].
    """

    wave_length: float
    modulus: float
    poisson_ratio: float
    expansion: float
    conductivity: float
    friction: float
    capacity: float = 1.0
    wear: float = 0.0

    @property
    def wave_number(self) -> float:
        """``m``, 2 π over the wave length [1/m]."""
        return 2 * pi / self.wave_length

    @property
    def critical_speed(self) -> float:
        """``2 k m/(mu α (1 + ν) E*)``, up to which waves die out without wear [m/s]."""
        lift = self.expansion * (1 + self.poisson_ratio)
        return 2 * self.conductivity * self.wave_number / (self.friction * lift * self.modulus)

    def growth_rate(self, speed: float) -> complex:
        """Rate s of the wave that grows fastest, or dies out most slowly [1/s].

        With wear it may swing; then that with the positive imaginary part. Without wear an uneven
        face stays for ever, s = 0, which is left out.
        """
        m, κ = self.wave_number, self.conductivity / self.capacity
        r = speed / self.critical_speed
        if self.wear == 0.0:
            λ = m * (sqrt(1 + 8 * r) - 1) / 2
            return complex(κ * (λ**2 - m**2))
        # over λ + m, in terms of λ/m: (λ² - 1) λ + worn λ - 2 r (λ - 1) = 0
        worn = self.wear * speed * self.modulus / (2 * κ * m)
        roots = np.roots([1.0, 0.0, worn - 1 - 2 * r, 2 * r])
        rates = κ * m**2 * (roots[roots.real > 0] ** 2 - 1)
        fastest = rates[np.argmax(rates.real)]
        return complex(fastest.real, abs(fastest.imag))

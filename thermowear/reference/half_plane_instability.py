"""Thermoelastic instability of a conducting half-plane sliding on an insulator.

The pressure varies as ``cos(m x)`` along the face, superposed on a mean value, and so do friction
heat and temperature of the conductor (plane strain). Thermal expansion raises the face where the
pressure is high: above a critical speed the wave grows (R. A. Burton, V. Nerlikar and S. R.
Kilaparti, Wear 24 (1973) 177). The insulator is elastic or rigid and may slide in any direction.

A mode growing as ``exp(s t)`` decays with depth as ``exp(-λ y)``, ``s = κ (λ² - m²)``. The
thermoelastic potential of that temperature and the stress function for a traction-free face raise
it by ``2 α (1 + ν) T/(λ + m)`` for a temperature ``T = mu v p/(k λ)``; the pressure flattens both
bodies by ``2 p/(E* m)``, and wear removes ``k_w v p/s``. Equilibrium requires ::

    2 s λ (λ + m)/(E* m) + k_w v λ (λ + m) = 2 α (1 + ν) mu v s/k.

Without wear this is ``λ (λ + m) = 2 m² v/vcr``, with ``λ = m`` at the critical speed.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np


@dataclass(frozen=True)
class ConductorOnInsulator:
    """Material data of a conducting half-plane on an insulator, with friction and wear.

    Attributes
    ----------
    wave_length : float
        ``2 π/m`` [m].
    modulus : float
        E* of both, ``1/E* = Σ (1 - ν²)/E``, without the term of a rigid insulator [Pa].
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
        k_w: wear depth of both together per pressure and distance [1/Pa].
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
        """Wave number ``m = 2 π/wave_length`` [1/m]."""
        return 2 * pi / self.wave_length

    @property
    def critical_speed(self) -> float:
        """Critical speed without wear, ``2 k m/(mu α (1 + ν) E*)``: waves decay below it [m/s]."""
        lift = self.expansion * (1 + self.poisson_ratio)
        return 2 * self.conductivity * self.wave_number / (self.friction * lift * self.modulus)

    def growth_rate(self, speed: float) -> complex:
        """Growth rate s of the mode that grows fastest, or decays most slowly [1/s].

        With wear the mode may be oscillatory; then the rate with positive imaginary part. Without
        wear the stationary mode of an uneven face, s = 0, is left out.
        """
        m, κ = self.wave_number, self.conductivity / self.capacity
        r = speed / self.critical_speed
        if self.wear == 0.0:
            λ = m * (sqrt(1 + 8 * r) - 1) / 2
            return complex(κ * (λ**2 - m**2))
        # divided by λ + m, in terms of λ/m: (λ² - 1) λ + worn λ - 2 r (λ - 1) = 0
        worn = self.wear * speed * self.modulus / (2 * κ * m)
        roots = np.roots([1.0, 0.0, worn - 1 - 2 * r, 2 * r])
        rates = κ * m**2 * (roots[roots.real > 0] ** 2 - 1)
        fastest = rates[np.argmax(rates.real)]
        return complex(fastest.real, abs(fastest.imag))

"""Slab heated from t = 0 on, by series."""

from dataclasses import dataclass

import numpy as np

_TERMS = 400
"""Number of terms of the series."""


@dataclass(frozen=True)
class HeatedSlab:
    """Slab heated at one surface from t = 0 on, insulated at the other.

    By separation of variables (Carslaw and Jaeger, Conduction of Heat in Solids, 1959, sections
    3.4, 3.5 and 3.8), with the depth z below the heated surface and ``β_n = (n + 1/2) π``.

    Attributes
    ----------
    thickness : float [m]
    conductivity : float [W/(m K)]
    capacity : float
        ρ c [J/(m³ K)].
    """

    thickness: float
    conductivity: float
    capacity: float

    def ramp(self, rate: float, time: float, depth: np.ndarray | float) -> np.ndarray:
        """Temperature rise for a surface temperature that increases linearly [K].

        ::

            T = b t - b L²/κ (ξ - ξ²/2) + 2 b L²/κ Σ sin(β_n ξ) exp(-β_n² κ t/L²)/β_n³,   ξ = z/L

        Parameters
        ----------
        rate : float
            b [K/s].
        time : float
            Time since the start [s].
        depth : ndarray or float
            z [m].
        """
        ξ, τ, β = self._scaled(time, depth)
        late = (np.sin(β * ξ[..., None]) * np.exp(-(β**2) * τ) / β**3).sum(axis=-1)
        square = self.thickness**2 * self.capacity / self.conductivity
        return rate * (time - square * (ξ - ξ**2 / 2 - 2 * late))

    def ramp_heat(self, rate: float, time: float) -> float:
        """Heat per area stored up to then: the integral of ``ρ c`` times `ramp` over z [J/m²]."""
        _, τ, β = self._scaled(time, 0.0)
        late = (np.exp(-(β**2) * τ) / β**4).sum()
        square = self.thickness**2 * self.capacity / self.conductivity
        return rate * self.capacity * self.thickness * (time - square * (1 / 3 - 2 * late))

    def step(self, rise: float, time: float, depth: np.ndarray | float) -> np.ndarray:
        """Rise for a step of the surface temperature [K]: ``1 - 2 Σ sin(β_n ξ) exp(…)/β_n``."""
        ξ, τ, β = self._scaled(time, depth)
        return rise * (1 - 2 * (np.sin(β * ξ[..., None]) * np.exp(-(β**2) * τ) / β).sum(axis=-1))

    def flux(self, flux: float, time: float, depth: np.ndarray | float) -> np.ndarray:
        """Rise under a constant heat flux into the surface [K].

        ::

            T = q t/(ρ c L) + q L/k ((3 (1 - ξ)² - 1)/6 - 2/π² Σ (-1)^n cos(n π (1 - ξ)) exp(…)/n²)
        """
        ξ, τ, _ = self._scaled(time, depth)
        n = np.arange(1, _TERMS)
        waves = (-1.0) ** n * np.cos(n * np.pi * (1 - ξ[..., None]))
        late = 2 / np.pi**2 * (waves * np.exp(-((n * np.pi) ** 2) * τ) / n**2).sum(axis=-1)
        shape = (3 * (1 - ξ) ** 2 - 1) / 6 - late
        even = time / (self.capacity * self.thickness)
        return flux * (even + self.thickness / self.conductivity * shape)

    def _scaled(self, time: float, depth) -> tuple[np.ndarray, float, np.ndarray]:
        """Dimensionless depth ξ, dimensionless time, and β_n."""
        diffusivity = self.conductivity / self.capacity
        β = (np.arange(_TERMS) + 0.5) * np.pi
        return np.asarray(depth) / self.thickness, diffusivity * time / self.thickness**2, β

"""Slabs: two in contact with friction heat between them, and one heated from t = 0 on."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

_TERMS = 400
"""Number of terms of the series of a heated slab."""


def contact_temperatures(
    lengths: tuple[float, float],
    conductivities: tuple[float, float],
    ends: tuple[float, float],
    friction_heat: float,
    partition: float,
    conductance: float,
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Temperatures and heat fluxes at the contact of two slabs held at given temperatures.

    From the series of resistances ``R_i = L_i/k_i`` and the conductance of the contact (Carslaw and
    Jaeger, Conduction of Heat in Solids, 1959, section 3.2).

    Parameters
    ----------
    lengths, conductivities, ends : tuple of float
        For each slab: length [m], conductivity [W/(m K)], temperature at the far end.
    friction_heat : float
        Friction heat [W/m²].
    partition : float
        Fraction of it released on slab 1.
    conductance : float
        Contact conductance [W/(m² K)]; may be 0 or infinite.

    Returns
    -------
    temperatures, fluxes : tuple of float
        Temperatures of the faces, and fluxes into each slab [W/m²].
    """
    R1, R2 = (length / k for length, k in zip(lengths, conductivities, strict=True))
    T1, T2 = ends
    drive = T2 - T1 + friction_heat * ((1 - partition) * R2 - partition * R1)
    through = (
        drive / (R1 + R2)
        if conductance == inf
        else conductance * drive / (1 + conductance * (R1 + R2))
    )
    q1 = partition * friction_heat + through
    q2 = (1 - partition) * friction_heat - through
    return (T1 + q1 * R1, T2 + q2 * R2), (q1, q2)


def harmonic_mean(first: float, second: float) -> float:
    """Harmonic mean ``2 a b/(a + b)``."""
    return 2 * first * second / (first + second)


def conductance(
    coefficient: float,
    conductivities: tuple[float, float],
    hardnesses: tuple[float, float],
    pressure: float,
) -> float:
    """Contact conductance at a pressure [W/(m² K)].

    Heat is conducted through touching asperities, a fraction ``p/H`` of the face governed by the
    softer material. With harmonic means of conductivities and hardnesses,

        h = C k_h p/H_h,   k_h = 2 k1 k2/(k1 + k2),   H_h = 2 H1 H2/(H1 + H2),

    as in MOOSE (class GapFluxModelPressureDependentConduction of its heat transfer module) and,
    with another constant, in 4C.

    Parameters
    ----------
    coefficient : float
        C [1/m].
    conductivities, hardnesses : tuple of float
        k and H of both bodies [W/(m K), Pa].
    pressure : float [Pa]
    """
    return coefficient * harmonic_mean(*conductivities) * pressure / harmonic_mean(*hardnesses)


def block_temperatures(
    lengths: tuple[float, float],
    conductivities: tuple[float, float],
    hardnesses: tuple[float, float],
    ends: tuple[float, float],
    coefficient: float,
    pressure: float,
    friction_heat: float = 0.0,
    partition: float = 0.5,
) -> tuple[float, float]:
    """Temperatures of the faces of two blocks in contact, with a conductance by pressure.

    Parameters as in `conductance` and `contact_temperatures`.
    """
    h = conductance(coefficient, conductivities, hardnesses, pressure)
    return contact_temperatures(lengths, conductivities, ends, friction_heat, partition, h)[0]


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

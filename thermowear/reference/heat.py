"""Heat in slabs, half-spaces and rings.

A temperature ``T = G z`` that is linear in space causes no stress in a free body (Boley and Weiner,
Theory of Thermal Stresses, 1960, section 3.9). With all normal strains ``alpha G z`` and no shear,

    u_r = alpha G r z,   u_z = alpha G (z² - r²) / 2,

so that a face ``z = const`` becomes a paraboloid, of slope ``-alpha G r``. In the mean over its
width this is the ring formula: a difference of temperature ``G h`` across the height h turns the
section by ``alpha (G h) r_m / h`` at the mean radius r_m.

In the steady state of uniform wear ``p r`` is constant, so that the friction heat ``mu p v`` of a
turning ring is uniform; with insulated sides it crosses both rings axially.

One half-space under a constant flux (Carslaw and Jaeger, Conduction of Heat in Solids, 1959,
section 2.9), and two in contact that share their friction heat. The surface temperature depends on
the effusivity ``e = √(k ρ c)`` only: a flux q raises it by ``2 q √(t/π)/e``.

With constant deceleration of a brake, the flux ``q (1 - t/t_s)`` falls to zero in the stopping
time. A flux ``a t`` raises the surface temperature by ``4 a t^(3/2)/(3 e √π)``. The maximum is at
half the stopping time (Fazekas, SAE Technical Paper 530221, 1953).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi, sqrt

import numpy as np
from scipy.special import erfc, erfcx, k0e, k1e


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


def face_deflection(radius, expansion: float, gradient: float) -> np.ndarray:
    """Axial displacement ``-alpha G r² / 2`` of a face, up to a constant [m]."""
    return -expansion * gradient * np.square(radius) / 2


def rotation(inner: float, outer: float, expansion: float, gradient: float) -> float:
    """Mean slope of a face, ``-alpha G r_m`` [rad]."""
    return -expansion * gradient * (inner + outer) / 2


def steady_heat(inner: float, outer: float, friction: float, force: float, speed: float) -> float:
    """Friction heat ``mu F omega / (2 pi (r_o - r_i))`` of uniform wear per area [W/m²]."""
    return friction * force * speed / (2 * pi * (outer - inner))


@dataclass(frozen=True)
class HalfSpace:
    """Half-space of a material.

    Attributes
    ----------
    conductivity : float [W/(m K)]
    capacity : float
        ρ c [J/(m³ K)].
    """

    conductivity: float
    capacity: float

    @property
    def diffusivity(self) -> float:
        """Diffusivity κ [m²/s]."""
        return self.conductivity / self.capacity

    @property
    def effusivity(self) -> float:
        """Effusivity ``√(k ρ c)`` [W √s/(m² K)]."""
        return sqrt(self.conductivity * self.capacity)

    def rise(self, flux: float, time, depth=0.0) -> np.ndarray:
        """Rise ``(2 q/k) √(κ t) ierfc(z/(2 √(κ t)))`` under a constant flux [K].

        Parameters
        ----------
        flux : float [W/m²]
        time : array_like
            Time since the start, > 0 [s].
        depth : array_like
            z [m].
        """
        reach = np.sqrt(self.diffusivity * np.asarray(time))
        return 2 * flux / self.conductivity * reach * _ierfc(np.asarray(depth) / (2 * reach))


def surface_rises(
    bodies: tuple[HalfSpace, HalfSpace],
    friction_heat: float,
    time,
    partition: float = 0.5,
    conductance: float = inf,
) -> tuple[np.ndarray, np.ndarray]:
    """Temperature rise of both surfaces under constant friction heat [K].

    With the flux ``h D`` from body 2 to body 1, ``D = T2 - T1``, the Laplace transforms
    ``T_i = q_i/(e_i √s)`` give with ``g = h (1/e1 + 1/e2)`` ::

        h D = A (1 - exp(g² t) erfc(g √t)),   A = q ((1 - f)/e2 - f/e1)/(1/e1 + 1/e2),

    so that body 1 is heated by the constant flux ``f q + A``, with a temperature lower by
    ``A (1 - exp(g² t) erfc(g √t))/(g e1)``.

    Parameters
    ----------
    bodies : tuple of HalfSpace
    friction_heat : float
        q [W/m²].
    time : array_like
        Time since the start, > 0 [s].
    partition : float
        f, fraction of it released on body 1; without effect in perfect contact.
    conductance : float
        h > 0, infinite for perfect contact [W/(m² K)].
    """
    first, second = bodies
    e1, e2 = first.effusivity, second.effusivity
    ease = 1 / e1 + 1 / e2
    across = friction_heat * ((1 - partition) / e2 - partition / e1) / ease
    root = np.sqrt(np.asarray(time))
    late = 0.0
    if conductance < inf:
        g = conductance * ease
        late = across * (1 - erfcx(g * root)) / g
    T1 = first.rise(partition * friction_heat + across, time) - late / e1
    T2 = second.rise((1 - partition) * friction_heat - across, time) + late / e2
    return T1, T2


def _ierfc(x: np.ndarray) -> np.ndarray:
    """Integral of the complementary error function from x to infinity."""
    return np.exp(-(x**2)) / sqrt(pi) - x * erfc(x)


def braking_rise(effusivity: float, flux: float, stop: float, time) -> np.ndarray:
    """Temperature rise of the surface since the start of braking, also after the stop [K].

    Parameters
    ----------
    effusivity : float
        e, the sum for two bodies in perfect contact that share the heat [W √s/(m² K)].
    flux : float
        q at the start of braking [W/m²].
    stop : float
        t_s, stopping time [s].
    time : array_like
        Time since the start, >= 0 [s].
    """
    t = np.asarray(time)
    slowing = 4 * flux / (3 * stop) * (np.maximum(t - stop, 0.0) ** 1.5 - t**1.5)
    return (2 * flux * np.sqrt(t) + slowing) / (effusivity * sqrt(pi))


def braking_peak(effusivity: float, flux: float, stop: float) -> float:
    """Largest rise ``(2 q/(3 e)) √(2 t_s/π)``, at t_s/2 [K]; parameters as in `braking_rise`."""
    return 2 * flux / (3 * effusivity) * sqrt(2 * stop / pi)


@dataclass(frozen=True)
class MovingBand:
    """Band heat source moving over an insulated half-space (Jaeger).

    Uniform over |x| <= b and moving along +x, in the frame of the source, steady state. With
    ``X = v x/(2 κ)`` and ``L = v b/(2 κ)`` the temperature rise of the surface is ::

        T = (2 κ q/(π k v)) ∫ exp(-u) K0(|u|) du,   u from X - L to X + L

    (J. C. Jaeger, J. Proc. Roy. Soc. New South Wales 76 (1942) 203; Carslaw and Jaeger, section
    10.7). The integral has a closed form,
    ``∫ exp(±u) K0(u) du = u exp(±u) (K0(u) ± K1(u))``.

    Attributes
    ----------
    flux, half_width, speed, conductivity, diffusivity : float
        q [W/m²], b [m], v > 0 [m/s], k [W/(m K)], κ [m²/s].
    """

    flux: float
    half_width: float
    speed: float
    conductivity: float
    diffusivity: float

    @property
    def length(self) -> float:
        """Half the Péclet number of the half-width, ``L = v b/(2 κ)``."""
        return self.speed * self.half_width / (2 * self.diffusivity)

    @property
    def scale(self) -> float:
        """Temperature scale ``2 κ q/(π k v)`` [K]."""
        return 2 * self.diffusivity * self.flux / (pi * self.conductivity * self.speed)

    def rise(self, x) -> np.ndarray:
        """Temperature rise of the surface.

        Parameters
        ----------
        x : array_like
            Position relative to the middle of the source, positive ahead of it [m].

        Returns
        -------
        ndarray [K]
        """
        place, L = np.asarray(x) / self.half_width * self.length, self.length
        return self.scale * (_integral(place + L) - _integral(place - L))


PEAKS = {
    0.1: 0.691254,
    0.5: 2.048589,
    1.0: 3.115990,
    2.0: 4.629471,
    5.0: 7.612712,
    10.0: 10.948443,
    20.0: 15.639733,
    100.0: 35.322929,
}
"""Largest temperature over the scale by L, by numerical quadrature of K0."""


def _integral(u: np.ndarray) -> np.ndarray:
    """Integral ``∫ exp(-s) K0(|s|) ds`` from 0 to u."""
    size = np.abs(u)
    safe = np.where(size > 0, size, 1.0)
    in_front = 1 + safe * np.exp(-2 * safe) * (k0e(safe) - k1e(safe))
    at_rear = 1 - safe * (k0e(safe) + k1e(safe))
    return np.where(size > 0, np.where(u > 0, in_front, at_rear), 0.0)

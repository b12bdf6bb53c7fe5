"""Band heat source moving over an insulated half-space (Jaeger).

Uniform over |x| <= b and moving along +x, in the frame of the source, steady state. With
``X = v x/(2 κ)`` and ``L = v b/(2 κ)`` the temperature rise of the surface is ::

    T = (2 κ q/(π k v)) ∫ exp(-u) K0(|u|) du,   u from X - L to X + L

(J. C. Jaeger, J. Proc. Roy. Soc. New South Wales 76 (1942) 203; Carslaw and Jaeger, Conduction of
Heat in Solids, 1959, section 10.7). The integral has a closed form,
``∫ exp(±u) K0(u) du = u exp(±u) (K0(u) ± K1(u))``.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from scipy.optimize import brentq
from scipy.special import k0e, k1e


@dataclass(frozen=True)
class MovingBand:
    """Moving band heat source on a half-space.

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

    @property
    def hottest_place(self) -> float:
        """Position x of the largest temperature, between the rear edge and the middle [m].

        The contributions of both edges are equal there, ``exp(-a) K0(a) = exp(c) K0(c)``, at the
        distances a from the rear one and ``c = 2 L - a`` from the front one.
        """
        L = self.length

        def edges(a):
            return 2 * a + np.log(k0e(2 * L - a)) - np.log(k0e(a))

        a = brentq(edges, 1e-12 * L, L, xtol=1e-15 * L, rtol=1e-14)
        return (a / L - 1) * self.half_width

    @property
    def peak(self) -> float:
        """Largest temperature rise of the surface [K]."""
        return float(self.rise(self.hottest_place))

    @property
    def fast_peak(self) -> float:
        """Largest temperature rise in the limit of large L, ``(2 q/k) √(2 κ b/(π v))`` [K]."""
        passing = 2 * self.half_width / self.speed
        return 2 * self.flux / self.conductivity * sqrt(self.diffusivity * passing / pi)


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

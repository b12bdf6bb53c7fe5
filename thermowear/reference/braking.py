"""Half-spaces heated by a brake that slows down evenly.

The flux ``q (1 - t/t_s)`` falls to zero in the stopping time. A flux that grows as ``a t`` raises a
surface by ``4 a t^(3/2)/(3 e √π)``, e = √(k ρ c), and a constant one q by ``2 q √t/(e √π)``
(Carslaw and Jaeger, Conduction of Heat in Solids, 1959, section 2.9). Half way through it is
hottest (Fazekas, SAE Technical Paper 530221, 1953).
"""

from __future__ import annotations

from math import pi, sqrt

import numpy as np


def surface_rise(effusivity: float, flux: float, stop: float, time) -> np.ndarray:
    """Temperature of the surface above where it began, after the stop too [K].

    Parameters
    ----------
    effusivity : float
        e, the sum of both where two bodies in perfect contact share the heat [W √s/(m² K)].
    flux : float
        q, when the brake begins [W/m²].
    stop : float
        t_s, how long it takes [s].
    time : array_like
        Since then, >= 0 [s].
    """
    t = np.asarray(time)
    slowing = 4 * flux / (3 * stop) * (np.maximum(t - stop, 0.0) ** 1.5 - t**1.5)
    return (2 * flux * np.sqrt(t) + slowing) / (effusivity * sqrt(pi))


def highest_rise(effusivity: float, flux: float, stop: float) -> float:
    """``(2 q/(3 e)) √(2 t_s/π)``, reached at t_s/2 [K]; parameters as in `surface_rise`."""
    return 2 * flux / (3 * effusivity) * sqrt(2 * stop / pi)

"""Half-spaces heated by a brake with constant deceleration.

The flux ``q (1 - t/t_s)`` falls to zero in the stopping time. A flux ``a t`` raises the surface
temperature by ``4 a t^(3/2)/(3 e √π)``, e = √(k ρ c), a constant flux q by ``2 q √t/(e √π)``
(Carslaw and Jaeger, Conduction of Heat in Solids, 1959, section 2.9). The maximum is at half the
stopping time (Fazekas, SAE Technical Paper 530221, 1953).
"""

from __future__ import annotations

from math import pi, sqrt

import numpy as np


def surface_rise(effusivity: float, flux: float, stop: float, time) -> np.ndarray:
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


def highest_rise(effusivity: float, flux: float, stop: float) -> float:
    """Largest rise ``(2 q/(3 e)) √(2 t_s/π)``, at t_s/2 [K]; parameters as in `surface_rise`."""
    return 2 * flux / (3 * effusivity) * sqrt(2 * stop / pi)

"""A rod that is pressed on a sliding wall, heated there by friction, and worn.

Its far end is fixed and stays cold; its other end is pressed by an interference d0 on a rigid
insulating wall. Poisson's ratio is 0, so all is as in a column of anything wider. Friction heat
lengthens the rod, and so raises the pressure that makes it: above a critical speed without bound,
the simplest case of thermoelastic instability (J. R. Barber, Proc. R. Soc. A 312 (1969) 381), which
wear holds back (T. A. Dow and R. A. Burton, J. Lubr. Technol. 95 (1973) 71).

What grows as ``exp(s t)`` has the temperature ``sinh(x √(s/κ))``, x from the far end. The pressure
p that goes with its elongation by the heat ``mu p v``, less what wear takes off, is p itself if ::

    s = (E v/L) [α mu/(ρ c) (1 - sech(L √(s/κ))) - k_w],

in terms of ``z = s L²/κ``, ``r = v/vcr`` and ``w = k_w ρ c/(α mu)`` ::

    z = 2 r (1 - sech √z - w).
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from math import pi

import numpy as np
from scipy.optimize import brentq, minimize_scalar, newton

_POLE = -(pi**2) / 4
"""z of the slowest decay of heat in a rod whose end is insulated."""


@dataclass(frozen=True)
class SlidingRod:
    """Rod and friction.

    Attributes
    ----------
    length : float
        L [m].
    young_modulus : float
        E [Pa].
    expansion : float
        α [1/K].
    conductivity : float
        k [W/(m K)].
    capacity : float
        ρ c [J/(m³ K)].
    friction : float
        mu.
    wear : float
        k_w: length worn off per pressure and distance [1/Pa].
    """

    length: float
    young_modulus: float
    expansion: float
    conductivity: float
    capacity: float
    friction: float
    wear: float = 0.0

    @property
    def critical_speed(self) -> float:
        """``vcr = 2 k/(E α mu L)``, up to which a rod that does not wear is stable [m/s]."""
        E, α, mu = self.young_modulus, self.expansion, self.friction
        return 2 * self.conductivity / (E * α * mu * self.length)

    @property
    def critical_speed_with_wear(self) -> float:
        """Speed up to which the rod is stable if it wears, for k_w up to ``α mu/(ρ c)`` [m/s].

        There the pressure swings: z is imaginary, so ``Re sech √z = 1 - w``.
        """
        if self.wear == 0.0:
            return self.critical_speed

        def excess(a):
            return (1 - _sech(2j * a**2)).real - self._worn

        z = 2j * brentq(excess, 0.0, pi / 2, xtol=1e-300, rtol=1e-14) ** 2
        return self.critical_speed * abs(z) / (2 * (1 - _sech(z)).imag)

    def pressure(self, interference: float, speed: float) -> float:
        """``(E d0/L)/(1 - v/vcr)``, steady below the critical speed, without wear [Pa]."""
        cold = self.young_modulus * interference / self.length
        return cold / (1 - speed / self.critical_speed)

    def growth_rate(self, speed: float) -> complex:
        """Rate s of the disturbance that grows fastest, or decays most slowly, at a speed [1/s].

        With wear it may swing; then that with the positive imaginary part. Without wear a change of
        the interference stays for ever, s = 0, which is left out.
        """
        r, w = speed / self.critical_speed, self._worn
        z = _unworn(r) if w == 0.0 else _worn(r, w)
        return z * self.conductivity / self.capacity / self.length**2

    @property
    def _worn(self) -> float:
        return self.wear * self.capacity / (self.expansion * self.friction)


def _unworn(r: float) -> complex:
    """The root z without wear, a real one right of the pole."""

    def excess(z):
        return 2 * r * ((1 - _sech(z)).real / z if abs(z) > 1e-9 else 0.5 - 5 * z / 24) - 1

    return complex(brentq(excess, _POLE * (1 - 1e-12), 2 * r, xtol=1e-300, rtol=1e-14))


def _worn(r: float, w: float) -> complex:
    """The root z with wear: the larger one of two that are real, or one of a pair.

    ``sech √z`` is a Laplace transform of a density, so it is convex right of the pole.
    """

    def excess(z):
        return 2 * r * (1 - _sech(z) - w) - z

    limits = _POLE * (1 - 1e-6), 2 * r
    top = minimize_scalar(
        lambda z: -excess(z).real, bounds=limits, method="bounded", options={"xatol": 1e-9}
    ).x
    if excess(top).real >= 0:
        return complex(brentq(lambda z: excess(z).real, top, 2 * r, xtol=1e-300, rtol=1e-14))
    step = 1e-3 * (top - _POLE)
    bend = np.diff([excess(top + i * step).real for i in (-1, 0, 1)], 2)[0] / step**2
    pair = newton(excess, top + cmath.sqrt(-2 * excess(top).real / bend), tol=1e-15, maxiter=200)
    return complex(pair.real, abs(pair.imag))


def _sech(z: complex) -> complex:
    """``sech √z``."""
    return 1 / cmath.cosh(cmath.sqrt(z))

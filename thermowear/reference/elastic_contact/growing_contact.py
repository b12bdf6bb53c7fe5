"""Contacts that grow by wear: a cylinder and a sphere on a flat.

Worn faces conform, and the pressure p is nearly uniform over the half-width (or radius) a. The
wear depth of both bodies together is the parabola ``(a² - x²)/(2 R)``; equating its rate ``a a'/R``
to ``k p^b`` per sliding distance gives ``a^n = a0^n + n R k q^b s``, starting at Hertz's a0::

    cylinder    q = P/2    n = b + 2
    sphere      q = F/π    n = 2 b + 2

(for b = 1: Argatov, Wear 271 (2011) 1147). Elastic bodies conform differently: under a uniform
pressure the displacement at the centre exceeds that at the edge by ``c d a²/(2 R)``,
``c = (a0/a)^m``, so that the wear depth there is smaller; as a grows, this dent widens, which
reduces the mean wear rate to ``(1 - c e) a a'/R``. With the displacements of half-spaces under a
uniform pressure (Johnson, Contact Mechanics, 1985, sections 2.5 and 3.4), to first order in c::

    cylinder    m = 2    d = ln 2                    e = 1/4
    sphere      m = 3    d = 8/(3 π) (2 - 4/π)       e = 16/(9 π²)

The corrections depend on a/a0 only, not on load, material or wear coefficient.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log, pi

import numpy as np
from scipy.optimize import brentq

from .hertz import line_contact, point_contact


@dataclass(frozen=True)
class GrowingContact:
    """Contact that grows by wear; symbols as in the module's docstring.

    Attributes
    ----------
    start : float
        a0: half-width or radius of the unworn contact [m].
    radius : float
        R, relative to the other face: ``1/R = 1/R1 + 1/R2`` [m].
    rate : float
        ``k q^b R``: growth of ``a^n/n`` per sliding distance [m^(n-1)].
    power, reach : float
        Exponents n and m.
    dent, slowing : float
        Coefficients d and e.
    """

    start: float
    radius: float
    rate: float
    power: float
    reach: int
    dent: float
    slowing: float

    def half_width(self, distance) -> np.ndarray:
        """Half-width for rigid bodies after a sliding distance [m]."""
        grown = self.power * self.rate * np.asarray(distance)
        return (self.start**self.power + grown) ** (1 / self.power)

    def depth(self, distance) -> np.ndarray:
        """Wear depth at the centre for rigid bodies, ``a²/(2 R)`` [m]."""
        return self.half_width(distance) ** 2 / (2 * self.radius)

    def distance(self, half_width) -> np.ndarray:
        """Sliding distance for rigid bodies up to a half-width [m]."""
        grown = np.asarray(half_width) ** self.power - self.start**self.power
        return grown / (self.power * self.rate)

    def elastic_half_width(self, distance) -> np.ndarray:
        """Half-width for elastic bodies, within 1 % from about twice the start on [m].

        ``a^n/n - e a0^m a^(n-m)/(n-m) = k q^b R s``; for b = 1 this is the wear volume, without an
        integration constant, as the volume is zero at s = 0. A sphere needs b > 1/2.
        """
        n, m, e = self.power, self.reach, self.slowing

        def excess(relative: float, s: float) -> float:
            grown = relative**n / n - e * relative ** (n - m) / (n - m)
            return grown - self.rate * s / self.start**n

        largest = 2 * self.half_width(np.max(distance)) / self.start
        found = [brentq(excess, 0.5, largest, args=(s,)) for s in np.atleast_1d(distance)]
        return self.start * np.reshape(found, np.shape(distance))

    def elastic_depth(self, distance) -> np.ndarray:
        """Wear depth at the centre for elastic bodies [m]."""
        a = self.elastic_half_width(distance)
        return a**2 / (2 * self.radius) * (1 - self.dent * (self.start / a) ** self.reach)


def growing_line(
    force: float, radius: float, modulus: float, coefficient: float, exponent: float = 1.0
) -> GrowingContact:
    """Cylinder on a flat under a force per length P [N/m].

    Parameters
    ----------
    force, radius, modulus
        See `thermowear.reference.elastic_contact.hertz.line_contact`.
    coefficient : float
        k of both bodies together: depth per sliding distance ``k p^b`` [Pa^(-b)].
    exponent : float
        b.
    """
    start = line_contact(force, radius, modulus).half_width
    rate = coefficient * (force / 2) ** exponent * radius
    return GrowingContact(start, radius, rate, exponent + 2, 2, log(2), 1 / 4)


def growing_point(
    force: float, radius: float, modulus: float, coefficient: float, exponent: float = 1.0
) -> GrowingContact:
    """Sphere on a flat under a force F [N]; parameters as in `growing_line`."""
    start = point_contact(force, radius, modulus).half_width
    rate = coefficient * (force / pi) ** exponent * radius
    dent, slowing = 8 / (3 * pi) * (2 - 4 / pi), 16 / (9 * pi**2)
    return GrowingContact(start, radius, rate, 2 * exponent + 2, 3, dent, slowing)

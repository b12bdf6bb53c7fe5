"""Wear of rigid faces with one or two free motions: the special cases of Páczelt and Mróz.

The steady pressure follows from ``p^b = V·n/Z``, which is constant for a translating body and
linear along the face for one that also tilts (Páczelt and Mróz, Int. J. Solids Struct. 44 (2007)
895), with constants from equilibrium. The tables are closed forms evaluated with high precision.

The rigid-body motion fixes the normal wear rate up to a factor, ``h`` at each place, so that
``p = (L/I) h^(1/b)``. The bearing integral I is the load along the motion, or the moment about the
pivot, of ``h^(1/b)`` with its friction (Páczelt and Mróz, Int. J. Solids Struct. 44 (2007) 895).
Friction is positive where it supports part of the load, negative where it increases the pressure.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from math import cos, pi, sin

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

TILTING_PUNCH = {
    0.5: ("1.427931", "0.255437", "3.213694", "2.038987", "1.130360"),
    1.0: ("2.083333", "0.5", "3.125000", "2.083333", "1.041667"),
    2.0: ("4.709998", "0.886126", "2.980545", "2.170253", "0.732357"),
}
"""Punch of 60 x 80 mm (x and y) under 10 kN at x = 25, y = 40 mm: by b, the c and κ of
``p^b = c (1 - κ (x - 30 mm)/30 mm)`` [MPa^b], and p at x = 0, 30 and 60 mm [MPa]."""


def centred_pressure(force: float, area: float) -> float:
    """Uniform pressure ``p = F/S`` [Pa]."""
    return force / area


def volume_rate(force: float, area: float, factor: float, b: float) -> float:
    """Wear volume per time under a centred load, ``Z F^b S^(1-b)`` [m³/s].

    Parameters
    ----------
    force, area : float
    factor : float
        Z of the wear rate ``Z p^b`` [m/(s Pa^b)].
    b : float
    """
    return factor * force**b * area ** (1 - b)


def tilted_pressure(
    place, force: float, moment: float, length: float, width: float, b: float
) -> np.ndarray:
    """Pressure ``A (1 + κ s)^(1/b)``, ``s = place/(length/2)``, with or without separation [Pa].

    With ``m = 1/b``, the centre of pressure in full contact follows from integrals of powers. If
    it is closer to an edge than ``length/(m + 2)``, the contact is partial; the pressure is then
    proportional to ``t^m`` from the end of the contact, whose distance from the loaded edge is
    ``(m + 2)`` times that of the centre of pressure.

    Parameters
    ----------
    place : array_like
        Position along the face, from its middle [m].
    force, moment : float
        Resultants of the pressure about the middle [N, N m]; minus friction's moment in case 6,
        ``M_c = M_0 - F (z_c - z_0) ∓ mu h F``.
    length, width : float [m]
    b : float
    """
    m, s = 1 / b, np.asarray(place, dtype=float) * 2 / length
    arm = 2 * abs(moment) / (force * length)  # of the force, relative to half the length
    s = s if moment >= 0 else -s
    if (1 - arm) * (m + 2) >= 2:
        κ = brentq(lambda κ: _mean(κ, m, 1) / _mean(κ, m, 0) - arm, 0.0, 1.0, xtol=1e-15)
        return force / (length * width * _mean(κ, m, 0)) * (1 + κ * s) ** m
    zone = (1 - arm) * (m + 2)  # relative to half the length
    peak = 2 * force * (m + 1) / (zone * length * width)
    return peak * np.maximum((s - 1) / zone + 1, 0.0) ** m


def linear_pressure(place, force: float, moment: float, length: float, width: float) -> np.ndarray:
    """Pressure for b = 1 while ``|M| < F L/6``: ``F/(t L) + 12 M ζ/(t L³)`` [Pa]."""
    return force / (width * length) + 12 * moment * np.asarray(place) / (width * length**3)


def contact_length(force: float, moment: float, length: float, b: float) -> float:
    """Length of the contact [m]."""
    return min(length, (length / 2 - abs(moment) / force) * (1 / b + 2))


def _mean(κ: float, m: float, power: int) -> float:
    """Mean of ``s^power (1 + κ s)^m`` over ``-1 < s < 1``, power 0 or 1."""
    if κ < 1e-2:  # series, where the closed form suffers from cancellation
        total, term = 0.0, 1.0
        for i in range(12):
            total += term / (i + power + 1) if (i + power) % 2 == 0 else 0.0
            term *= (m - i) / (i + 1) * κ
        return total
    high, low = 1 + κ, 1 - κ
    first = (high ** (m + 1) - low ** (m + 1)) / (2 * κ * (m + 1))
    if power == 0:
        return first
    second = (high ** (m + 2) - low ** (m + 2)) / (2 * κ * (m + 2))
    return (second - first) / κ


RADIUS, WIDTH, FORCE, FRICTION = 0.02, 0.01, 1000.0, 0.3
"""Data of the tables of the block on a disk [m, m, N]."""

SYMMETRIC = {0.5: "5.647245", 1.0: "5.430441", 2.0: "5.322369"}
"""Largest pressure on the arc of ±0.5 rad, by b [MPa]; equal in both senses and for any mu."""

ASYMMETRIC = {1: "5.882013", -1: "6.780719"}
"""Largest pressure on -0.2 < α < 0.7 for b = 1, by sense [MPa]."""

LEVER_MOMENT = 200.0
LEVER_ENDS = {
    (1.0, 1): ("0.831025", "2.493075"),
    (1.0, -1): ("1.038062", "3.114187"),
    (2.0, 1): ("1.22949", "2.12954"),
}
"""Pressure at z_i and z_u of `LEVER` under that moment [N m], by b and sense [MPa]."""


class GuidedFace(ABC):
    """Rigid face whose normal wear rate has a known shape; b is the pressure exponent."""

    b: float

    @abstractmethod
    def shape(self, place) -> np.ndarray:
        """Shape ``h`` of the normal wear rate."""

    @abstractmethod
    def bearing_integral(self) -> float:
        """Bearing integral ``I``."""

    def pressure(self, place, load: float) -> np.ndarray:
        """Steady pressure under a force, or a moment about the pivot [Pa]."""
        return load / self.bearing_integral() * self.shape(place) ** (1 / self.b)

    def rate(self, load: float, factor):
        """Wear rate ``Z (L/I)^b`` where ``h = 1``, with Z of the wear law ``Z p^b``."""
        return factor * (load / self.bearing_integral()) ** self.b


@dataclass(frozen=True)
class ArcBlock(GuidedFace):
    """Block on a disk, or segment inside a ring, with vertical guidance (cases 3 and 4).

    It rests on the arc ``start < α < end``, α measured from the vertical, and descends at a uniform
    vertical rate: ``h = cos α``, ``I = ∫ cos^(1/b) α (cos α + mu sin α) R t dα``. Positive friction
    is a disk under the block rotating towards decreasing α, or a ring around the segment rotating
    towards increasing α: for ``α > 0`` friction then supports part of the load.

    Attributes
    ----------
    radius, width : float [m]
    start, end : float
        Limits of the arc, within ±π/2 [rad].
    friction, b : float
    """

    radius: float
    width: float
    start: float
    end: float
    friction: float
    b: float = 1.0

    def shape(self, place) -> np.ndarray:
        """Normal over vertical rate at angles α [rad]."""
        return np.cos(place)

    def bearing_integral(self) -> float:
        """Bearing integral [m²]."""

        def integrand(α: float) -> float:
            return cos(α) ** (1 / self.b) * (cos(α) + self.friction * sin(α))

        integral = quad(integrand, self.start, self.end, epsabs=0.0, epsrel=1e-13)[0]
        return self.radius * self.width * integral

    def symmetric_peak(self, force: float) -> float:
        """Largest pressure on ``|α| < α0`` for b = 1, ``F/(R t (α0 + sin(2 α0)/2))`` [Pa]."""
        return force / (self.radius * self.width * (self.end + sin(2 * self.end) / 2))


@dataclass(frozen=True)
class LeverBlock(GuidedFace):
    """Block on a lever, pressed against a moving strip (case 5).

    The lever rotates about the origin; the face is offset by ``l_x`` from it and extends from
    ``z_i`` to ``z_u``: ``h = z``, ``I = ∫ z^(1/b) (z + mu l_x) t dz``. The block is self-locking
    where I is not positive.

    Attributes
    ----------
    inner, outer, offset, width : float
        ``z_i``, ``z_u``, ``l_x`` and t [m].
    friction, b : float
    """

    inner: float
    outer: float
    offset: float
    width: float
    friction: float
    b: float = 1.0

    def shape(self, place) -> np.ndarray:
        """Distances z from the pivot [m]."""
        return np.asarray(place, dtype=float)

    def bearing_integral(self) -> float:
        """Bearing integral [m^(3 + 1/b)]."""
        m = 1 / self.b
        with_arm = (self.outer ** (m + 2) - self.inner ** (m + 2)) / (m + 2)
        with_offset = (self.outer ** (m + 1) - self.inner ** (m + 1)) / (m + 1)
        return self.width * (with_arm + self.friction * self.offset * with_offset)

    def locking_friction(self) -> float:
        """Least mu of self-locking, where I with negative friction vanishes."""
        without, against = (
            replace(self, width=1.0, friction=mu).bearing_integral() for mu in (0.0, -1.0)
        )
        return without / (without - against)


LEVER = LeverBlock(inner=0.05, outer=0.15, offset=0.04, width=0.01, friction=0.3)
"""Block of the table."""


@dataclass(frozen=True)
class DrumBrakeShoe(GuidedFace):
    """Rigid pivoted shoe inside a drum (case 7).

    θ is measured at the axis of the drum, from the line to the pivot, which is at a distance a. The
    shoe rotates about its pivot, so that ``h = sin θ``. For b = 1 this is the long-shoe law of
    machine design (Budynas and Nisbett, Shigley's Mechanical Engineering Design, section on
    internal expanding rim brakes), whose integrals have closed forms.

    Attributes
    ----------
    radius, pivot_distance, width : float
        Inner radius of the drum, a, and width of the face [m].
    start, end : float
        Angles of the lining, within 0 and π [rad].
    friction : float
        mu; negative for the leading shoe.
    b : float
    """

    radius: float
    pivot_distance: float
    width: float
    start: float
    end: float
    friction: float
    b: float = 1.0

    def shape(self, place) -> np.ndarray:
        """Normal rate over its largest at angles θ [rad]."""
        return np.sin(place)

    def bearing_integral(self) -> float:
        """Moment of ``p = sin^(1/b) θ`` about the pivot, including friction [m³]."""

        def integrand(θ: float) -> float:
            normal = self.pivot_distance * sin(θ)
            along = self.radius - self.pivot_distance * cos(θ)
            return sin(θ) ** (1 / self.b) * (normal + self.friction * along)

        moment = quad(integrand, self.start, self.end, epsabs=0.0, epsrel=1e-13)[0]
        return self.width * self.radius * moment

    # long-shoe law, b = 1, with the largest pressure p_a at θ_a

    def normal_moment(self, largest: float) -> float:
        """Moment of the pressure about the pivot, ``p_a t r a/sin θ_a ∫ sin² θ dθ`` [N m]."""
        span = self.end - self.start
        integral = span / 2 - (sin(2 * self.end) - sin(2 * self.start)) / 4
        return self._scale(largest) * self.pivot_distance * integral

    def friction_moment(self, largest: float) -> float:
        """Moment of friction, ``mu p_a t r/sin θ_a ∫ sin θ (r - a cos θ) dθ`` [N m]."""
        turned = self.radius * (cos(self.start) - cos(self.end))
        off = self.pivot_distance / 2 * (sin(self.end) ** 2 - sin(self.start) ** 2)
        return self.friction * self._scale(largest) * (turned - off)

    def actuating_moment(self, largest: float) -> float:
        """Moment of the load about the pivot for a given largest pressure [N m]."""
        return self.normal_moment(largest) + self.friction_moment(largest)

    def torque(self, largest: float) -> float:
        """Torque on the drum, ``|mu| p_a t r² (cos θ1 - cos θ2)/sin θ_a`` [N m]."""
        turned = self.radius * (cos(self.start) - cos(self.end))
        return abs(self.friction) * self._scale(largest) * turned

    def leading_over_trailing(self) -> float:
        """Ratio of pressures and torques of a leading to a trailing shoe under equal loads."""
        friction = abs(self.friction_moment(1.0))
        return (self.normal_moment(1.0) + friction) / (self.normal_moment(1.0) - friction)

    def _scale(self, largest: float) -> float:
        """Common factor ``p_a t r/sin θ_a``."""
        middle = pi / 2
        highest = 1.0 if self.start <= middle <= self.end else max(sin(self.start), sin(self.end))
        return largest * self.width * self.radius / highest

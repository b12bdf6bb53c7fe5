"""Sphere that frets on a flat in partial slip: wear by the method of dimensionality reduction.

A tangential displacement ``±u`` of far points keeps a circle ``r < c`` stuck. Outside of it both
bodies together lose the depth ``4 k p s`` a cycle, where s is the amplitude of the slip. An
axisymmetric gap f(r), contact under an approach d, and partial slip become those of a line of
independent springs (Popov and Heß, Method of Dimensionality Reduction, 2015, chs. 3, 5)::

    g(x) = x ∫_0^x f'(r)/sqrt(x² - r²) dr                normal deflection max(d - g, 0), F = 2 E* ∫
    p(r) = E*/π ∫_r^a g'(x)/sqrt(x² - r²) dx
    v(x) = min(u, μ E*/G* (d - g(x)))                    tangential deflection
    s(r) = u - 2/π ∫_0^r v(x)/sqrt(r² - x²) dx           slip

(wear so: Dimaki, Dmitriev, Chai and Popov, Int. J. Solids Struct. 51 (2014) 4215). In the end all
pressure is where it sticks, so that nothing wears: ``g = d`` beyond c. With the unworn
``g = x²/R`` inside, and stuck up to ``c² = R (d - G* u/(μ E*))``, the force is
``2 E* (d c - c³/3R)``, and the inverse of g gives the worn depth (Popov, Sci. Rep. 4 (2014)
3750)::

    w(r) = 2/π [(r²/2 asin(c/r) - c/2 sqrt(r² - c²))/R + d acos(c/r)] - r²/2R

Slip across the displacement is neglected, as in `mindlin_sphere`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from .mindlin_sphere import MindlinSphere

_REACH = 1.25
"""Radius of the grid by that of the unworn contact."""
_TOLERANCE = 1e-6
"""Error of depths by the deflection at the stick radius: noise of the pressure wears, too."""


@dataclass(frozen=True)
class WornSphere:
    """Contact of a worn sphere.

    Attributes
    ----------
    approach : float
        d [m].
    stick_radius : float
        c [m].
    pressure, slip, pressed : ndarray, shape (n,)
        p [Pa], s and ``max(d - g, 0)`` [m] at the radii of the grid.
    """

    approach: float
    stick_radius: float
    pressure: np.ndarray
    slip: np.ndarray
    pressed: np.ndarray


@dataclass(frozen=True)
class FrettingSphere:
    """Sphere on a flat under a normal force and a swinging tangential displacement.

    Attributes
    ----------
    sphere : MindlinSphere
        Unworn contact.
    amplitude : float
        u [m].
    coefficient : float
        k of both bodies together [1/Pa].
    points : int
        Number of intervals of the radius.
    """

    sphere: MindlinSphere
    amplitude: float
    coefficient: float
    points: int = 400

    @cached_property
    def radius(self) -> np.ndarray:
        """Radii of the grid, shape (n,) [m]."""
        return np.linspace(0.0, _REACH * self.sphere.contact_radius, self.points + 1)

    @property
    def lift(self) -> float:
        """Normal deflection at the stick radius, ``G* u/(μ E*)`` [m]."""
        return self.amplitude / (self.sphere.friction * self._ratio)

    @property
    def _ratio(self) -> float:
        """``E*/G*``."""
        return self.modulus * sum((2 - ν) * (1 + ν) / (2 * E) for E, ν in self.sphere.bodies)

    @cached_property
    def modulus(self) -> float:
        """E* [Pa]."""
        sphere = self.sphere
        return 3 * sphere.force * sphere.radius / (4 * sphere.contact_radius**3)

    @cached_property
    def _bent(self) -> np.ndarray:
        """Matrix of g by depths that are linear between the radii, shape (n, n)."""
        x, step = self.radius[:, None], self.radius[1]
        part = np.arcsin(np.minimum(self.radius / np.maximum(x, step), 1.0))
        each = np.tril(x * np.diff(part) / step, -1)
        return _of_ends(-each, each)

    @cached_property
    def _pressing(self) -> np.ndarray:
        """Matrix of p by deflections d - g that are linear between the radii, shape (n, n)."""
        r, step = np.maximum(self.radius, 1e-3 * self.radius[1])[:, None], self.radius[1]
        part = np.arccosh(np.maximum(self.radius / r, 1.0))
        each = self.modulus / pi * np.triu(np.diff(part) / step)
        return _of_ends(each, -each)

    @cached_property
    def _dragged(self) -> np.ndarray:
        """Matrix of the displacements of the faces by v, shape (n, n)."""
        r, step = self.radius[:, None], self.radius[1]
        x = np.minimum(self.radius, r)
        mean = 2 / pi * np.diff(np.arcsin(x / np.maximum(r, step)))
        first = 2 / pi * -np.diff(np.sqrt(r**2 - x**2)) / step
        part = first - mean * self.radius[:-1] / step
        result = _of_ends(mean - part, part)
        result[0, 0] = 1.0
        return result

    def contact(self, depth: np.ndarray) -> WornSphere:
        """Contact at a worn depth of both bodies at the radii of the grid, shape (n,) [m]."""
        x, E, stretch = self.radius, self.modulus, self.sphere.friction * self._ratio
        g = x**2 / self.sphere.radius + self._bent @ depth

        def deflection(d: float) -> np.ndarray:
            return np.maximum(d - g, 0.0)

        approach = brentq(
            lambda d: 2 * E * np.trapezoid(deflection(d), x) - self.sphere.force,
            0.0,
            2 * g[-1],
            xtol=1e-15,
        )
        pressed = deflection(approach)
        moved = np.minimum(self.amplitude, stretch * pressed)
        slip = np.maximum(self.amplitude - self._dragged @ moved, 0.0)
        stuck = np.flatnonzero(pressed >= self.lift)[-1]
        part = (pressed[stuck] - self.lift) / (pressed[stuck] - pressed[stuck + 1])
        return WornSphere(
            float(approach),
            float(x[stuck] + part * (x[stuck + 1] - x[stuck])),
            np.maximum(self._pressing @ pressed, 0.0),
            np.where(x > x[stuck], slip, 0.0),
            pressed,
        )

    def depths(self, cycles: Sequence[float]) -> np.ndarray:
        """Depth of both bodies after numbers of cycles, shape (n_cycles, n) [m]."""

        def rate(_, depth: np.ndarray) -> np.ndarray:
            now = self.contact(depth)
            return 4 * self.coefficient * now.pressure * now.slip

        def slope(_, depth: np.ndarray) -> np.ndarray:
            now = self.contact(depth)
            bent = np.where(now.pressed[:, None] > 0.0, self._bent, 0.0)
            stiff = self._pressing @ bent
            mean = np.trapezoid(bent, axis=0) / np.count_nonzero(now.pressed)
            stiff -= np.outer(self._pressing @ (now.pressed > 0.0), mean)
            return -4 * self.coefficient * now.slip[:, None] * stiff

        start, times = np.zeros(len(self.radius)), np.array(cycles, dtype=float)
        least = _TOLERANCE * self.lift
        found = solve_ivp(rate, (0.0, times[-1]), start, "BDF", times, atol=least, jac=slope)
        return found.y.T

    def volume(self, depth: np.ndarray) -> np.ndarray:
        """Volume of depths at the radii, shape (..., n) [m³]."""
        return np.trapezoid(2 * pi * self.radius * depth, self.radius)


@dataclass(frozen=True)
class EndOfFretting:
    """State that does not wear any more.

    Attributes
    ----------
    start : FrettingSphere
    stick_radius : float
        c [m].
    approach : float
        d [m].
    """

    start: FrettingSphere
    stick_radius: float
    approach: float

    @property
    def force(self) -> float:
        """Normal force [N]."""
        c, R = self.stick_radius, self.start.sphere.radius
        return 2 * self.start.modulus * (self.approach * c - c**3 / (3 * R))

    def depth(self, r: np.ndarray) -> np.ndarray:
        """Depth of both bodies at distances r from the middle [m]."""
        c, R = self.stick_radius, self.start.sphere.radius
        out = np.maximum(r, c)
        bent = out**2 / 2 * np.arcsin(c / out) - c / 2 * np.sqrt(out**2 - c**2)
        gap = 2 / pi * (bent / R + self.approach * np.arccos(c / out))
        return np.maximum(gap - out**2 / (2 * R), 0.0)

    def pressure(self, r: np.ndarray) -> np.ndarray:
        """Pressure at distances ``r < c`` from the middle [Pa]."""
        c, R, E = self.stick_radius, self.start.sphere.radius, self.start.modulus
        root = np.sqrt(c**2 - r**2)
        return E / pi * (2 * root / R + (self.approach - c**2 / R) / root)


def end_at_approach(start: FrettingSphere) -> EndOfFretting:
    """End of fretting where the approach of the unworn contact is held."""
    sphere = start.sphere
    approach = sphere.contact_radius**2 / sphere.radius
    return EndOfFretting(start, (sphere.radius * (approach - start.lift)) ** 0.5, approach)


def end_at_force(start: FrettingSphere) -> EndOfFretting:
    """End of fretting under the force of the unworn contact, of the largest stick radius.

    Those of stick radii down to that of the unworn contact exist, too: what slipped remains worn.
    """
    sphere = start.sphere

    def end(c: float) -> EndOfFretting:
        return EndOfFretting(start, c, c**2 / sphere.radius + start.lift)

    found = brentq(lambda c: end(c).force - sphere.force, 0.0, sphere.contact_radius)
    return end(found)


def _of_ends(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Matrix by values at points from those at both ends of the intervals between them."""
    n, intervals = first.shape
    result = np.zeros((n, intervals + 1))
    result[:, :-1] += first
    result[:, 1:] += second
    return result

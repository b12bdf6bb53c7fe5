"""Beam that wears on a foundation until it loses contact (wear shakedown).

Clamped at x = 0 and simply supported at x = L, a gap above a moving Winkler foundation. A force F
bends it down; where the deflection exceeds the gap it is in contact and wears, ``dw/dt = κ p``,
until the pressure vanishes: ``w = max(0, u_free - gap)``, whatever the wear rates (wear
shakedown; Páczelt and Mróz, Int. J. Numer. Meth. Eng. 63 (2005) 1310).

Beam elements with the exact nodal stiffness: Hermite's cubic, or Timoshenko's with the shear
flexibility ``Φ = 12 E I/(G A_s h²)`` (Przemieniecki, Theory of Matrix Structural Analysis, 1968,
section 5.6). The foundation consists of springs under the nodes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

_γ = 1 - 1 / math.sqrt(2)

Advance = Callable[[np.ndarray, np.ndarray, float], tuple[np.ndarray, np.ndarray]]
"""Time step: maps depths, pressures and step size to depths and pressures at its end."""


@dataclass(frozen=True)
class BeamState:
    """Pressure and wear depth at a time.

    Attributes
    ----------
    time : float [s]
    pressure, worn : ndarray, shape (n,)
        Values at the nodes between the supports [Pa, m].
    """

    time: float
    pressure: np.ndarray
    worn: np.ndarray


@dataclass(frozen=True)
class WornBeam:
    """Beam, foundation and wear law.

    Attributes
    ----------
    length, height, width : float [m]
    young_modulus : float [Pa]
    force, load_position : float
        Force and its distance from the clamp [N, m].
    gap : float [m]
    compliance : float
        Compliance of the foundation [m/Pa].
    rate : float
        κ: wear rate per pressure [m/(s Pa)].
    shear_stiffness : float or None
        ``G A_s``; None without shear flexibility [N].
    elements : int
    """

    length: float
    height: float
    width: float
    young_modulus: float
    force: float
    load_position: float
    gap: float
    compliance: float
    rate: float
    shear_stiffness: float | None = None
    elements: int = 200

    @property
    def bending_stiffness(self) -> float:
        """Bending stiffness ``E I`` [N m²]."""
        return self.young_modulus * self.width * self.height**3 / 12

    @property
    def x(self) -> np.ndarray:
        """Nodes between the supports, shape (n,) [m]."""
        return self.length * np.arange(1, self.elements) / self.elements

    @property
    def area(self) -> float:
        """Area of the face per node [m²]."""
        return self.width * self.length / self.elements

    @cached_property
    def flexibility(self) -> np.ndarray:
        """Deflections of the nodes per nodal force, shape (n, n) [m/N]."""
        matrix = np.zeros((2 * self.elements + 2,) * 2)
        element = self._element()
        for k in range(0, 2 * self.elements, 2):
            matrix[k : k + 4, k : k + 4] += element
        free = np.delete(np.arange(2, 2 * self.elements + 2), -2)  # clamp; support
        return np.linalg.inv(matrix[np.ix_(free, free)])[:-1:2, :-1:2]

    def _element(self) -> np.ndarray:
        """Element stiffness for deflection and slope at both ends."""
        h, shear = self.length / self.elements, self.shear_stiffness
        Φ = 0.0 if shear is None else 12 * self.bending_stiffness / (shear * h**2)
        near, far = (4 + Φ) * h**2, (2 - Φ) * h**2
        rows = [
            [12, 6 * h, -12, 6 * h],
            [6 * h, near, -6 * h, far],
            [-12, -6 * h, 12, -6 * h],
            [6 * h, far, -6 * h, near],
        ]
        return self.bending_stiffness / (h**3 * (1 + Φ)) * np.array(rows)

    @cached_property
    def free_deflection(self) -> np.ndarray:
        """Deflection of the nodes without foundation, shape (n,) [m]."""
        hats = np.maximum(1 - np.abs(self.x - self.load_position) / (self.x[1] - self.x[0]), 0.0)
        return self.force * self.flexibility @ hats

    @property
    def shakedown(self) -> np.ndarray:
        """Final wear depth, shape (n,) [m]."""
        return np.maximum(self.free_deflection - self.gap, 0.0)

    def states(
        self, times: Sequence[float], steps: int = 400, advance: Advance | None = None
    ) -> list[BeamState]:
        """States at increasing times, by implicit steps that grow by 2 % each.

        Parameters
        ----------
        times : sequence of float
            Increasing [s].
        steps : int
            Number of longest steps up to the last time.
        advance : callable, optional
            `two_stage` (default) or `euler`.
        """
        advance = advance or self.two_stage
        worn, pressure = np.zeros(self.elements - 1), np.zeros(self.elements - 1)
        now, step, found = 0.0, 1e-4 * times[0], []
        for time in times:
            while now < time:
                count = math.ceil((time - now) / step * (1 - 1e-9))
                size = (time - now) / count
                worn, pressure = advance(worn, pressure, size)
                now = time if count == 1 else now + size
                step = min(1.02 * step, times[-1] / steps)
            found.append(BeamState(time, pressure, worn))
        return found

    def contact(self, worn: np.ndarray, step: float = 0.0, guess=None) -> np.ndarray:
        """Pressure at the end of an implicit wear step, by an active set, shape (n,) [Pa]."""
        soft = self.compliance + self.rate * step
        matrix = self.area * self.flexibility + soft * np.eye(len(worn))
        closing = self.free_deflection - self.gap - worn
        pressing = closing > 0 if guess is None else guess > 0
        for _ in range(100):
            pressure = np.zeros_like(closing)
            chosen = np.ix_(pressing, pressing)
            pressure[pressing] = np.linalg.solve(matrix[chosen], closing[pressing])
            following = np.where(pressing, pressure > 0, matrix @ pressure < closing)
            if np.array_equal(following, pressing):
                return pressure
            pressing = following
        raise RuntimeError("beam: the active set did not converge")

    def euler(self, worn, pressure, step: float) -> tuple[np.ndarray, np.ndarray]:
        """Implicit Euler step."""
        pressure = self.contact(worn, step, pressure)
        return worn + step * self.rate * pressure, pressure

    def two_stage(self, worn, pressure, step: float) -> tuple[np.ndarray, np.ndarray]:
        """Implicit step of second order, L-stable (two-stage SDIRK).

        Alexander, SIAM J. Numer. Anal. 14 (1977) 1006.
        """
        first = self.contact(worn, _γ * step, pressure)
        before = worn + (1 - _γ) * step * self.rate * first
        last = self.contact(before, _γ * step, first)
        return before + _γ * step * self.rate * last, last


EXAMPLE = WornBeam(
    length=0.3,
    height=0.025,
    width=0.01,
    young_modulus=2.1e11,
    force=1e4,
    load_position=0.15,
    gap=5e-5,
    compliance=2e-16,
    rate=7.5e-10 * 0.05,
)
"""Example of Páczelt and Mróz, with the supports that reproduce its pressure after 60 s."""

PLACES = np.array([0.15, 0.1755])
"""Positions of the wear depths in the table [m]."""

TABLE = {
    0.1: (9.135, 151.5, 9766.9, (90, 220.5), (0.047194, 0.036580)),
    0.8: (5.364, 168, 8785.9, (46.5, 274.5), (0.215700, 0.201988)),
    1.2: (4.717, 172.5, 7881.7, (40.5, 282), (0.288771, 0.277245)),
    2.4: (3.278, 174, 5546.6, (33, 289.5), (0.459294, 0.454924)),
    3.6: (2.284, 174, 3879.2, (28.5, 292.5), (0.577731, 0.578621)),
    7.8: (0.6452, 174, 1098.5, (25.5, 294), (0.773041, 0.782614)),
    12.0: (0.1824, 174, 310.69, (24, 294), (0.828244, 0.840271)),
    60.0: (9.9e-8, 174, 1.7e-4, (24, 294), (0.850000, 0.862994)),
}
"""Independent implicit steps with 200 Hermite elements without shear: by time [s], largest
pressure [MPa] and its position [mm], reaction [N], ends of the zone [mm], wear depths [mm]."""

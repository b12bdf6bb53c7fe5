"""Punch with rounded edges: block structure of its section, and its contact half-width.

The face, the side and a core meet at a point above each rounding, so that cells follow the
rounding and stay well shaped.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .divisions import depth_ends
from .quads import Sheet, grid, ruled

_END = math.pi / 4
"""Angle of the rounding up to which it belongs to the contact face."""


def expected_end(flat: float, radius: float, load: float) -> float:
    """Half-width of the contact with an elastic half-plane.

    Ciavarella, Hills and Monno (1998): ``2 P r / (b² E*) = (π - 2φ) / (2 sin² φ) - cot φ`` with
    the end of the flat at ``b = a sin φ``.

    Parameters
    ----------
    flat : float
        Half-width of the flat, b [m].
    radius : float
        Radius of the rounding, r [m].
    load : float
        Line load over the contact modulus, P / E* [m].
    """
    from scipy.optimize import brentq

    def excess(phi):
        return (math.pi - 2 * phi) / (2 * math.sin(phi) ** 2) - 1 / math.tan(phi) - target

    target = 2 * load * radius / flat**2
    lowest, highest = 1e-6, math.pi / 2 - 1e-9
    if excess(lowest) < 0:
        return flat / math.sin(lowest)
    return flat / math.sin(brentq(excess, lowest, highest)) if excess(highest) < 0 else flat


@dataclass(frozen=True)
class RoundedPunch:
    """Section of a punch; `flat` is the half-width of its flat face [m]."""

    flat: float
    radius: float
    height: float
    half: bool

    @property
    def end(self) -> float:
        """X of the end of the contact face [m]."""
        return self.flat + self.radius * math.sin(_END)

    @property
    def end_height(self) -> float:
        """Y of the end of the contact face [m]."""
        return self.radius * (1 - math.cos(_END))

    @property
    def largest(self) -> float:
        """Largest half-width of a contact zone [m]."""
        return self.flat + 0.6 * self.radius

    def cells(self, ends: np.ndarray, first: float) -> list[Sheet]:
        """Cells of the section.

        Parameters
        ----------
        ends : ndarray
            X at the element ends of the contact face; the outermost are moved to its ends [m].
        first : float
            Size of the first row above it [m], bounded by the radius of the rounding.
        """
        width = self.flat + self.radius
        shell = min(max(1.5 * self.radius, 0.4 * width), 0.7 * width, 0.7 * self.height)
        rows = depth_ends(min(first, self.radius), shell, 2.0) / shell
        along = self._along(ends)
        core = np.array([width - shell, shell])
        left = np.array([0.0, shell]) if self.half else core * [-1, 1]
        side = self._side_ends(min(first, self.radius))
        up = np.array([core, [core[0], self.height]])
        sheets = [
            ruled(self._contour, np.array([left, core]), along, rows),
            ruled(self._contour, up, side, rows),
            Sheet(
                grid(
                    np.linspace(left[0], core[0], len(along)),
                    np.linspace(shell, self.height, len(side)),
                )
            ),
        ]
        if not self.half:
            sheets.append(ruled(lambda s: self._contour(s) * [-1, 1], up * [-1, 1], side, rows))
        return sheets

    def _along(self, ends: np.ndarray) -> np.ndarray:
        """Arc lengths along the contour at x, the outermost moved to the ends of the face."""
        x = np.abs(ends)
        over = np.clip((x - self.flat) / self.radius, 0.0, math.sin(_END))
        along = np.minimum(x, self.flat) + self.radius * np.arcsin(over)
        along[[-1] if self.half else [0, -1]] = self.flat + self.radius * _END
        return np.sign(ends) * along

    def _side_ends(self, first: float) -> np.ndarray:
        """Arc lengths along the contour at the element ends beside the contact face."""
        start = self.flat + self.radius * _END
        corner = self.flat + self.radius * math.pi / 2
        up = self.height - self.radius
        return np.concatenate([[start], corner + depth_ends(min(first, up), up, 2.0)])

    def _contour(self, along: np.ndarray) -> np.ndarray:
        """Points of the contour: flat, rounding, side."""
        s = np.abs(along)
        angle = np.clip((s - self.flat) / self.radius, 0.0, math.pi / 2)
        x = np.minimum(s, self.flat) + self.radius * np.sin(angle)
        y = self.radius * 2 * np.sin(angle / 2) ** 2
        y = y + np.maximum(s - self.flat - self.radius * math.pi / 2, 0.0)
        return np.stack([np.sign(along) * x, y], axis=-1)

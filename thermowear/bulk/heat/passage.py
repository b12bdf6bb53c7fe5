"""Rigid-body motion of a body that passes through the frame, and carries heat along."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from dolfinx import fem

from ..field import geometry_space

_ROUNDING = 1e-6
"""Rounding of places at the ends of the contact, relative to the body."""


@dataclass(frozen=True)
class Passage:
    """Rigid-body motion of a body through the frame.

    Attributes
    ----------
    parts : tuple of str
        Names of the body and its zones.
    center : tuple of float or None
        Centre of rotation; None for motion along x [m].
    speed : float
        Velocity along x [m/s], or anticlockwise angular velocity [rad/s].
    spread : bool
        True in the limit of high speed, with uniform temperature along each path.
    contact : tuple of float
        Range of x of its contacts, beyond which a body that moves along x ends, by default no
        points [m].
    """

    parts: tuple[str, ...]
    center: tuple[float, float] | None
    speed: float
    spread: bool
    contact: tuple[float, float] = (np.inf, -np.inf)

    def across(self, points: np.ndarray) -> np.ndarray:
        """Coordinates across the motion, and zero: radius or y, and z; shape (..., 3) [m]."""
        result = np.zeros_like(points)
        x, y, result[..., 1] = np.moveaxis(points, -1, 0)
        radius = None if self.center is None else np.hypot(x - self.center[0], y - self.center[1])
        result[..., 0] = y if radius is None else radius
        return result

    def directions(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Unit vectors of these coordinates at points (n, 3)."""
        first, second = np.zeros_like(points), np.zeros_like(points)
        second[:, 2] = 1.0
        if self.center is None:
            first[:, 1] = 1.0
        else:
            first[:, :2] = points[:, :2] - np.array(self.center)
            first /= np.maximum(np.linalg.norm(first, axis=1, keepdims=True), 1e-300)
        return first, second

    def is_end(self, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """Test where outer facets, by midpoints and outward normals (n, 3), are ends of a bar."""
        if self.center is not None:
            return np.zeros(len(points), dtype=bool)
        (low, high), x, slope = self.contact, points[:, 0], normals[:, 0]
        rounding = _ROUNDING * max(np.ptp(x), 0.0)
        return ((x >= high - rounding) & (slope > 0)) | ((x <= low + rounding) & (slope < 0))

    def stream(self, mesh) -> fem.Function:
        """Stream function ψ with ``v = (∂ψ/∂y, -∂ψ/∂x)``, at unit speed."""
        ψ = fem.Function(geometry_space(mesh))
        ψ.interpolate(self._stream)
        return ψ

    def _stream(self, x: np.ndarray) -> np.ndarray:
        if self.center is None:
            return x[1]
        return -((x[0] - self.center[0]) ** 2 + (x[1] - self.center[1]) ** 2) / 2

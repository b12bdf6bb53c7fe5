"""How a two-dimensional mesh stands for a solid: strain and volume of each model.

Strains and stresses are always full 3 x 3 tensors in the order (x, y, out of plane), or (r, z, θ).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod

import numpy as np
import ufl


class Model(ABC):
    """What distinguishes one two-dimensional model from another.

    Attributes
    ----------
    name : str
        The value of ``model`` in a case file.
    press_direction : tuple of float
        Unit translation of body 1 that its holder leaves free, along the load.
    """

    name: str
    press_direction: tuple[float, float]

    @abstractmethod
    def speed(self, points: np.ndarray, motion) -> np.ndarray:
        """Sliding speed [m/s] at points of shape (n, 2) under the motion of the case."""

    @abstractmethod
    def integral(self, mesh, density, measure):
        """The form of a density over volume (cells) or surface (facets) of the solid."""

    @abstractmethod
    def area_factor(self, points: np.ndarray) -> np.ndarray:
        """Factor from length in the section to area, at points of shape (n, 2) [m]."""

    @abstractmethod
    def strain(self, mesh, u):
        """ε(u), 3 x 3."""

    @abstractmethod
    def on_axis(self, x: np.ndarray) -> np.ndarray:
        """Marks points whose first displacement vanishes by symmetry; x of shape (3, n)."""


class Axisymmetric(Model):
    """Solids of revolution; coordinates (r, z), displacement (u_r, u_z), no torsion.

    Body 1 lies above body 2 and is pressed down; it turns about the axis.
    """

    name = "axisymmetric"
    press_direction = (0.0, -1.0)

    def speed(self, points, motion):
        return motion.angular_velocity * points[:, 0]

    def integral(self, mesh, density, measure):
        return 2 * math.pi * ufl.SpatialCoordinate(mesh)[0] * density * measure

    def area_factor(self, points):
        return 2 * math.pi * points[:, 0]

    def strain(self, mesh, u):
        r = ufl.SpatialCoordinate(mesh)[0]
        e = ufl.sym(ufl.grad(u))
        return ufl.as_tensor([[e[0, 0], e[0, 1], 0], [e[1, 0], e[1, 1], 0], [0, 0, u[0] / r]])

    def on_axis(self, x):
        return np.abs(x[0]) < 1e-12


def section_measure(degree: int):
    """Integration over cells, exact for products of two fields of a degree on straight cells.

    Stated because the automatic choice differs between releases and takes 1/r for a polynomial.
    """
    return ufl.dx(metadata={"quadrature_degree": 2 * degree + 2})


MODELS: dict[str, Model] = {model.name: model for model in (Axisymmetric(),)}

"""How a mesh stands for a solid: strain, stress and volume of each model.

Strains and stresses are always full 3 x 3 tensors in the order (x, y, out of plane), (r, z, θ), or
(x, y, z).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod

import numpy as np
import ufl

from ..compat import coordinate_element


class Model(ABC):
    """What distinguishes one model from another.

    Attributes
    ----------
    name : str
        The value of ``model`` in a case file.
    """

    name: str

    @abstractmethod
    def sliding(
        self,
        points: np.ndarray,
        motion,
        center: tuple[float, float] | None = None,
        across: bool = False,
    ) -> np.ndarray:
        """Velocity of body 1 relative to body 2; the last component is across a section.

        Parameters
        ----------
        points : ndarray, shape (n, gdim) [m]
        motion : thermowear.case.tables.schema.Motion
        center : tuple of float, optional
            x and y of the point, or of the vertical axis, about which body 2 turns [m].
        across : bool
            Whether body 1 slides across a plane section and not along x.

        Returns
        -------
        ndarray, shape (n, 3) [m/s]
        """

    @abstractmethod
    def integral(self, mesh, density, measure):
        """The form of a density over volume (cells) or surface (facets) of the solid."""

    @abstractmethod
    def area_factor(self, points: np.ndarray) -> np.ndarray:
        """Factor from facets of the mesh to area, at points of shape (n, gdim) [m, or 1 in 3D]."""

    @abstractmethod
    def strain(self, mesh, u):
        """ε(u), 3 x 3."""

    def strain_across(
        self, values: np.ndarray, slopes: np.ndarray, points: np.ndarray
    ) -> np.ndarray:
        """Strain across the section due to a first displacement, as numbers; as in `strain`.

        Parameters
        ----------
        values : ndarray, shape (n, m)
            m displacements at the points.
        slopes : ndarray, shape (n, m, 2)
            Their derivatives along both coordinates [1/m].
        points : ndarray, shape (n, 2) [m]

        Returns
        -------
        ndarray, shape (n, m) [1/m]
        """
        return np.zeros_like(values)

    def lame(self, young_modulus: float, poisson_ratio: float) -> tuple[float, float]:
        """λ and μ of the law ``σ = λ tr ε I + 2 μ ε`` between `strain` and `stress` [Pa]."""
        E, ν = young_modulus, poisson_ratio
        return E * ν / ((1 + ν) * (1 - 2 * ν)), E / (2 * (1 + ν))

    def thermal_modulus(self, young_modulus: float, poisson_ratio: float) -> float:
        """Stress per prevented thermal strain [Pa]."""
        λ, μ = self.lame(young_modulus, poisson_ratio)
        return 3 * λ + 2 * μ

    def stress(self, strain, lame, thermal):
        """σ, 3 x 3 [Pa].

        Parameters
        ----------
        strain : UFL expression
            From `strain`.
        lame : tuple of UFL expressions
            λ and μ [Pa].
        thermal : UFL expression or float
            Thermal modulus times thermal strain, 0 without heat [Pa].
        """
        λ, μ = lame
        return (λ * ufl.tr(strain) - thermal) * ufl.Identity(3) + 2 * μ * strain

    def on_axis(self, x: np.ndarray) -> np.ndarray:
        """Marks points whose first displacement vanishes by symmetry; x of shape (3, n)."""
        return np.zeros(x.shape[1], dtype=bool)


class Axisymmetric(Model):
    """Solids of revolution; coordinates (r, z), displacement (u_r, u_z), no torsion.

    Body 1 turns about the axis.

    Parameters
    ----------
    sector : float
        Part of the circumference that the solid takes up: forces are of it.
    """

    name = "axisymmetric"

    def __init__(self, sector: float = 1.0):
        self.sector = sector

    def sliding(self, points, motion, center=None, across=False):
        if motion.velocity is not None:  # across the axis, in no direction of the section
            speed = np.full(len(points), motion.velocity)
        else:
            speed = motion.angular_velocity * points[:, 0]
        return np.outer(speed, (0.0, 0.0, 1.0))

    def integral(self, mesh, density, measure):
        return 2 * math.pi * self.sector * ufl.SpatialCoordinate(mesh)[0] * density * measure

    def area_factor(self, points):
        return 2 * math.pi * self.sector * points[:, 0]

    def strain(self, mesh, u):
        r = ufl.SpatialCoordinate(mesh)[0]
        e = ufl.sym(ufl.grad(u))
        return ufl.as_tensor([[e[0, 0], e[0, 1], 0], [e[1, 0], e[1, 1], 0], [0, 0, u[0] / r]])

    def strain_across(self, values, slopes, points):
        axis = self.on_axis(points.T)
        radius = np.where(axis, 1.0, points[:, 0])
        return np.where(axis[:, None], slopes[..., 0], values / radius[:, None])

    def on_axis(self, x):
        return np.abs(x[0]) < 1e-12


class PlaneStrain(Model):
    """A long solid cut to a thickness; no strain across it.

    Body 1 slides along x or across the section, or body 2 turns under it about a point of it.

    Parameters
    ----------
    thickness : float
        Of the whole, twice the modelled one where only half of a symmetric section is meshed [m].
    """

    name = "plane-strain"

    def __init__(self, thickness: float):
        self.thickness = thickness

    def sliding(self, points, motion, center=None, across=False):
        if across:
            return np.tile((0.0, 0.0, motion.velocity), (len(points), 1))
        return _along_or_round(points, motion, center)

    def integral(self, mesh, density, measure):
        return self.thickness * density * measure

    def area_factor(self, points):
        return np.full(len(points), self.thickness)

    def strain(self, mesh, u):
        e = ufl.sym(ufl.grad(u))
        return ufl.as_tensor([[e[0, 0], e[0, 1], 0], [e[1, 0], e[1, 1], 0], [0, 0, 0]])


class PlaneStress(PlaneStrain):
    """A thin plate; no stress across it. `strain` leaves out the strain across it."""

    name = "plane-stress"

    def lame(self, young_modulus, poisson_ratio):
        E, ν = young_modulus, poisson_ratio
        return E * ν / (1 - ν**2), E / (2 * (1 + ν))

    def thermal_modulus(self, young_modulus, poisson_ratio):
        return young_modulus / (1 - poisson_ratio)

    def stress(self, strain, lame, thermal):
        σ = super().stress(strain, lame, thermal)
        return ufl.as_tensor([[σ[0, 0], σ[0, 1], 0], [σ[1, 0], σ[1, 1], 0], [0, 0, 0]])


class Spatial(Model):
    """Solids as they are; coordinates (x, y, z).

    Body 1 slides along x, or body 2 turns under it about a vertical axis.
    """

    name = "3d"

    def sliding(self, points, motion, center=None, across=False):
        return _along_or_round(points, motion, center)

    def integral(self, mesh, density, measure):
        return density * measure

    def area_factor(self, points):
        return np.ones(len(points))

    def strain(self, mesh, u):
        return ufl.sym(ufl.grad(u))


def _along_or_round(points: np.ndarray, motion, center) -> np.ndarray:
    """Velocity of body 1 along x, or over a body 2 that turns anticlockwise from x to y."""
    velocity = np.zeros((len(points), 3))
    if center is None:
        velocity[:, 0] = motion.velocity
    else:
        arms = points[:, :2] - np.asarray(center)
        velocity[:, 0] = motion.angular_velocity * arms[:, 1]
        velocity[:, 1] = -motion.angular_velocity * arms[:, 0]
    return velocity


def section_model(name: str, thickness: float | None, sector: float = 1.0) -> Model:
    """The model of a name.

    Parameters
    ----------
    name : str
        The value of ``model`` in a case file.
    thickness : float or None
        Of plane models, see `PlaneStrain` [m].
    sector : float
        Of axisymmetric models, see `Axisymmetric`.
    """
    if name == Axisymmetric.name:
        return Axisymmetric(sector)
    if name == Spatial.name:
        return Spatial()
    assert thickness is not None
    return {model.name: model for model in (PlaneStrain, PlaneStress)}[name](thickness)


def section_measure(mesh, degree: int):
    """Integration over cells, exact for products of two gradients on straight cells.

    Stated because the automatic choice differs between releases and takes 1/r for a polynomial.
    Straight hexahedra need no more than one point a direction above the degree, the only ones for
    which it matters.
    """
    straight = mesh.topology.dim == 3 and coordinate_element(mesh).degree == 1
    return ufl.dx(metadata={"quadrature_degree": 2 * degree + (1 if straight else 2)})

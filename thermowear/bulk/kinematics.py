"""Kinematic models: strain, stress and volume; waves along the sliding direction.

Strains and stresses are always full 3 x 3 tensors in the order (x, y, out of plane), (r, z, θ), or
(x, y, z).

A field ``Re(f exp(i m s))`` varies along the path s of sliding with the wave number m: round the
axis of a solid of revolution, ``m s = N θ`` with N waves (harmonic elements: E. L.
Wilson, AIAA J. 3 (1965) 2269), or along a prism. The displacement is ``(u1, u2, i w)`` with
components u1 and u2 in the section and w along the wave. For an isotropic body the equations of u1,
u2 and w are then real. Strains are real in the section, and imaginary in the two shears along the
wave: `strain` gives their amplitudes, so that products of strains are energies.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod

import numpy as np
import ufl
from dolfinx import default_scalar_type, fem

from ..compat import coordinate_element


class Kinematics(ABC):
    """Interface of the kinematic models.

    Attributes
    ----------
    name : str
        The value of ``model`` in a case file.
    """

    name: str

    def components(self, dim: int) -> int:
        """Number of displacement components on meshes of a dimension."""
        return dim

    @abstractmethod
    def sliding(
        self,
        points: np.ndarray,
        motion,
        center: tuple[float, float] | None = None,
        across: bool = False,
    ) -> np.ndarray:
        """Velocity of body 1 relative to body 2; the last component is normal to a section.

        Parameters
        ----------
        points : ndarray, shape (n, gdim) [m]
        motion : thermowear.model.conditions.Motion
        center : tuple of float, optional
            x and y of the point, or of the vertical axis, about which body 2 rotates [m].
        across : bool
            True if body 1 slides normal to a plane section instead of along x.

        Returns
        -------
        ndarray, shape (n, 3) [m/s]
        """

    @abstractmethod
    def depth(self, x):
        """Measure of the solid per measure of the mesh at coordinates x[k] [m, or 1 in 3D]."""

    def integral(self, mesh, density, measure):
        """Integral form of a density over volume (cells) or surface (facets) of the solid."""
        return self.depth(ufl.SpatialCoordinate(mesh)) * density * measure

    def area_factor(self, points: np.ndarray) -> np.ndarray:
        """Area of the solid per measure of mesh facets at points (n, gdim), see `depth`."""
        return np.full(len(points), self.depth(points.T), dtype=float)

    @abstractmethod
    def strain(self, mesh, u):
        """Strain tensor ε(u), 3 x 3."""

    def strain_across(
        self, values: np.ndarray, slopes: np.ndarray, points: np.ndarray
    ) -> np.ndarray:
        """Out-of-plane strain due to the first displacement component; numbers, see `strain`.

        Parameters
        ----------
        values : ndarray, shape (n, m)
            Values of m displacement fields at the points.
        slopes : ndarray, shape (n, m, 2)
            Derivatives of the fields along both coordinates [1/m].
        points : ndarray, shape (n, 2) [m]

        Returns
        -------
        ndarray, shape (n, m) [1/m]
        """
        return np.zeros_like(values)

    def lame(self, young_modulus: float, poisson_ratio: float) -> tuple[float, float]:
        """Lamé constants λ, μ of ``σ = λ tr ε I + 2 μ ε`` with `strain` and `stress` [Pa]."""
        E, ν = young_modulus, poisson_ratio
        return E * ν / ((1 + ν) * (1 - 2 * ν)), E / (2 * (1 + ν))

    def thermal_modulus(self, young_modulus: float, poisson_ratio: float) -> float:
        """Stress per constrained thermal strain [Pa]."""
        λ, μ = self.lame(young_modulus, poisson_ratio)
        return 3 * λ + 2 * μ

    def stress(self, strain, lame, thermal):
        """Stress tensor σ, 3 x 3 [Pa].

        Parameters
        ----------
        strain : UFL expression
            Strain tensor, see `strain`.
        lame : tuple of UFL expressions
            λ and μ [Pa].
        thermal : UFL expression or float
            Thermal modulus times thermal strain; 0 without heat [Pa].
        """
        λ, μ = lame
        return (λ * ufl.tr(strain) - thermal) * ufl.Identity(3) + 2 * μ * strain

    def on_axis(self, x: np.ndarray) -> np.ndarray:
        """Mask of points on the axis of symmetry; x of shape (3, n)."""
        return np.zeros(x.shape[1], dtype=bool)

    def vanishes_on_axis(self, component: int) -> bool:
        """True if a displacement component vanishes on the axis by symmetry."""
        return component == 0


class Axisymmetric(Kinematics):
    """Solids of revolution; coordinates (r, z), displacement (u_r, u_z), no torsion.

    Body 1 rotates about the axis.

    Parameters
    ----------
    sector : float
        Fraction of the circumference taken up by the solid; forces refer to this fraction.
    """

    name = "axisymmetric"

    def __init__(self, sector: float = 1.0):
        self.sector = sector

    def sliding(self, points, motion, center=None, across=False):
        if motion.velocity is not None:  # circumferential
            speed = np.full(len(points), motion.velocity)
        else:
            speed = motion.angular_velocity * points[:, 0]
        return np.outer(speed, (0.0, 0.0, 1.0))

    def depth(self, x):
        return 2 * math.pi * self.sector * x[0]

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


class PlaneStrain(Kinematics):
    """Plane strain of a section of given thickness.

    Body 1 slides along x or normal to the section, or body 2 rotates about a point of the section.

    Parameters
    ----------
    thickness : float
        Total thickness, doubled where only half of a symmetric section is meshed [m].
    """

    name = "plane-strain"

    def __init__(self, thickness: float):
        self.thickness = thickness

    def sliding(self, points, motion, center=None, across=False):
        if across:
            return np.tile((0.0, 0.0, motion.velocity), (len(points), 1))
        return _along_or_round(points, motion, center)

    def depth(self, x):
        return self.thickness

    def strain(self, mesh, u):
        e = ufl.sym(ufl.grad(u))
        return ufl.as_tensor([[e[0, 0], e[0, 1], 0], [e[1, 0], e[1, 1], 0], [0, 0, 0]])


class PlaneStress(PlaneStrain):
    """Plane stress of a thin plate; `strain` omits the out-of-plane component."""

    name = "plane-stress"

    def lame(self, young_modulus, poisson_ratio):
        E, ν = young_modulus, poisson_ratio
        return E * ν / (1 - ν**2), E / (2 * (1 + ν))

    def thermal_modulus(self, young_modulus, poisson_ratio):
        return young_modulus / (1 - poisson_ratio)

    def stress(self, strain, lame, thermal):
        σ = super().stress(strain, lame, thermal)
        return ufl.as_tensor([[σ[0, 0], σ[0, 1], 0], [σ[1, 0], σ[1, 1], 0], [0, 0, 0]])


class Spatial(Kinematics):
    """Three-dimensional solids; coordinates (x, y, z).

    Body 1 slides along x or turns about an axis, or body 2 rotates about a vertical axis.
    """

    name = "3d"

    def sliding(self, points, motion, center=None, across=False):
        if motion.axis is not None:
            return motion.axis.velocity(points, motion.angular_velocity)
        return _along_or_round(points, motion, center)

    def depth(self, x):
        return 1

    def strain(self, mesh, u):
        return ufl.sym(ufl.grad(u))


def _along_or_round(points: np.ndarray, motion, center) -> np.ndarray:
    """Velocity of body 1 along x, or relative to body 2 rotating anticlockwise (x to y)."""
    velocity = np.zeros((len(points), 3))
    if center is None:
        velocity[:, 0] = motion.velocity
    else:
        arms = points[:, :2] - np.asarray(center)
        velocity[:, 0] = motion.angular_velocity * arms[:, 1]
        velocity[:, 1] = -motion.angular_velocity * arms[:, 0]
    return velocity


def kinematics_of(name: str, thickness: float | None, sector: float = 1.0) -> Kinematics:
    """Kinematic model by its name.

    Parameters
    ----------
    name : str
        The value of ``model`` in a case file.
    thickness : float or None
        Thickness of plane models, see `PlaneStrain` [m].
    sector : float
        Fraction of the circumference of axisymmetric models, see `Axisymmetric`.
    """
    if name == Axisymmetric.name:
        return Axisymmetric(sector)
    if name == Spatial.name:
        return Spatial()
    assert thickness is not None
    return {model.name: model for model in (PlaneStrain, PlaneStress)}[name](thickness)


def section_measure(mesh, degree: int):
    """Measure of integration over cells, exact for products of two gradients on straight cells.

    The quadrature degree is given explicitly, as the automatic choice differs between releases and
    treats 1/r as a polynomial. Straight hexahedra need only one point per direction more than the
    degree; for other cells the number of points matters little.
    """
    straight = mesh.topology.dim == 3 and coordinate_element(mesh).degree == 1
    return ufl.dx(metadata={"quadrature_degree": 2 * degree + (1 if straight else 2)})


class Wave(Kinematics):
    """Interface of the kinematics of waves.

    Attributes
    ----------
    number : float
        Number N of waves round the axis, or the wave number along a prism [1/m].
    """

    number: float

    def components(self, dim: int) -> int:
        return dim + 1

    @property
    def is_uniform(self) -> bool:
        """True if nothing varies along the sliding direction."""
        return self.number == 0

    def _constant(self, mesh) -> fem.Constant:
        """The number as a constant of forms, which are compiled once for all waves."""
        return fem.Constant(mesh, default_scalar_type(self.number))

    @abstractmethod
    def wave_number(self, mesh):
        """Wave number m, a UFL expression [1/m]."""

    @abstractmethod
    def strain(self, mesh, u):
        """Strain amplitudes of ``u = (u1, u2, w)``, 3 x 3."""

    @abstractmethod
    def rigid_motions(self, points: np.ndarray) -> dict[str, np.ndarray]:
        """Rigid motions that vary as the wave, by name, shape (n, 3) each [m per unit].

        Parameters
        ----------
        points : ndarray, shape (n, 2) [m]
        """


class RingWave(Wave, Axisymmetric):
    """Waves round the axis of solids of revolution; coordinates (r, z).

    Parameters
    ----------
    number : int
        Number N of waves on the circumference.
    sector : float
        See `Axisymmetric`.
    """

    def __init__(self, number: int, sector: float = 1.0):
        super().__init__(sector)
        self.number = number

    def wave_number(self, mesh):
        return self._constant(mesh) / ufl.SpatialCoordinate(mesh)[0]

    def strain(self, mesh, u):
        g, r = ufl.grad(u), ufl.SpatialCoordinate(mesh)[0]
        m = self._constant(mesh) / r
        rz = (g[0, 1] + g[1, 0]) / 2
        rθ, zθ = (m * u[0] + g[2, 0] - u[2] / r) / 2, (m * u[1] + g[2, 1]) / 2
        return ufl.as_tensor([[g[0, 0], rz, rθ], [rz, g[1, 1], zθ], [rθ, zθ, u[0] / r - m * u[2]]])

    def vanishes_on_axis(self, component):
        # one wave may shift the axis across itself, and no other field has a value there
        return component == 1 if self.number == 1 else self.number > 1 or component != 1

    def rigid_motions(self, points):
        if self.number > 1:
            return {}
        one, (r, z) = np.ones(len(points)), points.T
        if self.is_uniform:
            return {"shift along the axis": np.stack([0 * one, one, 0 * one], axis=1)}
        return {
            "shift across the axis": np.stack([one, 0 * one, one], axis=1),
            "tilt": np.stack([-z, r, -z], axis=1),
        }


class PrismWave(Wave, PlaneStrain):
    """Waves along a prism, normal to the section.

    Parameters
    ----------
    number : float
        Wave number [1/m].
    thickness : float
        See `PlaneStrain` [m].
    """

    def __init__(self, number: float, thickness: float):
        super().__init__(thickness)
        self.number = number

    def wave_number(self, mesh):
        return self._constant(mesh)

    def strain(self, mesh, u):
        g, m = ufl.grad(u), self._constant(mesh)
        xy = (g[0, 1] + g[1, 0]) / 2
        xs, ys = (m * u[0] + g[2, 0]) / 2, (m * u[1] + g[2, 1]) / 2
        return ufl.as_tensor([[g[0, 0], xy, xs], [xy, g[1, 1], ys], [xs, ys, -m * u[2]]])

    def vanishes_on_axis(self, component):
        return False

    def rigid_motions(self, points):
        return {}


def wave_along(name: str, number: float, thickness: float | None, sector: float) -> Wave:
    """Kinematics of a wave in a model.

    Parameters
    ----------
    name : str
        ``"axisymmetric"`` or ``"plane-strain"``.
    number : float
        Number of waves round the axis, or wave number along a prism [1/m].
    thickness : float or None
        Of plane models [m].
    sector : float
        Of axisymmetric models.
    """
    if name == Axisymmetric.name:
        return RingWave(int(number), sector)
    assert thickness is not None
    return PrismWave(number, thickness)

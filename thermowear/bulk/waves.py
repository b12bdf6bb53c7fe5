"""Kinematics of waves along the sliding direction, in sections normal to it.

A field ``Re(f exp(i m s))`` varies along the path s of sliding with the wave number m: round the
axis of a solid of revolution, ``m s = N θ`` with N waves (harmonic elements: E. L.
Wilson, AIAA J. 3 (1965) 2269), or along a prism. The displacement is ``(u1, u2, i w)`` with
components u1 and u2 in the section and w along the wave. For an isotropic body the equations of u1,
u2 and w are then real. Strains are real in the section, and imaginary in the two shears along the
wave: `strain` gives their amplitudes, so that products of strains are energies.
"""

from __future__ import annotations

from abc import abstractmethod

import numpy as np
import ufl
from dolfinx import default_scalar_type, fem

from .kinematics import Axisymmetric, Kinematics, PlaneStrain


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

"""Linear elasticity of one body: forms and stiffness."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from petsc4py import PETSc

import numpy as np
import ufl
from dolfinx import default_scalar_type, fem

from ..body_mesh import BodyMesh
from ..compiled import assembled_matrix
from ..kinematics import Kinematics, section_measure
from .smoothed_stiffness import edge_smoothed_stiffness


@dataclass(frozen=True)
class ElasticMaterial:
    """Isotropic material: Young's modulus [Pa], Poisson ratio, thermal expansion [1/K]."""

    young_modulus: float
    poisson_ratio: float
    expansion: float = 0.0


@dataclass(frozen=True)
class ElasticForms:
    """Forms of linear elasticity with thermal strain in one body.

    Attributes
    ----------
    body : BodyMesh
    kinematics : Kinematics
    lame : tuple of dolfinx.fem.Function
        λ, μ and thermal modulus times α of the model, constant on each part [Pa, Pa/K].
    """

    body: BodyMesh
    kinematics: Kinematics
    lame: tuple[fem.Function, fem.Function, fem.Function]

    def stress(self, u, rise=None):
        """Stress of a displacement and a temperature rise, 3 x 3 [Pa]."""
        λ, μ, m = self.lame
        ε = self.kinematics.strain(self.body.mesh, u)
        return self.kinematics.stress(ε, (λ, μ), 0.0 if rise is None else m * rise)

    def virtual_work(self, u, δu, degree: int):
        """Form of the virtual work of the stress of u on the strain of δu [J].

        `degree` is the polynomial degree for which the quadrature is exact.
        """
        mesh, (λ, μ, _) = self.body.mesh, self.lame
        ε, δε = self.kinematics.strain(mesh, u), self.kinematics.strain(mesh, δu)
        density = λ * ufl.tr(ε) * ufl.tr(δε) + 2 * μ * ufl.inner(ε, δε)
        return self.kinematics.integral(mesh, density, section_measure(mesh, degree))

    def thermal_work(self, rise, δu, degree: int):
        """Form of the work of the thermal stress of a temperature rise on the strain of δu [J]."""
        mesh = self.body.mesh
        ε = self.kinematics.strain(mesh, δu)
        measure = section_measure(mesh, degree)
        return self.kinematics.integral(mesh, self.lame[2] * rise * ufl.tr(ε), measure)

    def traction_work(self, surface: str, traction: np.ndarray) -> Callable:
        """Form of the work of a uniform traction (gdim,) [Pa], a function of displacement [J]."""
        value = np.asarray(traction, dtype=default_scalar_type)
        return self._work(surface, fem.Constant(self.body.mesh, value))

    def pressure_work(self, surface: str, pressure: float) -> Callable:
        """Form of the work of a pressure [Pa] along the inward normal; see `traction_work`."""
        mesh = self.body.mesh
        constant = fem.Constant(mesh, default_scalar_type(pressure))
        return self._work(surface, -constant * ufl.FacetNormal(mesh))

    def _work(self, surface: str, traction) -> Callable:
        mesh, measure = self.body.mesh, self.body.surface_measure(surface)
        return lambda δu: self.kinematics.integral(mesh, ufl.inner(traction, δu), measure)

    def stiffness(self, space: fem.FunctionSpace, blocked: bool = False) -> PETSc.Mat:
        """Stiffness without supports in a space, see `assembled_matrix`. Every rank calls."""
        u, δu = ufl.TrialFunction(space), ufl.TestFunction(space)
        work = self.virtual_work(u, δu, space.ufl_element().degree)
        return assembled_matrix(work, blocked=blocked)

    def coarse_stiffness(self, linear: fem.FunctionSpace, degree: int) -> PETSc.Mat:
        """Stiffness without supports of linear elements, as a coarse level below others.

        Parameters
        ----------
        linear : dolfinx.fem.FunctionSpace
        degree : int
            Degree of the finer ones; above one, tetrahedra have smoothed strains.
        """
        if degree > 1 and self.body.cell_type == "tetrahedron":
            return edge_smoothed_stiffness(linear, self.lame[:2])
        return self.stiffness(linear)

    def load_of_rises(self, rises: fem.FunctionSpace, space: fem.FunctionSpace, only: str | None):
        """Bilinear form of `thermal_work`, of the part `only` or of all."""
        rise, δu = ufl.TrialFunction(rises), ufl.TestFunction(space)
        if only is not None:
            rise = self.body.per_part({only: 1.0}) * rise
        return self.thermal_work(rise, δu, rises.ufl_element().degree)

    @cached_property
    def least_compressibility(self) -> float:
        """Smallest ``1 - 2 ν = μ / (λ + μ)`` in the cells of this rank."""
        λ, μ, _ = (constant.x.array for constant in self.lame)
        return float((μ / (λ + μ)).min(initial=1.0))


@dataclass(frozen=True)
class ElasticBody(ElasticForms):
    """Elasticity of one body in its displacement space.

    Attributes
    ----------
    space : dolfinx.fem.FunctionSpace
        Displacement space [m].
    fixed : ndarray of bool, shape (n_owned,)
        Mask of values held at zero.
    """

    space: fem.FunctionSpace
    fixed: np.ndarray

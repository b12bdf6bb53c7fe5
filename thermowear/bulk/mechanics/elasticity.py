"""Linear elasticity of both bodies, with thermal strain."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp
import ufl
from dolfinx import default_scalar_type, fem
from dolfinx import mesh as dmesh

from ..bodies import Bodies
from ..compiled import assembled_matrix, surface_area
from ..direct_solver import eliminate, multiply
from ..field import lagrange_space, owned, without_fixed
from ..kinematics import Kinematics, section_measure
from ..solver_choice import AnySolver, SolverChoice, linear_solver


@dataclass(frozen=True)
class ElasticMaterial:
    """Isotropic material: Young's modulus [Pa], Poisson ratio, thermal expansion [1/K]."""

    young_modulus: float
    poisson_ratio: float
    expansion: float = 0.0


@dataclass(frozen=True)
class Elasticity:
    """Elasticity problem of the bodies, with the solver of its equations.

    Attributes
    ----------
    bodies : Bodies
    kinematics : Kinematics
    space : dolfinx.fem.FunctionSpace
        Displacement space [m].
    fixed : ndarray of bool, shape (n_owned,)
        Mask of values held at zero.
    support_rows : petsc4py.PETSc.Mat
        Rows of the stiffness of these values, for the support reactions.
    factor : DirectSolver or MultigridSolver
        Solver of the supported stiffness.
    lame : tuple of dolfinx.fem.Function
        λ, μ and thermal modulus times α of the model, constant on each body [Pa, Pa/K].
    """

    bodies: Bodies
    kinematics: Kinematics
    space: fem.FunctionSpace
    fixed: np.ndarray
    support_rows: PETSc.Mat
    factor: AnySolver
    lame: tuple[fem.Function, fem.Function, fem.Function]

    @cached_property
    def stiffness(self) -> PETSc.Mat:
        """Stiffness without supports, assembled on first use. Every rank calls."""
        return _stiffness(self.bodies, self.kinematics, self.lame, self.space)

    def stress(self, u, rise=None):
        """Stress of a displacement and a temperature rise, 3 x 3 [Pa]."""
        λ, μ, m = self.lame
        ε = self.kinematics.strain(self.bodies.mesh, u)
        return self.kinematics.stress(ε, (λ, μ), 0.0 if rise is None else m * rise)

    def virtual_work(self, u, δu, degree: int):
        """Form of the virtual work of the stress of u on the strain of δu [J].

        `degree` is the polynomial degree for which the quadrature is exact.
        """
        measure = section_measure(self.bodies.mesh, degree)
        return _virtual_work(self.bodies.mesh, self.kinematics, self.lame, u, δu, measure)

    def thermal_work(self, rise, δu, degree: int):
        """Form of the work of the thermal stress of a temperature rise on the strain of δu [J]."""
        mesh = self.bodies.mesh
        ε = self.kinematics.strain(mesh, δu)
        measure = section_measure(mesh, degree)
        return self.kinematics.integral(mesh, self.lame[2] * rise * ufl.tr(ε), measure)

    def surface_work(self, surface: str, force: np.ndarray) -> Callable:
        """Form of the work of a force distributed over a surface, a function of displacement [J].

        Parameters
        ----------
        surface : str
        force : ndarray, shape (gdim,)
            Total force on the ring or over the thickness [N].
        """
        area = surface_area(self.bodies, self.kinematics, surface)
        force = np.asarray(force, dtype=default_scalar_type)
        return self._traction_work(surface, fem.Constant(self.bodies.mesh, force / area))

    def pressure_work(self, surface: str, pressure: float) -> Callable:
        """Form of the work of a pressure [Pa] along the inward normal; see `surface_work`."""
        mesh = self.bodies.mesh
        constant = fem.Constant(mesh, default_scalar_type(pressure))
        return self._traction_work(surface, -constant * ufl.FacetNormal(mesh))

    def _traction_work(self, surface: str, traction) -> Callable:
        mesh, measure = self.bodies.mesh, self.bodies.surface_measure(surface)
        return lambda δu: self.kinematics.integral(mesh, ufl.inner(traction, δu), measure)

    def solve(self, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Displacements [m] due to nodal loads [N]; owned rows, one or several columns."""
        return self.factor.solve(without_fixed(loads, self.fixed))

    def reactions(self, displacement: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Support reactions [N], owned rows; zero in the free values."""
        result = np.zeros(len(self.fixed))
        result[self.fixed] = multiply(self.support_rows, displacement) - loads[self.fixed]
        return result

    def compressibility(self) -> float:
        """Smallest ``1 - 2 ν = μ / (λ + μ)`` of the bodies; every rank calls."""
        λ, μ, _ = (constant.x.array for constant in self.lame)
        return min(self.bodies.mesh.comm.allgather(float((μ / (λ + μ)).min(initial=1.0))))

    def owned_by(self, *parts: str) -> np.ndarray:
        """Mask of the owned nodes that belong to parts of bodies, shape (n_owned / gdim,)."""
        nodes = np.unique(self.space.dofmap.list[self.bodies.cells(*parts)])
        belongs = np.zeros(self.space.dofmap.index_map.size_local, dtype=bool)
        belongs[nodes[nodes < len(belongs)]] = True
        return belongs

    def nodes(self) -> np.ndarray:
        """Coordinates of the owned nodes, shape (n_owned / gdim, gdim) [m]."""
        count, dim = self.space.dofmap.index_map.size_local, self.bodies.mesh.geometry.dim
        return self.space.tabulate_dof_coordinates()[:count, :dim]

    def thermal_load(
        self, temperature_space: fem.FunctionSpace, only: str | None = None
    ) -> PETSc.Mat:
        """Matrix of nodal loads of a temperature rise, ``∫ m T tr ε(δu) dV`` [N/K].

        Over all bodies, or over the part `only`.
        """
        rise, δu = ufl.TrialFunction(temperature_space), ufl.TestFunction(self.space)
        if only is not None:
            rise = self.bodies.per_body({only: 1.0}) * rise
        degree = temperature_space.ufl_element().degree
        return assembled_matrix(self.thermal_work(rise, δu, degree))


def elasticity(
    bodies: Bodies,
    kinematics: Kinematics,
    degree: int,
    materials: dict[str, ElasticMaterial],
    clamped: list[str],
    symmetric: tuple[str, ...] = (),
    rollers: tuple[str, ...] = (),
    choice: SolverChoice | None = None,
) -> Elasticity:
    """Assemble the stiffness and set up its solver. Every rank calls.

    Parameters
    ----------
    bodies : Bodies
    kinematics : Kinematics
    degree : int
        Polynomial degree of the displacement.
    materials : dict of str to ElasticMaterial
        Materials by body.
    clamped : list of str
        Surfaces fixed in all directions; every body needs one.
    symmetric : tuple of str
        Surfaces on a plane of symmetry x = const.: the first displacement component vanishes.
    rollers : tuple of str
        Surfaces whose second displacement component vanishes.
    choice : SolverChoice, optional
        Direct by default.
    """
    mesh = bodies.mesh
    space = lagrange_space(mesh, degree, mesh.geometry.dim)
    lame = _lame(bodies, kinematics, materials)

    assembled = partial(_stiffness, bodies, kinematics, lame)
    matrix = assembled(space)
    fixed = fixed_values(bodies, kinematics, space, clamped, {0: symmetric, 1: rollers})
    support_rows = _rows(matrix, fixed)
    eliminate(matrix, fixed)
    factor = linear_solver(choice or SolverChoice(), matrix, space, fixed, coarse=assembled)
    return Elasticity(bodies, kinematics, space, fixed, support_rows, factor, lame)


def _stiffness(bodies: Bodies, kinematics: Kinematics, lame, space: fem.FunctionSpace) -> PETSc.Mat:
    """Stiffness without supports in a space. Every rank calls."""
    u, δu = ufl.TrialFunction(space), ufl.TestFunction(space)
    measure = section_measure(bodies.mesh, space.ufl_element().degree)
    return assembled_matrix(_virtual_work(bodies.mesh, kinematics, lame, u, δu, measure))


def supported(stiffness: PETSc.Mat, fixed: np.ndarray) -> PETSc.Mat:
    """Copy of a stiffness with rows and columns of fixed values eliminated. Every rank calls."""
    result = stiffness.copy()
    eliminate(result, fixed)
    return result


def _rows(matrix: PETSc.Mat, chosen: np.ndarray) -> PETSc.Mat:
    """Rows of a matrix chosen by a mask of owned values. Every rank calls."""
    (first, _), (start, end) = matrix.getOwnershipRange(), matrix.getOwnershipRangeColumn()
    rows = (np.flatnonzero(chosen) + first).astype(PETSc.IntType)
    return matrix.createSubMatrix(
        PETSc.IS().createGeneral(rows, matrix.comm),
        PETSc.IS().createStride(end - start, start, 1, comm=matrix.comm),
    )


def _virtual_work(mesh, kinematics: Kinematics, lame, u, δu, measure):
    λ, μ, _ = lame
    ε, δε = kinematics.strain(mesh, u), kinematics.strain(mesh, δu)
    density = λ * ufl.tr(ε) * ufl.tr(δε) + 2 * μ * ufl.inner(ε, δε)
    return kinematics.integral(mesh, density, measure)


def _lame(bodies: Bodies, kinematics: Kinematics, materials: dict[str, ElasticMaterial]):
    λ, μ, m = {}, {}, {}
    for name, material in materials.items():
        E, ν = material.young_modulus, material.poisson_ratio
        λ[name], μ[name] = kinematics.lame(E, ν)
        m[name] = kinematics.thermal_modulus(E, ν) * material.expansion
    return bodies.per_body(λ), bodies.per_body(μ), bodies.per_body(m)


def fixed_values(bodies: Bodies, kinematics: Kinematics, space, clamped, guided) -> np.ndarray:
    """Mask of the owned values fixed by supports, symmetry planes and the axis of symmetry.

    Parameters
    ----------
    bodies : Bodies
    kinematics : Kinematics
    space : dolfinx.fem.FunctionSpace
        Vector-valued space.
    clamped : sequence of str
        Surfaces fixed in all directions.
    guided : dict of int to sequence of str
        Surfaces by the component that they fix.
    """
    mesh = bodies.mesh
    tdim = mesh.topology.dim
    bs, count = space.dofmap.index_map_bs, space.dofmap.index_map.size_local
    held = np.zeros(owned(space), dtype=bool)
    for component in range(mesh.geometry.dim):
        facets = [bodies.facets(surface) for surface in clamped]
        facets += [bodies.facets(surface) for surface in guided.get(component, ())]
        if component == 0:
            facets.append(dmesh.locate_entities_boundary(mesh, tdim - 1, kinematics.on_axis))
        nodes = fem.locate_dofs_topological(
            space, tdim - 1, np.unique(np.concatenate(facets)).astype(np.int32)
        )
        held[nodes[nodes < count] * bs + component] = True
    return held

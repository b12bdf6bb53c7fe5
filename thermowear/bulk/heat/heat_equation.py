"""Assembly of the heat equation: conduction, cooling, storage and advection."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from petsc4py import PETSc

import numpy as np
import ufl
from dolfinx import default_scalar_type, fem

from ..bodies import Bodies
from ..compiled import assembled_matrix, nodal_loads
from ..field import owned
from ..kinematics import Kinematics, section_measure
from ..solver_choice import SolverChoice
from .advection import Passage, advection
from .conduction import Conduction, conduction_solver
from .even_paths import EvenPaths


@dataclass(frozen=True)
class ThermalMaterial:
    """Conductivity [W/(m K)] and optional volumetric heat capacity [J/(m³ K)]."""

    conductivity: float
    capacity: float | None = None

    def times(self, factor: float) -> ThermalMaterial:
        """Material with conductivity and heat capacity scaled by a factor."""
        capacity = None if self.capacity is None else factor * self.capacity
        return ThermalMaterial(factor * self.conductivity, capacity)


def conduction(
    bodies: Bodies,
    kinematics: Kinematics,
    space: fem.FunctionSpace,
    materials: dict[str, ThermalMaterial],
    cooling: dict[str, float],
    given: dict[str, float],
    bath: PETSc.Mat,
    passage: Passage | None = None,
    choice: SolverChoice | None = None,
) -> Conduction:
    """Assemble the heat conduction problem and set up its solver. Every rank calls.

    Parameters
    ----------
    bodies : Bodies
    kinematics : Kinematics
    space : dolfinx.fem.FunctionSpace
        Scalar space of the temperature rise.
    materials : dict of str to ThermalMaterial
        Materials by part.
    cooling : dict of str to float
        Heat transfer coefficients by surface [W/(m² K)].
    given : dict of str to float
        Prescribed rise over ambient by surface [K].
    bath : petsc4py.PETSc.Mat
        Heat transfer from the contact faces to a heat bath at ambient temperature, added to the
        factorised matrix only. It keeps the matrix of an otherwise insulated body regular; the
        interface problem subtracts it again.
    passage : Passage, optional
        Motion of a body through the frame.
    choice : SolverChoice, optional
        Direct by default.
    """
    choice = choice or SolverChoice()
    mesh, degree = bodies.mesh, space.ufl_element().degree
    T, δT = ufl.TrialFunction(space), ufl.TestFunction(space)
    conductivities = {part: material.conductivity for part, material in materials.items()}
    capacities = {p: m.capacity for p, m in materials.items() if m.capacity is not None}
    moving, even = None, None
    if passage is not None and passage.spread:
        even = EvenPaths(bodies, space, passage)
    elif passage is not None:
        moving = advection(bodies, kinematics, space, passage, conductivities, capacities)
    measure = section_measure(mesh, degree)
    conductivity = assembled_matrix(conducting(bodies, kinematics, conductivities, degree)(T, δT))
    transfers = [form(T, δT) for form in transferring(bodies, kinematics, cooling)]
    cooled = assembled_matrix(*transfers, pattern=conductivity)
    structure = PETSc.Mat.Structure.SAME_NONZERO_PATTERN
    conductivity.axpy(1.0, cooled, structure)
    test = δT
    if moving is not None:
        test = δT + moving.upwind
        conductivity.axpy(1.0, moving.carried, structure)
    capacity = None
    if len(capacities) == len(materials):
        density = bodies.per_body(capacities) * T * test
        capacity = assembled_matrix(kinematics.integral(mesh, density, measure))

    fixed, values = given_rises(bodies, space, given, even)
    factor = conduction_solver(space, conductivity, bath, fixed, moving is None, even, choice)
    return Conduction(
        space,
        conductivity,
        cooled,
        capacity,
        bath,
        fixed,
        values,
        factor,
        moving,
        even,
        symmetric=moving is None,
        choice=choice,
    )


def conducting(
    bodies: Bodies, kinematics: Kinematics, conductivities: dict[str, float], degree: int
):
    """Bilinear form of conduction, as a function of trial and test functions [W K]."""
    mesh, k = bodies.mesh, bodies.per_body(conductivities)
    measure = section_measure(mesh, degree)
    return lambda T, δT: kinematics.integral(
        mesh, k * ufl.inner(ufl.grad(T), ufl.grad(δT)), measure
    )


def transferring(
    bodies: Bodies, kinematics: Kinematics, coefficients: dict[str, float]
) -> list[Callable]:
    """Bilinear forms ``∫ h T δT dS`` as functions of T and δT, one per distinct value of h.

    Parameters
    ----------
    bodies : Bodies
    kinematics : Kinematics
    coefficients : dict of str to float
        Heat transfer coefficient h by surface [W/(m² K)].
    """
    mesh = bodies.mesh

    def form(h: float) -> Callable:
        ds = bodies.surface_measure(*(s for s, other in coefficients.items() if other == h))
        constant = fem.Constant(mesh, default_scalar_type(h))
        return lambda T, δT: kinematics.integral(mesh, constant * T * δT, ds)

    return [form(h) for h in dict.fromkeys(coefficients.values())]


def surface_heat(
    bodies: Bodies, kinematics: Kinematics, space: fem.FunctionSpace, surface: str, flux: float
) -> np.ndarray:
    """Nodal heat of a uniform flux [W/m²] into the body through a surface [W], owned rows.

    Every rank calls; `space` is that of the temperature.
    """
    measure = bodies.surface_measure(surface)
    q = fem.Constant(bodies.mesh, default_scalar_type(flux))
    return nodal_loads(space, lambda δT: kinematics.integral(bodies.mesh, q * δT, measure))


def given_rises(
    bodies: Bodies, space: fem.FunctionSpace, given: dict[str, float], even: EvenPaths | None
) -> tuple[np.ndarray, np.ndarray]:
    """Mask of fixed owned values, and their rises, linear in the rises given by surface [K]."""
    count = owned(space)
    fixed, values = np.zeros(count, dtype=bool), np.zeros(count)
    for surface, rise in given.items():
        dofs = fem.locate_dofs_topological(
            space, bodies.mesh.topology.dim - 1, bodies.facets(surface)
        )
        mine = dofs[dofs < count]
        fixed[mine], values[mine] = True, rise
    return (fixed, values) if even is None else even.whole(fixed, values)

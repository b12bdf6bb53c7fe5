"""Steady heat conduction in both bodies, with cooled surfaces and given temperatures.

The unknown is the rise over the ambient temperature.
"""

from __future__ import annotations

from dataclasses import dataclass

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp
import ufl
from dolfinx import default_scalar_type, fem
from dolfinx.fem.petsc import assemble_matrix

from ..compat import exterior_facet_domain
from ..parallel import sum_over_ranks
from .bodies import Bodies
from .compiled import compiled
from .factor import Factor
from .field import owned
from .kinematics import Model, section_measure


@dataclass(frozen=True)
class Conduction:
    """The conducting bodies, factorised.

    Attributes
    ----------
    space : dolfinx.fem.FunctionSpace
        Temperature rise over the ambient [K].
    conductivity : petsc4py.PETSc.Mat
        Conduction and cooling, without given temperatures and without `exchange` [W/K].
    cooling : petsc4py.PETSc.Mat
        The cooling part alone: its row sums times the rise give the heat carried off [W/K].
    fixed : ndarray of bool, shape (n_owned,)
        Where the temperature is given.
    factor : Factor
        Of conduction, cooling and exchange, with given temperatures.
    given : ndarray, shape (n_owned,)
        The rise in the fixed values, zero elsewhere [K].
    lifted : ndarray, shape (n_owned,)
        Heat into the free values that holds the given temperatures [W].
    """

    space: fem.FunctionSpace
    conductivity: PETSc.Mat
    cooling: PETSc.Mat
    fixed: np.ndarray
    factor: Factor
    given: np.ndarray
    lifted: np.ndarray

    def respond(self, heat: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Rise [K] due to nodal heat [W] alone, given temperatures at ambient; columns allowed."""
        if sp.issparse(heat):
            return self.factor.solve((sp.diags(~self.fixed, dtype=float) @ heat).tocsr())
        free = np.array(heat, dtype=float)
        free[self.fixed] = 0.0
        return self.factor.solve(free)

    def solve(self, heat: np.ndarray) -> np.ndarray:
        """Rise [K] due to nodal heat [W] and the given temperatures."""
        return self.given + self.respond(heat + self.lifted)

    def outflow(self, rise: np.ndarray, heat: np.ndarray) -> tuple[float, float]:
        """Net heat that leaves by cooling and by given temperatures, and its turnover [W].

        Parameters
        ----------
        rise, heat : ndarray, shape (n_owned,)
            A state and the nodal heat of the contact that goes with it.

        Returns
        -------
        net, turnover : float
            Sum over all ranks, signed and of magnitudes.
        """
        cooled = _multiply(self.cooling, rise)
        held = (heat - _multiply(self.conductivity, rise))[self.fixed]
        net = cooled.sum() + held.sum()
        turnover = np.abs(cooled).sum() + np.abs(held).sum()
        return tuple(sum_over_ranks(self.space.mesh.comm, np.array([net, turnover])))


def conduction(
    bodies: Bodies,
    model: Model,
    space: fem.FunctionSpace,
    conductivities: dict[str, float],
    cooling: dict[str, float],
    given: dict[str, float],
    exchange: PETSc.Mat,
) -> Conduction:
    """Assemble and factorise.

    Parameters
    ----------
    bodies : Bodies
    model : Model
    space : dolfinx.fem.FunctionSpace
        Scalar.
    conductivities : dict of str to float
        By body [W/(m K)].
    cooling : dict of str to float
        Heat transfer coefficients by surface [W/(m² K)].
    given : dict of str to float
        Rise over the ambient by surface [K].
    exchange : petsc4py.PETSc.Mat
        Added to the factorised matrix only: what the contact faces give to a heat bath at ambient
        temperature. It keeps the matrix of an otherwise insulated body regular; the interface takes
        it out again.
    """
    mesh = bodies.mesh
    rise, δrise = ufl.TrialFunction(space), ufl.TestFunction(space)
    k = bodies.per_body(conductivities)
    flow = k * ufl.inner(ufl.grad(rise), ufl.grad(δrise))
    measure = section_measure(mesh, space.ufl_element().degree)
    conductivity = assemble_matrix(compiled(model.integral(mesh, flow, measure)))
    conductivity.assemble()
    cooled = conductivity.duplicate()
    cooled.zeroEntries()
    for surface, h in cooling.items():
        _add_cooling(cooled, bodies, model, space, surface, h)
    cooled.assemble()
    conductivity.axpy(1.0, cooled, PETSc.Mat.Structure.SAME_NONZERO_PATTERN)

    fixed, values = _given(bodies, space, given)
    lifted = -_multiply(conductivity, values)
    matrix = conductivity.copy()
    matrix.axpy(1.0, exchange, PETSc.Mat.Structure.DIFFERENT_NONZERO_PATTERN)
    first = matrix.getOwnershipRange()[0]
    matrix.zeroRowsColumns((np.flatnonzero(fixed) + first).astype(PETSc.IntType), diag=1.0)
    factor = Factor(matrix, dim=mesh.topology.dim)
    return Conduction(space, conductivity, cooled, fixed, factor, values, lifted)


def _add_cooling(matrix: PETSc.Mat, bodies: Bodies, model: Model, space, surface: str, h: float):
    """Add ``∫ h T δT dS`` of one surface; all surfaces share one compiled form."""
    mesh = bodies.mesh
    rise, δrise = ufl.TrialFunction(space), ufl.TestFunction(space)
    facets = exterior_facet_domain(mesh, bodies.facets(surface))
    ds = ufl.Measure("ds", domain=mesh, subdomain_data=[(1, facets)])
    coefficient = fem.Constant(mesh, default_scalar_type(h))
    form = model.integral(mesh, coefficient * rise * δrise, ds(1))
    assemble_matrix(matrix, compiled(form), [])  # type: ignore[arg-type]  # dispatches on matrix


def _given(bodies: Bodies, space, given: dict[str, float]) -> tuple[np.ndarray, np.ndarray]:
    """Which owned values are fixed, and to what."""
    count = owned(space)
    fixed, values = np.zeros(count, dtype=bool), np.zeros(count)
    for surface, rise in given.items():
        dofs = fem.locate_dofs_topological(
            space, bodies.mesh.topology.dim - 1, bodies.facets(surface)
        )
        mine = dofs[dofs < count]
        fixed[mine], values[mine] = True, rise
    return fixed, values


def _multiply(matrix: PETSc.Mat, values: np.ndarray) -> np.ndarray:
    x, y = matrix.createVecs()
    x.setArray(values)
    matrix.mult(x, y)
    return y.getArray().copy()

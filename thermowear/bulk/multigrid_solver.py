"""Conjugate gradients with p-multigrid, for bodies in space too large to be factorised.

Two levels of degree: the elements of the problem and linear ones on the same mesh, for which
smoothed aggregation (GAMG) continues with the rigid-body motions, or constants, as near-nullspace.
Smoothers are Chebyshev polynomials of the point-block Jacobi method, on lower levels of symmetric
Gauss-Seidel sweeps. Iterations hardly grow with the number of unknowns.
"""

from __future__ import annotations

from collections.abc import Callable

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp
from dolfinx import fem
from dolfinx.fem.petsc import interpolation_matrix

from ..errors import ComputationError
from .direct_solver import eliminate
from .field import as_function, lagrange_space, owned

RELATIVE_TOLERANCE = 1e-9
"""Reduction of the residual at which a solution is accepted."""
_MAX_ITERATIONS = 500
_SMOOTHING_STEPS = 3
_OPTIONS = {
    "mg_levels_ksp_type": "chebyshev",
    "mg_levels_ksp_max_it": _SMOOTHING_STEPS,
    "mg_levels_ksp_norm_type": "none",
    "mg_levels_pc_type": "pbjacobi",
    "mg_coarse_ksp_type": "preonly",
    "mg_coarse_pc_type": "gamg",
    "mg_coarse_pc_gamg_threshold": 0.01,
    "mg_coarse_mg_levels_ksp_type": "chebyshev",
    "mg_coarse_mg_levels_pc_type": "sor",
}
"""Options of PETSc; measured as the best of several on bodies of 6e4 to 1e6 unknowns."""


class MultigridSolver:
    """Iterative solver of a symmetric positive definite problem; same interface as `DirectSolver`.

    Parameters
    ----------
    matrix : petsc4py.PETSc.Mat
        Assembled, with the rows and columns of fixed values eliminated.
    space : dolfinx.fem.FunctionSpace
        Its space.
    fixed : ndarray of bool, shape (n_owned,)
        Mask of fixed values.
    coarse : callable, optional
        Assembles the same problem, without its fixed values, in a space of linear elements on the
        same mesh; by default the Galerkin product of the matrix with their interpolation.

    Raises
    ------
    ComputationError
        If the iteration does not converge.
    """

    negative_pivots = 0

    def __init__(
        self,
        matrix: PETSc.Mat,
        space: fem.FunctionSpace,
        fixed: np.ndarray,
        coarse: Callable[[fem.FunctionSpace], PETSc.Mat] | None = None,
    ):
        self.iterations: list[int] = []
        self._matrix = matrix
        linear = lagrange_space(space.mesh, 1, _components(space))
        held = _at_vertices(space, fixed, linear)
        prolongation = _prolongation(linear, space, held, fixed)
        below = matrix.ptap(prolongation) if coarse is None else coarse(linear)
        eliminate(below, held)
        for level in (matrix, below):
            level.setBlockSize(space.dofmap.index_map_bs)
            level.setOption(PETSc.Mat.Option.SPD, True)
        below.setNearNullSpace(_near_nullspace(linear, below))
        self._solver = _conjugate_gradients(matrix)
        multigrid = self._solver.getPC()
        multigrid.setMGInterpolation(1, prolongation)
        multigrid.getMGCoarseSolve().setOperators(below)
        options = PETSc.Options(self._solver.getOptionsPrefix())
        for name, value in _OPTIONS.items():
            options[name] = value
        self.repeat()  # which reads the options of all levels
        for name in _OPTIONS:
            options.delValue(name)

    def repeat(self) -> None:
        """Set up the levels, again after a change of values with unchanged sparsity pattern."""
        self._solver.setOperators(self._matrix)
        self._solver.setUp()

    def solve(self, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Solve for one or several right-hand sides; see `DirectSolver.solve`."""
        columns = loads if isinstance(loads, np.ndarray) else loads.toarray()
        if columns.ndim == 1:
            return self._solved(columns)
        result = np.empty(columns.shape, order="F")
        for k, column in enumerate(columns.T):
            result[:, k] = self._solved(column)
        return result

    solve_transposed = solve

    def _solved(self, load: np.ndarray) -> np.ndarray:
        right, x = self._matrix.createVecs()
        right.setArray(load)
        self._solver.solve(right, x)
        reason, count = self._solver.getConvergedReason(), self._solver.getIterationNumber()
        if reason < 0:
            raise ComputationError(
                f"the multigrid solver has not converged in {count} iterations (PETSc reason "
                f"{reason}): a part of a body is not supported, or cells are nearly flat; "
                "solver = direct may tell which"
            )
        self.iterations.append(count)
        return x.getArray().copy()


def _conjugate_gradients(matrix: PETSc.Mat) -> PETSc.KSP:
    """Conjugate gradients with two levels of multigrid, whose operators are not yet set."""
    solver = PETSc.KSP().create(matrix.comm)
    solver.setOptionsPrefix("multigrid_")
    solver.setType(PETSc.KSP.Type.CG)
    solver.setOperators(matrix)
    solver.setTolerances(rtol=RELATIVE_TOLERANCE, atol=0.0, max_it=_MAX_ITERATIONS)
    solver.setNormType(PETSc.KSP.NormType.NORM_UNPRECONDITIONED)
    multigrid = solver.getPC()
    multigrid.setType(PETSc.PC.Type.MG)
    multigrid.setMGLevels(2)
    return solver


def _components(space: fem.FunctionSpace) -> int:
    """Number of components of a vector-valued space, 0 of a scalar one."""
    return 0 if space.dofmap.index_map_bs == 1 else space.dofmap.index_map_bs


def _at_vertices(
    space: fem.FunctionSpace, fixed: np.ndarray, linear: fem.FunctionSpace
) -> np.ndarray:
    """Mask of the fixed values of linear elements, (n_owned,). Every rank calls."""
    held = fem.Function(linear)
    held.interpolate(as_function(space, fixed.astype(float), "fixed"))
    return held.x.array[: owned(linear)] > 0.5


def _prolongation(
    coarse_space: fem.FunctionSpace,
    space: fem.FunctionSpace,
    coarse_fixed: np.ndarray,
    fixed: np.ndarray,
) -> PETSc.Mat:
    """Interpolation of linear elements in the space, zero from and to fixed values."""
    result = interpolation_matrix(coarse_space, space)
    result.assemble()
    right, left = result.createVecs()
    right.setArray((~coarse_fixed).astype(float))
    left.setArray((~fixed).astype(float))
    result.diagonalScale(left, right)
    return result


def _near_nullspace(space: fem.FunctionSpace, matrix: PETSc.Mat) -> PETSc.NullSpace:
    """Rigid motions of a vector space, constants of a scalar one."""
    if space.dofmap.index_map_bs == 1:
        return PETSc.NullSpace().create(constant=True, comm=matrix.comm)
    places = matrix.createVecRight()
    dim = space.mesh.geometry.dim
    nodes = space.tabulate_dof_coordinates()[: owned(space) // dim, :dim]
    places.setArray(nodes.ravel())
    places.setBlockSize(dim)
    return PETSc.NullSpace().createRigidBody(places)

"""Krylov methods with p-multigrid, for bodies in space too large to be factorised.

Two levels of degree: the elements of the problem and linear ones on the same mesh, for which
smoothed aggregation (GAMG) continues with the rigid-body motions, or constants, as near-nullspace.
The method is that of conjugate gradients, with Chebyshev polynomials as smoothers: of point-block
Jacobi, on lower levels of symmetric Gauss-Seidel sweeps. Where heat is carried along, and the
matrix is not symmetric, it is flexible GMRES, smoothed by GMRES with incomplete factors. Iterations
do not grow with the number of unknowns.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp
from dolfinx import fem
from dolfinx.fem.petsc import interpolation_matrix

from ...errors import ComputationError
from ..spaces import Spaces, block_diagonal, lagrange_space, owned
from .direct import eliminate, return_freed_memory

RELATIVE_TOLERANCE = 1e-9
"""Reduction of the residual at which a solution is accepted."""
_MAX_ITERATIONS = 500
_SMOOTHING_STEPS = 3
_OPTIONS = {
    "mg_levels_ksp_type": "chebyshev",
    "mg_levels_ksp_chebyshev_kind": "fourth",
    "mg_levels_ksp_max_it": 8,
    "mg_levels_ksp_norm_type": "none",
    "mg_levels_esteig_ksp_type": "cg",
    "mg_levels_pc_type": "pbjacobi",
    "mg_coarse_ksp_type": "chebyshev",
    "mg_coarse_ksp_max_it": 5,
    "mg_coarse_ksp_norm_type": "none",
    "mg_coarse_pc_type": "gamg",
    "mg_coarse_pc_gamg_threshold": 0.03,
    "mg_coarse_mg_levels_ksp_type": "chebyshev",
    "mg_coarse_mg_levels_ksp_max_it": 1,
    "mg_coarse_mg_levels_pc_type": "sor",
}
"""Options of PETSc; measured as the best of several on bodies of 1e4 to 9e5 unknowns: blocks, a pad
with back plate, a disk with hat. Chebyshev polynomials of the fourth kind damp what slender cells
leave to the smoother. A cycle of GAMG costs little beside it: five of them, by a polynomial, solve
for the linear elements nearly exactly."""
_UNSYMMETRIC_OPTIONS = {
    "mg_levels_ksp_type": "gmres",
    "mg_levels_ksp_max_it": _SMOOTHING_STEPS,
    "mg_levels_ksp_norm_type": "none",
    "mg_levels_pc_type": "bjacobi",
    "mg_levels_sub_pc_type": "ilu",
    "mg_coarse_ksp_type": "preonly",
    "mg_coarse_pc_type": "gamg",
    "mg_coarse_pc_gamg_agg_nsmooths": 0,
    "mg_coarse_mg_levels_ksp_type": "gmres",
    "mg_coarse_mg_levels_ksp_max_it": _SMOOTHING_STEPS,
    "mg_coarse_mg_levels_pc_type": "bjacobi",
    "mg_coarse_mg_levels_sub_pc_type": "ilu",
}
"""Options for heat carried along: 4 to 30 iterations at Péclet numbers of a cell from 0 to 4e4;
Gauss-Seidel sweeps instead of incomplete factors fail from 400 on (measured, to 1.5e5 unknowns)."""
_RESTART = 100


class MultigridSolver:
    """Iterative solver of a definite problem; same interface as `DirectSolver`.

    Parameters
    ----------
    matrix : petsc4py.PETSc.Mat
        Assembled, with the rows and columns of fixed values eliminated.
    spaces : Spaces
        Its spaces.
    fixed : ndarray of bool, shape (n_owned,)
        Mask of fixed values.
    coarse : callable, optional
        Assembles the same problem, without its fixed values, in spaces of linear elements on the
        same meshes; by default the Galerkin product of the matrix with their interpolation.
    symmetric : bool, optional

    Raises
    ------
    ComputationError
        If the iteration does not converge.
    """

    negative_pivots = 0

    def __init__(
        self,
        matrix: PETSc.Mat,
        spaces: Spaces,
        fixed: np.ndarray,
        coarse: Callable[[Spaces], PETSc.Mat] | None = None,
        symmetric: bool = True,
    ):
        self.iterations: list[int] = []
        self._matrix, self._spaces, self._fixed = matrix, spaces, fixed
        self._coarse, self._symmetric = coarse, symmetric

    @cached_property
    def _solver(self) -> PETSc.KSP:
        """Krylov method with its levels, set up for the first solution. Every rank calls.

        Before it, the memory of the levels may serve a factor for many columns.
        """
        matrix, spaces, symmetric = self._matrix, self._spaces, self._symmetric
        linear = _linear(spaces)
        held = _at_vertices(spaces, self._fixed, linear)
        prolongation = _prolongation(linear, spaces, held, self._fixed)
        below = matrix.ptap(prolongation) if self._coarse is None else self._coarse(linear)
        eliminate(below, held)
        for level in (matrix, below):
            level.setBlockSize(spaces.components)
            level.setOption(PETSc.Mat.Option.SYMMETRIC, symmetric)
        below.setOption(PETSc.Mat.Option.SPD, symmetric)
        below.setNearNullSpace(_near_nullspace(linear, below))
        solver = _krylov_solver(matrix, symmetric)
        multigrid = solver.getPC()
        multigrid.setMGInterpolation(1, prolongation)
        multigrid.getMGCoarseSolve().setOperators(below)
        options = PETSc.Options(solver.getOptionsPrefix())
        chosen = _OPTIONS if symmetric else _UNSYMMETRIC_OPTIONS
        for name, value in chosen.items():
            options[name] = value
        solver.setUp()  # reads the options of all levels
        multigrid.setUpOnBlocks()
        for name in chosen:
            options.delValue(name)
        return solver

    def release(self) -> None:
        """Free the levels, which are set up again when they are needed. Every rank calls."""
        if "_solver" in vars(self):
            self._solver.destroy()
            del self._solver
            return_freed_memory()

    def solve(self, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Solve for one or several right-hand sides; see `DirectSolver.solve`."""
        columns = loads if isinstance(loads, np.ndarray) else loads.toarray()
        if columns.ndim == 1:
            return self._solved(columns)
        result = np.empty(columns.shape, order="F")
        for k, column in enumerate(columns.T):
            result[:, k] = self._solved(column)
        return result

    def solve_transposed(self, loads: np.ndarray) -> np.ndarray:
        """Solve with the transposed matrix; see `DirectSolver.solve_transposed`."""
        return self.solve(loads) if self._symmetric else self._transposed.solve(loads)

    @cached_property
    def _transposed(self) -> MultigridSolver:
        """Solver of the transposed matrix. Every rank calls."""
        transposed = self._matrix.copy().transpose()
        return MultigridSolver(transposed, self._spaces, self._fixed, symmetric=False)

    def _solved(self, load: np.ndarray) -> np.ndarray:
        right, x = self._matrix.createVecs()
        right.setArray(load)
        self._solver.solve(right, x)
        reason, count = self._solver.getConvergedReason(), self._solver.getIterationNumber()
        if reason < 0:
            raise ComputationError(
                f"the multigrid solver has not converged in {count} iterations (PETSc reason "
                f"{reason}): a part of a body is not supported, or cells are nearly flat; "
                "mesh.solver = direct may tell which"
            )
        self.iterations.append(count)
        return x.getArray().copy()


def _krylov_solver(matrix: PETSc.Mat, symmetric: bool) -> PETSc.KSP:
    """Krylov method with two levels of multigrid, whose operators are not yet set."""
    solver = PETSc.KSP().create(matrix.comm)
    solver.setOptionsPrefix("multigrid_")
    solver.setType(PETSc.KSP.Type.CG if symmetric else PETSc.KSP.Type.FGMRES)
    if not symmetric:
        solver.setGMRESRestart(_RESTART)
    solver.setOperators(matrix)
    solver.setTolerances(rtol=RELATIVE_TOLERANCE, atol=0.0, max_it=_MAX_ITERATIONS)
    solver.setNormType(PETSc.KSP.NormType.NORM_UNPRECONDITIONED)
    multigrid = solver.getPC()
    multigrid.setType(PETSc.PC.Type.MG)
    multigrid.setMGLevels(2)
    return solver


def _linear(spaces: Spaces) -> Spaces:
    """Spaces of linear elements on the same meshes."""
    width = 0 if spaces.components == 1 else spaces.components
    return Spaces(tuple(lagrange_space(space.mesh, 1, width) for space in spaces.each))


def _at_vertices(spaces: Spaces, fixed: np.ndarray, linear: Spaces) -> np.ndarray:
    """Mask of the fixed values of linear elements, (n_owned,). Every rank calls."""
    held = []
    for space, function in zip(
        linear.each, spaces.functions(fixed.astype(float), "fixed"), strict=True
    ):
        at_vertices = fem.Function(space)
        at_vertices.interpolate(function)
        held.append(at_vertices.x.array[: owned(space)] > 0.5)
    return np.concatenate(held)


def _prolongation(
    linear: Spaces, spaces: Spaces, coarse_fixed: np.ndarray, fixed: np.ndarray
) -> PETSc.Mat:
    """Interpolation of linear elements in the spaces, zero from and to fixed values."""
    blocks = []
    for coarse, space in zip(linear.each, spaces.each, strict=True):
        blocks.append(interpolation_matrix(coarse, space))
        blocks[-1].assemble()
    result = block_diagonal(blocks)
    right, left = result.createVecs()
    right.setArray((~coarse_fixed).astype(float))
    left.setArray((~fixed).astype(float))
    result.diagonalScale(left, right)
    return result


def _near_nullspace(spaces: Spaces, matrix: PETSc.Mat) -> PETSc.NullSpace:
    """Rigid motions of vector spaces, constants of scalar ones."""
    if spaces.components == 1:
        return PETSc.NullSpace().create(constant=True, comm=matrix.comm)
    places = matrix.createVecRight()
    nodes = spaces.nodes()
    places.setArray(nodes.ravel())
    places.setBlockSize(nodes.shape[1])
    return PETSc.NullSpace().createRigidBody(places)

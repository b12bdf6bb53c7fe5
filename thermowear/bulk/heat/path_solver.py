"""Krylov method for heat that a rotating body in space carries round closed paths.

At high Péclet numbers temperatures that are uniform along paths are in the kernel of advection, and
only slow conduction across the paths determines them: smoothers, and coarse grids that mix paths,
fail. Their part of the solution is found by a factor of the equations summed along paths
(deflation: Nicolaides, SIAM J. Numer. Anal. 24 (1987) 355); that of the rest by incomplete factors
whose unknowns are numbered downstream (Bey and Wittum, Appl. Numer. Math. 23 (1997) 177).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

from petsc4py import PETSc

import numpy as np

from ...errors import CaseError
from ..bodies import Bodies
from ..direct_solver import DirectSolver
from ..field import owned
from ..multigrid_solver import RELATIVE_TOLERANCE, MultigridSolver
from ..spaces import Spaces
from .even_paths import EvenPaths
from .passage import Passage

_FILL = 1
"""Levels of fill of the incomplete factors; 2 halves the iterations, but costs more in all."""
_MAX_ITERATIONS = 500
_RESTART = 100


@dataclass(frozen=True)
class ClosedPaths:
    """Circles of the nodes of a rotating body whose cells lie in rows.

    Attributes
    ----------
    order : ndarray of int, shape (n_owned,)
        Owned values in downstream order from a half-plane through the axis; those of the other
        body at the end.
    even : EvenPaths
        Circles of the values.
    """

    order: np.ndarray
    even: EvenPaths

    @property
    def upstream(self) -> ClosedPaths:
        """Paths in the opposite sense."""
        return replace(self, order=self.order[::-1])


def closed_paths(bodies: Bodies, spaces: Spaces, passage: Passage | None) -> ClosedPaths | None:
    """Closed paths of a body rotating in space; None without rows of cells. Every rank calls."""
    if passage is None or passage.spread or passage.center is None:
        return None
    if bodies.dim < 3:
        return None
    try:
        even = EvenPaths(bodies, spaces, passage)
    except CaseError:
        return None
    nodes = [space.tabulate_dof_coordinates()[: owned(space)] for space in spaces.each]
    x, y, _ = np.vstack(nodes).T
    angle = np.sign(passage.speed) * np.arctan2(y - passage.center[1], x - passage.center[0])
    angle = np.where(even.numbers >= 0, np.round(angle, 9), np.inf)
    return ClosedPaths(np.argsort(angle, kind="stable"), even)


class PathSolver(MultigridSolver):
    """Iterative solver with the interface of `MultigridSolver`; its matrix is not symmetric.

    Parameters
    ----------
    matrix : petsc4py.PETSc.Mat
        Assembled, with the rows and columns of fixed values eliminated.
    spaces : Spaces
    fixed : ndarray of bool, shape (n_owned,)
    paths : ClosedPaths
    """

    def __init__(
        self,
        matrix: PETSc.Mat,
        spaces: Spaces,
        fixed: np.ndarray,
        paths: ClosedPaths,
    ):
        self.iterations: list[int] = []
        self._matrix, self._spaces, self._fixed, self._paths = matrix, spaces, fixed, paths
        self._symmetric = False

    @cached_property
    def _solver(self) -> PETSc.KSP:
        """Krylov method with its preconditioner. Every rank calls."""
        solver = PETSc.KSP().create(self._matrix.comm)
        solver.setType(PETSc.KSP.Type.FGMRES)
        solver.setGMRESRestart(_RESTART)
        solver.setTolerances(rtol=RELATIVE_TOLERANCE, atol=0.0, max_it=_MAX_ITERATIONS)
        solver.setNormType(PETSc.KSP.NormType.NORM_UNPRECONDITIONED)
        solver.setOperators(self._matrix)
        solver.getPC().setType(PETSc.PC.Type.PYTHON)
        preconditioner = _PathPreconditioner(self._matrix, self._fixed, self._paths)
        solver.getPC().setPythonContext(preconditioner)
        solver.setUp()
        return solver

    @cached_property
    def _transposed(self) -> PathSolver:
        """Solver of the transposed matrix. Every rank calls."""
        transposed = self._matrix.copy().transpose()
        return PathSolver(transposed, self._spaces, self._fixed, self._paths.upstream)


class _PathPreconditioner:
    """Correction of the mean along paths, incomplete factors, and the correction again."""

    def __init__(self, matrix: PETSc.Mat, fixed: np.ndarray, paths: ClosedPaths):
        self._matrix, self._order = matrix, paths.order
        self._paths = paths.even.along_paths(matrix)
        free = matrix.createVecLeft()
        free.setArray((~fixed).astype(float))
        self._paths.diagonalScale(free, None)
        coarse = matrix.ptap(self._paths)
        diagonal = coarse.getDiagonal()
        diagonal.setArray(np.where(diagonal.getArray() == 0.0, 1.0, diagonal.getArray()))
        coarse.setDiagonal(diagonal)  # paths of fixed values
        self._coarse = DirectSolver(coarse, "none", dim=3)
        rows = PETSc.IS().createGeneral(self._order.astype(PETSc.IntType), PETSc.COMM_SELF)
        own = matrix.getDiagonalBlock().permute(rows, rows)
        self._factors = PETSc.PC().create(PETSc.COMM_SELF)
        self._factors.setOperators(own)
        self._factors.setType(PETSc.PC.Type.ILU)
        self._factors.setFactorLevels(_FILL)
        self._factors.setFactorOrdering(PETSc.Mat.OrderingType.NATURAL)
        self._factors.setUp()
        self._ordered = own.createVecs()

    def apply(self, pc: PETSc.PC, residual: PETSc.Vec, result: PETSc.Vec) -> None:
        """Approximate solution for a residual."""
        result.set(0.0)
        for correct in (self._mean, self._rest, self._mean):
            result.axpy(1.0, correct(residual - self._matrix * result))

    def _mean(self, residual: PETSc.Vec) -> PETSc.Vec:
        right, result = self._paths.createVecRight(), residual.duplicate()
        self._paths.multTranspose(residual, right)
        right.setArray(self._coarse.solve(right.getArray().copy()))
        self._paths.mult(right, result)
        return result

    def _rest(self, residual: PETSc.Vec) -> PETSc.Vec:
        right, x = self._ordered
        right.setArray(residual.getArray(readonly=1)[self._order])
        self._factors.apply(right, x)
        result = residual.duplicate()
        values = np.empty(len(self._order))
        values[self._order] = x.getArray(readonly=1)
        result.setArray(values)
        return result

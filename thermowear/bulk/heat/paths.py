"""Heat along the closed paths of material points: uniform along them, or carried round.

One unknown stands for all values on a path. This is exact, whereas a large conductivity along the
path would be an approximation and would cost digits of the heat balance.

At high Péclet numbers temperatures that are uniform along paths are in the kernel of advection, and
only slow conduction across the paths determines them: smoothers, and coarse grids that mix paths,
fail. Their part of the solution is found by a factor of the equations summed along paths
(deflation: Nicolaides, SIAM J. Numer. Anal. 24 (1987) 355); that of the rest by incomplete factors
whose unknowns are numbered downstream (Bey and Wittum, Appl. Numer. Math. 23 (1997) 177).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp
from dolfinx import fem

from ...errors import CaseError
from ...parallel import sum_over_ranks
from ..bodies import Bodies
from ..joints import Joints
from ..solvers.direct import DirectSolver
from ..solvers.groups import AnyFactor, JoinedSolver, factorised
from ..solvers.multigrid import RELATIVE_TOLERANCE, MultigridSolver
from ..spaces import Spaces, owned
from .advection import Passage

_PATH_TOLERANCE = 1e-9
"""Tolerance for identifying paths, relative to the range of their coordinates."""

_LEAST_NODES = 1.9
"""Least mean number of nodes on a path: a mesh without rows of cells has about one."""


class EvenPaths:
    """Map between nodal temperatures and one unknown per path. Every rank calls.

    The unknowns of a rank are its values outside the moving body; rank 0 also has those of all
    paths.

    Parameters
    ----------
    bodies : Bodies
    spaces : Spaces
        Temperature spaces; the mesh of the body has rows of cells along the paths.
    passage : Passage
    """

    def __init__(self, bodies: Bodies, spaces: Spaces, passage: Passage):
        self._comm, self._dim, self._bodies = bodies.comm, bodies.dim, len(bodies.each)
        passing = spaces.nodes_of(bodies, *passage.parts)
        self._passing, self._others = np.flatnonzero(passing), np.flatnonzero(~passing)
        places = np.vstack([_places(space, passage) for space in spaces.each])[self._passing]
        self._path, self._paths = _path_numbers(self._comm, places)
        if sum_over_ranks(self._comm, len(places)) < _LEAST_NODES * self._paths:
            raise CaseError(
                f"heat.advection: 'spread' needs rows of cells along the motion of "
                f"{passage.parts[0]!r}, whose mesh has none; use 'resolved'"
            )

    @property
    def count(self) -> int:
        """Number of owned values."""
        return len(self._passing) + len(self._others)

    @property
    def numbers(self) -> np.ndarray:
        """Path of each owned value, -1 outside the moving body, shape (n_owned,)."""
        found = np.full(self.count, -1)
        found[self._passing] = self._path
        return found

    def along_paths(self, matrix: PETSc.Mat) -> PETSc.Mat:
        """Nodal values in the layout of a matrix that are one on a path, a column for each."""
        join = self._prolongation(matrix)
        rows, size = join.getSizes()[0], self._paths if self._comm.rank == 0 else 0
        last = join.getSizes()[1][0] if self._comm.rank == 0 else 0
        chosen = PETSc.IS().createStride(size, last - size, 1, comm=matrix.comm)
        first = matrix.getOwnershipRange()[0]
        every = PETSc.IS().createStride(rows[0], first, 1, comm=matrix.comm)
        return join.createSubMatrix(every, chosen)

    def whole(self, fixed: np.ndarray, given: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Extend prescribed temperatures (n_owned,) to whole paths (mean on each path)."""
        met = self._summed(fixed[:, None].astype(float))[:, 0]
        mean = self._summed((fixed * given)[:, None])[:, 0] / np.maximum(met, 1)
        fixed, given = fixed.copy(), given.copy()
        fixed[self._passing] = met[self._path] > 0
        given[self._passing] = mean[self._path]
        return fixed, given

    def factor(
        self, matrix: PETSc.Mat, fixed: np.ndarray, symmetry: str, joints: Joints
    ) -> EvenFactor:
        """Factorise a matrix of all values with `fixed` values eliminated.

        Symmetry as in `DirectSolver`, joints in the layout of the values.
        """
        join = self._prolongation(matrix)
        small = matrix.ptap(join)
        first = small.getOwnershipRange()[0]
        held = self.joined(fixed[:, None].astype(float))[:, 0] > 0
        rows = (np.flatnonzero(held) + first).astype(PETSc.IntType)
        small.zeroRowsColumns(rows, diag=1.0)
        border = joints.border(range(self._bodies), slice(None))
        if border.count:  # where paths cross a joint, it is closed already
            jump, own = (self._joined_trace(trace) for trace in (border.jump, border.own))
            border = replace(border, jump=jump, own=own, closed=True)
        return EvenFactor(self, factorised(small, border, held, symmetry, self._dim))

    def _joined_trace(self, trace: sp.csr_matrix) -> sp.csr_matrix:
        """Transposed trace on the unknowns, without rounding where its parts cancel."""
        result = sp.csr_matrix(self.joined(trace))
        result.data[np.abs(result.data) < _PATH_TOLERANCE * np.abs(trace).max()] = 0.0
        return result

    def joined(self, loads: np.ndarray | sp.csr_matrix):
        """Loads on the unknowns from loads on the nodal values, by columns."""
        if sp.issparse(loads) and self._comm.size > 1:
            loads = sp.csr_matrix(loads).toarray()
        own, paths = loads[self._others], self._summed(loads)
        if self._comm.rank:
            return own
        return (sp.vstack if sp.issparse(loads) else np.vstack)([own, paths])

    def spread(self, unknowns: np.ndarray) -> np.ndarray:
        """Nodal values from the unknowns, by columns."""
        count = len(self._others)
        paths = self._comm.bcast(unknowns[count:], root=0)
        values = np.empty((count + len(self._passing), unknowns.shape[1]), order="F")
        values[self._others] = unknowns[:count]
        values[self._passing] = paths[self._path]
        return values

    def _summed(self, loads):
        """Loads summed over each path, by columns; identical on every rank."""
        n = len(self._path)
        sums = sp.csr_matrix((np.ones(n), (self._path, np.arange(n))), (self._paths, n))
        paths = sums @ loads[self._passing]
        return sum_over_ranks(self._comm, paths)

    def _prolongation(self, matrix: PETSc.Mat) -> PETSc.Mat:
        """Prolongation matrix from unknowns to nodal values, a single one in each row."""
        others, rows = len(self._others), matrix.getLocalSize()[0]
        size = others + (self._paths if self._comm.rank == 0 else 0)
        starts = np.cumsum([0, *self._comm.allgather(size)])
        column = np.empty(rows, dtype=PETSc.IntType)
        column[self._others] = starts[self._comm.rank] + np.arange(others)
        column[self._passing] = starts[1] - self._paths + self._path
        sizes = ((rows, matrix.getSize()[0]), (size, starts[-1]))
        csr = (np.arange(rows + 1, dtype=PETSc.IntType), column, np.ones(rows))
        join = PETSc.Mat().createAIJ(sizes, csr=csr, comm=matrix.comm)
        join.assemble()
        return join


class EvenFactor:
    """Factorised matrix of the unknowns, for nodal values that are uniform along paths.

    Same interface as `JoinedSolver`.
    """

    def __init__(self, paths: EvenPaths, factor: AnyFactor):
        self._paths, self._factor = paths, factor

    def solve(self, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Nodal values due to nodal loads, see `DirectSolver.solve`."""
        return self._spread(self._factor.solve, loads)

    def solve_transposed(self, loads: np.ndarray) -> np.ndarray:
        """Solve with the transposed matrix, see `DirectSolver.solve_transposed`."""
        return self._spread(self._factor.solve_transposed, loads)

    def _spread(self, solve: Callable, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        columns = loads if loads.ndim == 2 else loads[:, None]
        unknowns = solve(self._paths.joined(columns))
        return self._paths.spread(unknowns).reshape(loads.shape, order="F")

    def closing(self, jumps: np.ndarray) -> np.ndarray:
        """Nodal values of given weak jumps, see `JoinedSolver.closing`."""
        assert isinstance(self._factor, JoinedSolver)
        return self._paths.spread(self._factor.closing(jumps)[:, None])[:, 0]

    def multipliers(self, residual: np.ndarray, jumps: np.ndarray) -> np.ndarray:
        """Multipliers of all joints, see `JoinedSolver.multipliers`."""
        assert isinstance(self._factor, JoinedSolver)
        return self._factor.multipliers(self._paths.joined(residual[:, None])[:, 0], jumps)


def _places(space: fem.FunctionSpace, passage: Passage) -> np.ndarray:
    """Stream function and height at the owned nodes of a body, shape (n_owned, 2)."""
    ψ = fem.Function(space)
    ψ.interpolate(passage.stream(space.mesh))
    places = np.column_stack([ψ.x.array, space.tabulate_dof_coordinates()[:, 2]])
    return places[: owned(space)]


def _path_numbers(comm, places: np.ndarray) -> tuple[np.ndarray, int]:
    """Path number of points by stream function and height (n, 2), and the number of paths."""
    everywhere = np.vstack(comm.allgather(places))
    steps = [_ordinals(values) for values in everywhere.T]
    _, number = np.unique(np.column_stack(steps), axis=0, return_inverse=True)
    first = sum(comm.allgather(len(places))[: comm.rank])
    return number.ravel()[first : first + len(places)], int(number.max()) + 1


def _ordinals(values: np.ndarray) -> np.ndarray:
    """Number of each value in ascending order; values equal up to rounding have the same."""
    order = np.argsort(values)
    higher = np.diff(values[order]) > _PATH_TOLERANCE * np.ptp(values)
    step = np.empty(len(values), dtype=np.int64)
    step[order] = np.concatenate([[0], np.cumsum(higher)])
    return step


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

"""Bodies so fast that their temperature is the same all along each path that their points take.

One unknown stands for all the values on a path: exact, where a large conductivity along the path
would only come near it and would cost digits of the heat balance.
"""

from __future__ import annotations

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp
from dolfinx import fem

from ...parallel import sum_over_ranks
from ..bodies import Bodies
from ..direct_solver import Factor
from ..field import owned
from .advection import Passage

_APART = 1e-9
"""Paths nearer to each other are the same; relative to how far they extend."""


class EvenPaths:
    """Which values of a temperature are one and the same. Every rank calls.

    The unknowns of a rank are its values of bodies that do not pass; rank 0 has those of all the
    paths besides.

    Parameters
    ----------
    bodies : Bodies
    space : dolfinx.fem.FunctionSpace
        Of the temperature; the mesh has rows of cells along the paths.
    passage : Passage
    """

    def __init__(self, bodies: Bodies, space: fem.FunctionSpace, passage: Passage):
        self._comm, self._dim, count = bodies.mesh.comm, bodies.mesh.topology.dim, owned(space)
        dofs = np.unique(space.dofmap.list[passage.cells(bodies)])
        self._passing = dofs[dofs < count]
        self._others = np.setdiff1d(np.arange(count), self._passing)
        ψ = fem.Function(space)
        ψ.interpolate(passage.stream(bodies.mesh))
        height = space.tabulate_dof_coordinates()[self._passing, 2]
        places = np.column_stack([ψ.x.array[self._passing], height])
        self._path, self._paths = _numbered(self._comm, places)

    def whole(self, fixed: np.ndarray, given: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Given temperatures, shape (n_owned,), all along the paths that meet them."""
        met = self._summed(fixed[:, None].astype(float))[:, 0]
        mean = self._summed((fixed * given)[:, None])[:, 0] / np.maximum(met, 1)
        fixed, given = fixed.copy(), given.copy()
        fixed[self._passing] = met[self._path] > 0
        given[self._passing] = mean[self._path]
        return fixed, given

    def factor(self, matrix: PETSc.Mat, fixed: np.ndarray, symmetry: str) -> EvenFactor:
        """Factorise a matrix of all values, those that are `fixed` eliminated; see `Factor`."""
        join = self._joining(matrix)
        small = matrix.ptap(join)
        first = small.getOwnershipRange()[0]
        held = np.flatnonzero(self.joined(fixed[:, None].astype(float))[:, 0] > 0)
        small.zeroRowsColumns((held + first).astype(PETSc.IntType), diag=1.0)
        return EvenFactor(self, Factor(small, symmetry, dim=self._dim))

    def joined(self, loads: np.ndarray | sp.csr_matrix):
        """Loads on the unknowns from those on the values, by columns."""
        if sp.issparse(loads) and self._comm.size > 1:
            loads = sp.csr_matrix(loads).toarray()
        own, paths = loads[self._others], self._summed(loads)
        if self._comm.rank:
            return own
        return (sp.vstack if sp.issparse(loads) else np.vstack)([own, paths])

    def spread(self, unknowns: np.ndarray) -> np.ndarray:
        """The values from the unknowns, by columns."""
        count = len(self._others)
        paths = self._comm.bcast(unknowns[count:], root=0)
        values = np.empty((count + len(self._passing), unknowns.shape[1]), order="F")
        values[self._others] = unknowns[:count]
        values[self._passing] = paths[self._path]
        return values

    def _summed(self, loads):
        """Loads of whole paths, by columns; the same on every rank."""
        n = len(self._path)
        sums = sp.csr_matrix((np.ones(n), (self._path, np.arange(n))), (self._paths, n))
        paths = sums @ loads[self._passing]
        return sum_over_ranks(self._comm, paths)

    def _joining(self, matrix: PETSc.Mat) -> PETSc.Mat:
        """Values by unknowns, a one in each row."""
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
    """A factorised matrix, solved for values that are even along paths; as `Factor`."""

    def __init__(self, paths: EvenPaths, factor: Factor):
        self._paths = paths
        self._factor = factor

    def solve(self, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Solve for one or several right-hand sides, see `Factor.solve`."""
        return self._solved(self._factor.solve, loads)

    def solve_transposed(self, loads: np.ndarray) -> np.ndarray:
        """Solve with the transposed matrix, see `Factor.solve_transposed`."""
        return self._solved(self._factor.solve_transposed, loads)

    def _solved(self, solve, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        columns = loads if loads.ndim == 2 else loads[:, None]
        unknowns = solve(self._paths.joined(columns))
        return self._paths.spread(unknowns).reshape(loads.shape, order="F")


def _numbered(comm, places: np.ndarray) -> tuple[np.ndarray, int]:
    """Number of the path of each place, and how many there are.

    Parameters
    ----------
    comm : mpi4py.MPI.Comm
    places : ndarray, shape (n, 2)
        Stream function and height.
    """
    everywhere = np.vstack(comm.allgather(places))
    steps = [_steps(values) for values in everywhere.T]
    _, number = np.unique(np.column_stack(steps), axis=0, return_inverse=True)
    first = sum(comm.allgather(len(places))[: comm.rank])
    return number.ravel()[first : first + len(places)], int(number.max()) + 1


def _steps(values: np.ndarray) -> np.ndarray:
    """Number of each value from the lowest; those that differ by rounding have the same."""
    order = np.argsort(values)
    higher = np.diff(values[order]) > _APART * np.ptp(values)
    step = np.empty(len(values), dtype=np.int64)
    step[order] = np.concatenate([[0], np.cumsum(higher)])
    return step

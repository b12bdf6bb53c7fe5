"""A factorised sparse matrix that solves for many right-hand sides."""

from __future__ import annotations

from petsc4py import PETSc

import numpy as np


class Factor:
    """Cholesky factor (MUMPS) of a symmetric positive definite PETSc matrix.

    Parameters
    ----------
    matrix : petsc4py.PETSc.Mat
        Assembled and distributed by rows.
    """

    def __init__(self, matrix: PETSc.Mat):
        matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
        matrix.setOption(PETSc.Mat.Option.SPD, True)
        self._comm = matrix.comm
        self._rows = matrix.getSizes()[0]
        self._solver = PETSc.KSP().create(self._comm)
        self._solver.setOperators(matrix)
        self._solver.setType(PETSc.KSP.Type.PREONLY)
        preconditioner = self._solver.getPC()
        preconditioner.setType(PETSc.PC.Type.CHOLESKY)
        preconditioner.setFactorSolverType(PETSc.Mat.SolverType.MUMPS)
        preconditioner.setUp()
        self._factored = preconditioner.getFactorMatrix()

    def solve(self, loads: np.ndarray) -> np.ndarray:
        """Solve for one or several right-hand sides.

        Parameters
        ----------
        loads : ndarray, shape (n_owned,) or (n_owned, m)
            The rows this rank owns. Every rank calls.

        Returns
        -------
        ndarray
            The solutions, same shape.
        """
        columns = np.asfortranarray(loads.reshape(len(loads), -1))
        sizes = (self._rows, columns.shape[1])
        b = PETSc.Mat().createDense(sizes, array=columns, comm=self._comm)
        x = PETSc.Mat().createDense(sizes, comm=self._comm)
        x.setUp()
        for matrix in (b, x):
            matrix.assemble()
        self._factored.matSolve(b, x)
        result = np.array(x.getDenseArray(), order="F").reshape(loads.shape)
        for matrix in (b, x):
            matrix.destroy()
        return result

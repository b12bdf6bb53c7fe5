"""Equations of an elastic body, or of several glued to each other, and their solver."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from ...parallel import sum_over_ranks
from ..direct_solver import DirectSolver, eliminate, multiply
from ..field import without_fixed
from ..group_solvers import factorised
from ..joints.joined_solver import JoinedSolver
from ..joints.joint import Border
from ..multigrid_solver import MultigridSolver
from ..solver_choice import AnySolver, SolverChoice, linear_solver
from ..spaces import Spaces, block_diagonal
from .elastic_body import ElasticBody


@dataclass(frozen=True)
class ElasticGroup:
    """Elasticity problem of a group of bodies, with the solver of its equations.

    Attributes
    ----------
    spaces : Spaces
        Displacement spaces of its bodies [m].
    fixed : ndarray of bool, shape (n_owned,)
        Mask of values held at zero.
    support_rows : petsc4py.PETSc.Mat
        Rows of the stiffness of the nodes of these values, for the support reactions.
    matrix : petsc4py.PETSc.Mat
        Stiffness with the rows and columns of these values eliminated.
    border : Border
        Conditions of the joints.
    factor : DirectSolver, JoinedSolver or MultigridSolver
        Solver of the matrix.
    choice : SolverChoice
    """

    spaces: Spaces
    fixed: np.ndarray
    support_rows: PETSc.Mat
    matrix: PETSc.Mat
    border: Border
    factor: AnySolver
    choice: SolverChoice

    def solve(self, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Displacements [m] due to nodal loads [N]; owned rows, one or several columns."""
        return self.factor.solve(without_fixed(loads, self.fixed))

    def release(self) -> None:
        """Free the levels of multigrid, until they are needed again. Every rank calls."""
        if isinstance(self.factor, MultigridSolver):
            self.factor.release()

    @contextmanager
    def solver_of_columns(self) -> Iterator[Callable]:
        """Function like `solve` for many columns of loads.

        Where single loads are solved for by multigrid it is a factor that exists meanwhile, if one
        of this body fits into the memory: a column then costs a hundredth. Every rank calls.
        """
        if not self.choice.factorises_columns:
            yield self.solve
            return
        matrix = self.matrix.convert(PETSc.Mat.Type.SBAIJ, PETSc.Mat())
        factor = DirectSolver(matrix, dim=self.spaces.dim)
        try:
            yield lambda loads: factor.solve(without_fixed(loads, self.fixed))
        finally:
            factor.destroy()
            matrix.destroy()

    def reactions(self, displacement: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Support reactions [N], owned rows; zero in the free values."""
        result, held = np.zeros(len(self.fixed)), _of_nodes(self.fixed, self.spaces)
        result[held] = multiply(self.support_rows, displacement) - loads[held]
        if self.border.count:
            result += self.border.jump @ self.multipliers(displacement, loads)
        return np.where(self.fixed, result, 0.0)

    def multipliers(self, displacement: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Multipliers of the joints (m,) of a solution under nodal loads. Every rank calls."""
        if not isinstance(self.factor, JoinedSolver):
            return np.zeros(0)
        residual = loads - multiply(self.matrix, displacement)
        jumps = sum_over_ranks(self.spaces.comm, self.border.jump.T @ displacement)
        return self.factor.multipliers(residual, jumps)


def elastic_group(
    bodies: Sequence[ElasticBody], border: Border, choice: SolverChoice
) -> ElasticGroup:
    """Assemble the stiffness of a body, or of glued ones, and set up its solver; collective."""
    spaces = Spaces(tuple(body.space for body in bodies))
    fixed = np.concatenate([body.fixed for body in bodies])
    blocks = [body.stiffness(body.space, blocked=choice.iterative) for body in bodies]
    matrix = block_diagonal(blocks)
    support_rows = _rows(matrix, _of_nodes(fixed, spaces))
    eliminate(matrix, fixed)
    if border.count:
        choice.require_direct()
        factor: AnySolver = factorised(matrix, border, fixed, "symmetric", spaces.dim)
    else:
        forms, degree = bodies[0], spaces.degree

        def coarse(linear: Spaces) -> PETSc.Mat:
            return forms.coarse_stiffness(linear.each[0], degree)

        factor = linear_solver(choice, matrix, spaces, fixed, coarse=coarse)
    return ElasticGroup(spaces, fixed, support_rows, matrix, border, factor, choice)


def _of_nodes(values: np.ndarray, spaces: Spaces) -> np.ndarray:
    """Mask of all values of the nodes of some owned ones, both (n_owned,)."""
    return np.repeat(values.reshape(-1, spaces.components).any(axis=1), spaces.components)


def _rows(matrix: PETSc.Mat, chosen: np.ndarray) -> PETSc.Mat:
    """Rows of a matrix chosen by a mask of owned values. Every rank calls."""
    (first, _), (start, end) = matrix.getOwnershipRange(), matrix.getOwnershipRangeColumn()
    rows = (np.flatnonzero(chosen) + first).astype(PETSc.IntType)
    return matrix.createSubMatrix(
        PETSc.IS().createGeneral(rows, matrix.comm),
        PETSc.IS().createStride(end - start, start, 1, comm=matrix.comm),
    )

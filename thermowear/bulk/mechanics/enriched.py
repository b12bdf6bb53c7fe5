"""Hierarchical error estimate: correction of a linear problem by the surplus of the next degree.

The existing factorisation solves the problem on its own space; the surplus is nearly orthogonal to
that space in energy, and its matrix is well conditioned. One step of conjugate gradients,
preconditioned by block Gauss-Seidel (surplus, space, surplus), yields at least four fifths of the
change that a solution of the next degree would bring: an estimate of the error (Bank and Smith,
SIAM J. Numer. Anal. 30 (1993) 921: hierarchical bases).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from petsc4py import PETSc

import numpy as np
import ufl
from dolfinx import fem

from ...parallel import sum_over_ranks
from ..compiled import assembled, assembled_matrix, compiled
from ..direct_solver import DirectSolver, multiply
from ..spaces import Spaces, block_diagonal
from .elasticity import supported

_TOLERANCE = 1e-2  # of iterative solutions on the surplus in 3D; a factorisation costs too much


class EnrichedProblem:
    """Symmetric positive definite problem on a space and its surplus.

    A field is an array of the owned values of the space, followed by those of the surplus.

    Parameters
    ----------
    spaces, surplus : Spaces
        See `surplus.surplus_spaces`.
    forms, regular : sequence of sequence of callable
        For each body, terms of the bilinear form as functions of trial and test functions. Terms in
        `regular` enter corrections only; they regularise bodies without supports.
    solve : callable
        Solver for corrections on the space alone, for loads (n_owned,).
    fixed : tuple of ndarray of bool
        Masks of prescribed values of the space and of the surplus, which remain unchanged.
    """

    def __init__(
        self,
        spaces: Spaces,
        surplus: Spaces,
        forms: Sequence[Sequence[Callable]],
        solve: Callable[[np.ndarray], np.ndarray],
        fixed: tuple[np.ndarray, np.ndarray],
        regular: Sequence[Sequence[Callable]] | None = None,
    ):
        self.spaces, self.surplus = spaces, surplus
        self._comm = spaces.comm
        self._solve = solve
        self._free = ~np.concatenate(fixed)
        self._values = [
            (fem.Function(space), fem.Function(more))
            for space, more in zip(spaces.each, surplus.each, strict=True)
        ]
        regular = [() for _ in forms] if regular is None else regular
        self._actions, self._regular = (
            [self._compiled(terms, part) for part in (spaces, surplus)]
            for terms in (forms, regular)
        )
        blocks = []
        for space, *terms in zip(surplus.each, forms, regular, strict=True):
            trial, test = ufl.TrialFunction(space), ufl.TestFunction(space)
            every = [term(trial, test) for some in terms for term in some]
            blocks.append(assembled_matrix(*every))
        self._block = _SurplusBlock(block_diagonal(blocks), fixed[1], spaces.dim)

    def _compiled(self, forms: Sequence[Sequence[Callable]], part: Spaces) -> list[list[fem.Form]]:
        """Compiled actions of terms on the field, tested by the space or its surplus."""
        result = []
        for terms, space, values in zip(forms, part.each, self._values, strict=True):
            field, test = values[0] + values[1], ufl.TestFunction(space)
            result.append([compiled(term(field, test)) for term in terms])
        return result

    def field(self, values: np.ndarray) -> np.ndarray:
        """Field with given values of the space (n_owned,) and zero surplus."""
        return np.concatenate([values, np.zeros(self.surplus.owned)])

    def functions(self, field: np.ndarray) -> list:
        """Field as a UFL expression for each body, valid until the next call."""
        count = self.spaces.owned
        parts = self.spaces.split(field[:count]), self.surplus.split(field[count:])
        for functions, *given in zip(self._values, *parts, strict=True):
            for function, values in zip(functions, given, strict=True):
                function.x.array[: len(values)] = values
                function.x.scatter_forward()
        return [values[0] + values[1] for values in self._values]

    def loads(self, forms: Sequence[Callable]) -> np.ndarray:
        """Load vector of linear forms, one for each body, as functions of the test function."""
        return np.concatenate([self.spaces.loads(forms), self.surplus.loads(forms)])

    def residual(self, field: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Residual of a field under loads, zero in fixed values."""
        self.functions(field)
        forces = np.concatenate([_sum(terms) for terms in self._actions])
        return np.where(self._free, loads - forces, 0.0)

    def correction(self, residual: np.ndarray) -> np.ndarray:
        """Change of a field by one preconditioned step for a residual. Every rank calls."""
        way, energy = self._improved(residual)
        return way if energy <= 0.0 else self._product(way, residual) / energy * way

    def approximate(self, loads: np.ndarray) -> np.ndarray:
        """Approximate solution for loads: the preconditioner, linear and symmetric."""
        return self._improved(loads)[0]

    def _improved(self, loads: np.ndarray) -> tuple[np.ndarray, float]:
        """Field of `approximate`, and its energy norm squared.

        With the blocks K of the space, S of the surplus and C between them, and loads f and g: the
        solutions ``S a = g``, ``K u = f - Cᵀ a`` and ``S d = g - C u - S a`` give the field
        u, a + d and, without assembling its forces, the energy
        ``u·f + d·C u + (a + d)·(C u + S (a + d))``.
        """
        count, block = self.spaces.owned, self._block
        loads = np.where(self._free, loads, 0.0)
        first = block.solve(loads[count:])
        field = np.concatenate([np.zeros(count), first])
        field[:count] = self._solve(loads[:count] - self._forces(field, 0))
        forces, mine = self._forces(field, 1), block.forces(first)
        change = block.solve(loads[count:] - forces)
        field[count:] += change
        energy = self._product(field[:count], loads[:count])
        energy += self._product(change, forces - mine)
        energy += self._product(field[count:], forces + block.forces(change))
        return field, energy

    def _forces(self, field: np.ndarray, part: int) -> np.ndarray:
        """Forces of a correction on the space (0) or on the surplus (1)."""
        self.functions(field)
        forces = _sum(self._actions[part])
        if any(self._regular[part]):
            forces = forces + _sum(self._regular[part])
        count = self.spaces.owned
        free = self._free[count:] if part else self._free[:count]
        return np.where(free, forces, 0.0)

    def _product(self, first: np.ndarray, second: np.ndarray) -> float:
        return float(sum_over_ranks(self._comm, first @ second))


def _sum(forms: Sequence[Sequence[fem.Form]]) -> np.ndarray:
    """Sum of assembled terms, body by body."""
    return np.concatenate([np.sum([assembled(t) for t in terms], axis=0) for terms in forms])


class _SurplusBlock:
    """Matrix of the bilinear form on the surplus; solved directly in 2D, iteratively in 3D."""

    def __init__(self, matrix: PETSc.Mat, fixed: np.ndarray, dim: int):
        self._matrix = supported(matrix, fixed)
        self._factor = DirectSolver(self._matrix, dim=dim) if dim == 2 else None
        self._iteration = None if dim == 2 else _conjugate_gradients(self._matrix)

    def solve(self, loads: np.ndarray) -> np.ndarray:
        """Solve for the surplus under loads (n_owned,). Every rank calls."""
        if self._factor is not None:
            return self._factor.solve(loads)
        assert self._iteration is not None
        x, b = self._matrix.createVecs()
        b.setArray(loads)
        self._iteration.solve(b, x)
        return x.getArray().copy()

    def forces(self, surplus: np.ndarray) -> np.ndarray:
        """Forces of a surplus that vanishes in fixed values. Every rank calls."""
        return multiply(self._matrix, surplus)


def _conjugate_gradients(matrix: PETSc.Mat) -> PETSc.KSP:
    solver = PETSc.KSP().create(matrix.comm)
    solver.setOperators(matrix)
    solver.setType(PETSc.KSP.Type.CG)
    solver.getPC().setType(PETSc.PC.Type.SOR)
    solver.setTolerances(rtol=_TOLERANCE, max_it=100)
    return solver

"""A linear problem improved by the surplus of the next degree, with the factor that is at hand.

The factor solves the problem on its own space; the surplus is nearly orthogonal to it in energy,
and its matrix well conditioned. One step of conjugate gradients, preconditioned by solving on the
surplus, on the space, and on the surplus again, finds four fifths and more of what a solution of
the next degree would change: an estimate of the error (Bank and Smith, SIAM J. Numer. Anal. 30
(1993) 921: hierarchical bases).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from petsc4py import PETSc

import numpy as np
import ufl
from dolfinx import fem
from dolfinx.fem.petsc import assemble_matrix

from ...parallel import sum_over_ranks
from ..compiled import assembled, compiled
from ..direct_solver import Factor
from ..field import owned
from .elasticity import supported

_TOLERANCE = 1e-2  # of solutions on the surplus in space, where a factor would cost too much


class EnrichedProblem:
    """A symmetric positive problem on a space and its surplus.

    A field is an array of the owned values of the space and then of the surplus.

    Parameters
    ----------
    space, surplus : dolfinx.fem.FunctionSpace
        See `surplus.surplus_space`.
    forms, regular : sequence of callable
        Terms of the bilinear form, of a trial and a test function each. Those that are `regular`
        stand in corrections only, for what holds a body that nothing else does.
    solve : callable
        Solves for corrections on the space alone, under loads (n_owned,).
    fixed : tuple of ndarray of bool
        Values of the space and of the surplus that are given, and stay as they are.
    """

    def __init__(
        self,
        space: fem.FunctionSpace,
        surplus: fem.FunctionSpace,
        forms: Sequence[Callable],
        solve: Callable[[np.ndarray], np.ndarray],
        fixed: tuple[np.ndarray, np.ndarray],
        regular: Sequence[Callable] = (),
    ):
        self.space, self.surplus = space, surplus
        self._comm = space.mesh.comm
        self._solve = solve
        self._free = ~np.concatenate(fixed)
        self._values = fem.Function(space), fem.Function(surplus)
        field = self._values[0] + self._values[1]
        tests = ufl.TestFunction(space), ufl.TestFunction(surplus)
        self._actions, self._regular = (
            [[compiled(term(field, test)) for term in terms] for test in tests]
            for terms in (forms, regular)
        )
        trial = ufl.TrialFunction(surplus)
        terms = [term(trial, tests[1]) for term in (*forms, *regular)]
        self._block = _SurplusBlock(terms, fixed[1], space.mesh.topology.dim)

    def field(self, values: np.ndarray) -> np.ndarray:
        """A field from values of the space (n_owned,), without surplus."""
        return np.concatenate([values, np.zeros(owned(self.surplus))])

    def function(self, field: np.ndarray):
        """The field as a UFL expression, until the next one is asked for."""
        count = owned(self.space)
        parts = field[:count], field[count:]
        for function, values in zip(self._values, parts, strict=True):
            function.x.array[: len(values)] = values
            function.x.scatter_forward()
        return self._values[0] + self._values[1]

    def loads(self, form: Callable) -> np.ndarray:
        """Loads of a linear form, which is a function of its test function."""
        tests = ufl.TestFunction(self.space), ufl.TestFunction(self.surplus)
        return np.concatenate([assembled(compiled(form(test))) for test in tests])

    def residual(self, field: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """What a field leaves of loads."""
        self.function(field)
        forces = np.concatenate([_sum(terms) for terms in self._actions])
        return np.where(self._free, loads - forces, 0.0)

    def correction(self, residual: np.ndarray) -> np.ndarray:
        """Change of a field that takes away most of what it leaves of loads. Every rank calls."""
        way, energy = self._improved(residual)
        return way if energy <= 0.0 else self._product(way, residual) / energy * way

    def approximate(self, loads: np.ndarray) -> np.ndarray:
        """A field near to the solution under loads, linear and symmetric in them."""
        return self._improved(loads)[0]

    def _improved(self, loads: np.ndarray) -> tuple[np.ndarray, float]:
        """The field of `approximate`, and its energy: twice the work of the loads that hold it.

        With the blocks K of the space, S of the surplus and C between them, and loads f and g: the
        solutions ``S a = g``, ``K u = f - Cᵀ a`` and ``S d = g - C u - S a`` give the field
        u, a + d and, without assembling its forces, the energy
        ``u·f + d·C u + (a + d)·(C u + S (a + d))``.
        """
        count, block = owned(self.space), self._block
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
        """Loads on the space (0) or on the surplus (1) that hold a correction."""
        self.function(field)
        forces = _sum([*self._actions[part], *self._regular[part]])
        count = owned(self.space)
        free = self._free[count:] if part else self._free[:count]
        return np.where(free, forces, 0.0)

    def _product(self, first: np.ndarray, second: np.ndarray) -> float:
        return float(sum_over_ranks(self._comm, first @ second))


def _sum(terms: Sequence[fem.Form]) -> np.ndarray:
    return np.sum([assembled(term) for term in terms], axis=0)


class _SurplusBlock:
    """The sum of bilinear forms on the surplus; solved by a factor, in space by iteration."""

    def __init__(self, forms: Sequence, fixed: np.ndarray, dim: int):
        matrix = assemble_matrix(compiled(forms[0]))
        for form in forms[1:]:
            assemble_matrix(matrix, compiled(form), [])  # type: ignore[arg-type]  # dispatches on it
        matrix.assemble()
        self._matrix = supported(matrix, fixed)
        self._factor = Factor(self._matrix, dim=dim) if dim == 2 else None
        self._iteration = None if dim == 2 else _conjugate_gradients(self._matrix)

    def solve(self, loads: np.ndarray) -> np.ndarray:
        """Surplus under loads (n_owned,). Every rank calls."""
        if self._factor is not None:
            return self._factor.solve(loads)
        assert self._iteration is not None
        x, b = self._matrix.createVecs()
        b.setArray(loads)
        self._iteration.solve(b, x)
        return x.getArray().copy()

    def forces(self, surplus: np.ndarray) -> np.ndarray:
        """Loads that hold a surplus which vanishes where it is fixed. Every rank calls."""
        x, b = self._matrix.createVecs()
        x.setArray(surplus)
        self._matrix.mult(x, b)
        return b.getArray().copy()


def _conjugate_gradients(matrix: PETSc.Mat) -> PETSc.KSP:
    solver = PETSc.KSP().create(matrix.comm)
    solver.setOperators(matrix)
    solver.setType(PETSc.KSP.Type.CG)
    solver.getPC().setType(PETSc.PC.Type.SOR)
    solver.setTolerances(rtol=_TOLERANCE, max_it=100)
    return solver

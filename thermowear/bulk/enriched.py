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

from ..parallel import sum_over_ranks
from .compiled import assembled, compiled
from .elasticity import supported
from .factor import Factor
from .field import owned

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
        self._surplus_solver = _solver(terms, fixed[1], space.mesh.topology.dim)

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
        return np.where(self._free, loads - self._apply(field, self._actions), 0.0)

    def correction(self, residual: np.ndarray) -> np.ndarray:
        """Change of a field that takes away most of what it leaves of loads. Every rank calls."""
        way = self.approximate(residual)
        energy = self._product(way, self._stiff(way))
        return way if energy <= 0.0 else self._product(way, residual) / energy * way

    def approximate(self, loads: np.ndarray) -> np.ndarray:
        """A field near to the solution under loads, linear and symmetric in them."""
        loads = np.where(self._free, loads, 0.0)
        count = owned(self.space)
        field = np.zeros(len(loads))
        field[count:] = self._surplus_solver(loads[count:])
        field[:count] = self._solve((loads - self._stiff(field))[:count])
        field[count:] += self._surplus_solver((loads - self._stiff(field))[count:])
        return field

    def _stiff(self, field: np.ndarray) -> np.ndarray:
        """Loads that hold a correction."""
        result = self._apply(field, self._actions)
        if self._regular[0]:
            result = result + self._apply(field, self._regular)
        return np.where(self._free, result, 0.0)

    def _apply(self, field: np.ndarray, actions: Sequence[Sequence[fem.Form]]) -> np.ndarray:
        self.function(field)
        return np.concatenate(
            [np.sum([assembled(term) for term in terms], axis=0) for terms in actions]
        )

    def _product(self, first: np.ndarray, second: np.ndarray) -> float:
        return float(sum_over_ranks(self._comm, first @ second))


def _solver(forms: Sequence, fixed: np.ndarray, dim: int) -> Callable[[np.ndarray], np.ndarray]:
    """Solves the sum of bilinear forms: by a factor, in space by conjugate gradients."""
    matrix = assemble_matrix(compiled(forms[0]))
    for form in forms[1:]:
        assemble_matrix(matrix, compiled(form), [])  # type: ignore[arg-type]  # dispatches on it
    matrix.assemble()
    matrix = supported(matrix, fixed)
    if dim == 2:
        return Factor(matrix, dim=dim).solve
    solver = PETSc.KSP().create(matrix.comm)
    solver.setOperators(matrix)
    solver.setType(PETSc.KSP.Type.CG)
    solver.getPC().setType(PETSc.PC.Type.SOR)
    solver.setTolerances(rtol=_TOLERANCE, max_it=100)

    def solve(loads: np.ndarray) -> np.ndarray:
        x, b = matrix.createVecs()
        b.setArray(loads)
        solver.solve(b, x)
        return x.getArray().copy()

    return solve

"""The conducting bodies, one of which may pass by and carry heat along.

The unknown is the rise over the ambient temperature.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp
from dolfinx import fem

from ...errors import ComputationError
from ...parallel import sum_over_ranks
from ..direct_solver import Factor
from .advection import Advection
from .even_paths import EvenFactor, EvenPaths

_HIDDEN = 1e-8
"""Part of the flows between a node and its neighbours that counts as heat turned over where there
is no other: rounding errors are 1e-8 of that."""


@dataclass(frozen=True)
class Conduction:
    """The conducting bodies, factorised.

    Attributes
    ----------
    space : dolfinx.fem.FunctionSpace
        Temperature rise over the ambient [K].
    conductivity : petsc4py.PETSc.Mat
        Conduction, cooling and advection, without given temperatures and without `bath` [W/K].
    cooling : petsc4py.PETSc.Mat
        The cooling part alone: its row sums times the rise give the heat carried off [W/K].
    carried : petsc4py.PETSc.Mat or None
        The advection part alone, likewise [W/K].
    capacity : petsc4py.PETSc.Mat or None
        Heat stored per rise, where the materials say [J/K].
    bath : petsc4py.PETSc.Mat
        See `conduction`.
    fixed : ndarray of bool, shape (n_owned,)
        Where the temperature is given.
    given : ndarray, shape (n_owned,)
        The rise in the fixed values, zero elsewhere [K].
    factor : Factor or EvenFactor
        Of conductivity and bath, with given temperatures.
    lifted : ndarray, shape (n_owned,)
        Heat into the free values that holds the given temperatures [W].
    advection : Advection or None
    even : EvenPaths or None
        Of a body that passes so fast that heat is spread along its way.
    symmetric : bool
        Whether the factorised matrix is.
    """

    space: fem.FunctionSpace
    conductivity: PETSc.Mat
    cooling: PETSc.Mat
    carried: PETSc.Mat | None
    capacity: PETSc.Mat | None
    bath: PETSc.Mat
    fixed: np.ndarray
    given: np.ndarray
    factor: Factor | EvenFactor
    lifted: np.ndarray
    advection: Advection | None
    even: EvenPaths | None
    symmetric: bool

    def respond(self, heat: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Rise [K] due to nodal heat [W] alone, given temperatures at ambient; columns allowed."""
        return self.factor.solve(self._free(heat))

    def sense(self, weights: np.ndarray) -> np.ndarray:
        """The adjoint, by columns: its product with any heat is that of weights and `respond`."""
        if self.symmetric:
            return self.respond(weights)
        return self._free(self.factor.solve_transposed(self._free(weights)))

    def solve(self, heat: np.ndarray) -> np.ndarray:
        """Rise [K] due to nodal heat [W] and the given temperatures."""
        return self.given + self.respond(heat + self.lifted)

    def holding(self, given: np.ndarray) -> Conduction:
        """The same bodies with other given rises (n_owned,), zero in the free values [K]."""
        return replace(self, given=given, lifted=-multiply(self.conductivity, given))

    def per_ambient(self) -> np.ndarray:
        """Nodal heat per rise of the surroundings, and of what comes in, (n_owned,) [W/K]."""
        ones = np.ones(len(self.fixed))
        heat = multiply(self.cooling, ones)
        return heat if self.carried is None else heat + multiply(self.carried, ones)

    def storing(self, step: float) -> Conduction:
        """Conduction at the end of an implicit Euler step of time [s].

        Its nodal heat is that of the bodies themselves and what `stored` gives of the state before,
        over the step.

        Raises
        ------
        ComputationError
            If the heat capacity is not known.
        """
        if self.capacity is None:
            raise ComputationError("heat: density and specific heat of the bodies are not known")
        return self.plus(self.capacity, 1 / step, self.symmetric)

    def plus(self, matrix: PETSc.Mat, times: float, symmetric: bool) -> Conduction:
        """So many times a matrix of the same pattern added to the conductivity; factorises it."""
        sum_ = self.conductivity.copy()
        sum_.axpy(times, matrix, PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
        return replace(
            self,
            conductivity=sum_,
            factor=factorised(self.space, sum_, self.bath, self.fixed, symmetric, self.even),
            lifted=-multiply(sum_, self.given),
            symmetric=symmetric,
        )

    def stored(self, rise: np.ndarray) -> np.ndarray:
        """Heat stored by nodes [J], owned rows; its sum over all ranks is that of the bodies."""
        assert self.capacity is not None
        return multiply(self.capacity, rise)

    def rounding(self, rise: np.ndarray) -> float:
        """Least heat flow that a balance of a rise (n_owned,) can be relative to [W].

        Bodies of one temperature turn over nothing but rounding errors.
        """
        size = float(np.abs(self.conductivity.getDiagonal().getArray()) @ np.abs(rise))
        return _HIDDEN * float(sum_over_ranks(self.space.mesh.comm, np.array(size)))

    def losses(
        self,
        rise: np.ndarray,
        heat: np.ndarray,
        storage: np.ndarray | None = None,
        ambient: float = 0.0,
    ) -> tuple[float, float, float]:
        """Heat that leaves by cooling, by given temperatures, and with a body that passes [W].

        Parameters
        ----------
        rise, heat : ndarray, shape (n_owned,)
            A state and the nodal heat, of the contact and of `per_ambient`, that goes with it.
        storage : ndarray, shape (n_owned,), optional
            Rate of what the nodes store, see `stored` [W].
        ambient : float, optional
            Rise of the surroundings [K].

        Returns
        -------
        tuple of float
            Sums over all ranks.
        """
        cooled, carried = self._per_rise
        left = self._into_given(rise, heat if storage is None else heat - storage)
        above = rise - ambient
        parts = np.array([cooled @ above, left.sum(), carried @ above])
        return tuple(sum_over_ranks(self.space.mesh.comm, parts))

    def turnover(
        self,
        rise: np.ndarray,
        heat: np.ndarray,
        storage: np.ndarray | None = None,
        ambient: float = 0.0,
    ) -> float:
        """Magnitude of what crosses cooled surfaces and those with a given temperature [W].

        Parameters as in `losses`.
        """
        size = np.abs(multiply(self.cooling, rise - ambient)).sum()
        size += np.abs(self._into_given(rise, heat if storage is None else heat - storage)).sum()
        return float(sum_over_ranks(self.space.mesh.comm, size))

    def _into_given(self, rise: np.ndarray, heat: np.ndarray) -> np.ndarray:
        """Heat into the values with a given temperature [W]."""
        if not self._holds:
            return np.zeros(0)
        return (heat - multiply(self.conductivity, rise))[self.fixed]

    @cached_property
    def _holds(self) -> bool:
        """Whether any rank has a given temperature; every rank calls."""
        return any(self.space.mesh.comm.allgather(bool(self.fixed.any())))

    @cached_property
    def _per_rise(self) -> tuple[np.ndarray, np.ndarray]:
        """Heat that leaves by cooling, and carried along, per nodal rise [W/K]."""
        nothing = np.zeros(len(self.fixed))
        return (
            _column_sums(self.cooling),
            nothing if self.carried is None else _column_sums(self.carried),
        )

    def _free(self, heat):
        """Nodal heat without that into given temperatures."""
        if sp.issparse(heat):
            return (sp.diags(~self.fixed, dtype=float) @ heat).tocsr()
        free = np.array(heat, dtype=float)
        free[self.fixed] = 0.0
        return free


def factorised(
    space,
    conductivity: PETSc.Mat,
    bath: PETSc.Mat,
    fixed: np.ndarray,
    symmetric: bool,
    even: EvenPaths | None,
) -> Factor | EvenFactor:
    """Of conductivity and bath, rows and columns of given temperatures eliminated."""
    matrix = conductivity.copy()
    matrix.axpy(1.0, bath, PETSc.Mat.Structure.DIFFERENT_NONZERO_PATTERN)
    known = "definite" if symmetric else "none"
    if even is not None:
        return even.factor(matrix, fixed, known)
    first = matrix.getOwnershipRange()[0]
    matrix.zeroRowsColumns((np.flatnonzero(fixed) + first).astype(PETSc.IntType), diag=1.0)
    return Factor(matrix, known, dim=space.mesh.topology.dim)


def _column_sums(matrix: PETSc.Mat) -> np.ndarray:
    """By owned columns; every rank calls."""
    sums, ones = matrix.createVecs()
    ones.set(1.0)
    matrix.multTranspose(ones, sums)
    return sums.getArray().copy()


def multiply(matrix: PETSc.Mat, values: np.ndarray) -> np.ndarray:
    x, y = matrix.createVecs()
    x.setArray(values)
    matrix.mult(x, y)
    return y.getArray().copy()

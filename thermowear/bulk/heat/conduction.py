"""Heat conduction in the bodies, with optional advection by a moving body.

The unknown is the temperature rise over ambient.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from ...errors import ComputationError
from ...parallel import sum_over_ranks
from ..joints import NO_JOINTS, Joints
from ..solvers.choice import AnySolver, SolverChoice, linear_solver
from ..solvers.direct import GroupSolvers, eliminate, multiply
from ..solvers.groups import AnyFactor, JoinedSolver, SolverInGroup, solver_in_group
from ..solvers.multigrid import MultigridSolver
from ..spaces import Spaces, without_fixed
from .advection import Advection
from .paths import EvenFactor, EvenPaths, PathSolver


@dataclass(frozen=True)
class GroupConduction:
    """Conduction in a group of bodies; it does not depend on the heat in the others.

    Attributes
    ----------
    solver : DirectSolver, JoinedSolver or SolverInGroup
        Solver of conductivity plus bath, with prescribed temperatures eliminated.
    fixed : ndarray of bool, shape (n_own,)
        Mask of prescribed temperatures, rows of the group owned by this rank.
    symmetric : bool
        True if its matrix is symmetric.
    """

    solver: AnyFactor | SolverInGroup
    fixed: np.ndarray
    symmetric: bool

    def respond(self, heat: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Rise [K] due to nodal heat [W] in the group alone, see `Conduction.respond`."""
        return self.solver.solve(without_fixed(heat, self.fixed))

    def adjoint_response(self, weights: np.ndarray) -> np.ndarray:
        """Adjoint of `respond` by columns."""
        if self.symmetric:
            return self.respond(weights)
        found = self.solver.solve_transposed(without_fixed(weights, self.fixed))
        return without_fixed(found, self.fixed)


ConductionSolver = AnySolver | EvenFactor


def conduction_solver(
    spaces: Spaces,
    conductivity: PETSc.Mat,
    bath: PETSc.Mat,
    fixed: np.ndarray,
    moving: Advection | None,
    even: EvenPaths | None,
    choice: SolverChoice,
    symmetric: bool | None = None,
    coupled: bool = False,
    joints: Joints = NO_JOINTS,
) -> ConductionSolver:
    """Set up the solver of conductivity plus bath, without the prescribed temperatures.

    Where temperatures are uniform along paths it is direct. `coupled` as in `linear_solver`.
    """
    matrix = conductivity.copy()
    matrix.axpy(1.0, bath, PETSc.Mat.Structure.DIFFERENT_NONZERO_PATTERN)
    known = "definite" if (moving is None if symmetric is None else symmetric) else "none"
    if even is not None:
        return even.factor(matrix, fixed, known, joints)
    first = matrix.getOwnershipRange()[0]
    matrix.zeroRowsColumns((np.flatnonzero(fixed) + first).astype(PETSc.IntType), diag=1.0)
    if choice.iterative and moving is not None and moving.paths is not None and not joints.count:
        return PathSolver(matrix, spaces, fixed, moving.paths)
    return linear_solver(choice, matrix, spaces, fixed, known, coupled=coupled, joints=joints)


_RATE_TOLERANCE = 1e-3
"""Relative residual of rates of temperature, which serve an estimate."""
_BALANCE_FLOOR = 1e-8
"""Fraction of the flows between neighbouring nodes that serves as scale of the heat balance where
no other heat flows; rounding errors are 1e-8 of these flows."""


@dataclass(frozen=True)
class Conduction:
    """Heat conduction problem of the bodies, with the solver of its equations.

    Attributes
    ----------
    spaces : Spaces
        Spaces of the temperature rise over ambient [K].
    conductivity : petsc4py.PETSc.Mat
        Conduction, cooling and advection, without given temperatures and without `bath` [W/K].
    cooling : petsc4py.PETSc.Mat
        Cooling term alone: its row sums times the rise give the heat removed [W/K].
    capacity : petsc4py.PETSc.Mat or None
        Heat capacity matrix, if given by the materials [J/K].
    bath : petsc4py.PETSc.Mat
        See `conduction`.
    fixed : ndarray of bool, shape (n_owned,)
        Mask of prescribed temperatures.
    prescribed : ndarray, shape (n_owned,)
        Prescribed rise in the fixed values, zero elsewhere [K].
    factor : DirectSolver, GroupSolvers, JoinedSolver, EvenFactor or MultigridSolver
        Solver of conductivity plus bath, with prescribed temperatures eliminated.
    advection : Advection or None
    even : EvenPaths or None
        Paths of a fast moving body, along which the temperature is uniform.
    symmetric : bool
        True if the matrix of the solver is symmetric.
    choice : SolverChoice
        Kind of the solver.
    joints : Joints
        Joints of glued bodies; their multipliers are heat fluxes into the first of them [W/m²].
    """

    spaces: Spaces
    conductivity: PETSc.Mat
    cooling: PETSc.Mat
    capacity: PETSc.Mat | None
    bath: PETSc.Mat
    fixed: np.ndarray
    prescribed: np.ndarray
    factor: ConductionSolver
    advection: Advection | None
    even: EvenPaths | None
    symmetric: bool
    choice: SolverChoice
    joints: Joints

    def respond(self, heat: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Rise [K] due to nodal heat [W] alone, homogeneous in prescribed values; by columns."""
        return self.factor.solve(self._free(heat))

    def adjoint_response(self, weights: np.ndarray) -> np.ndarray:
        """Adjoint of `respond` by columns: ``sense(w)·q = w·respond(q)`` for any heat q."""
        if self.symmetric:
            return self.respond(weights)
        return self._free(self.factor.solve_transposed(self._free(weights)))

    def solve(self, heat: np.ndarray) -> np.ndarray:
        """Rise [K] due to nodal heat [W] and prescribed temperatures."""
        rise = self.prescribed + self.respond(heat - self._from_prescribed)
        if not self.joints.count:
            return rise
        jumps = self.joints.jumps(self.spaces, self.prescribed)
        return rise - self._joined.closing(jumps) if jumps.any() else rise

    @property
    def _joined(self) -> JoinedSolver | GroupSolvers | EvenFactor:
        """Solver of bodies with joints."""
        assert isinstance(self.factor, JoinedSolver | GroupSolvers | EvenFactor)
        return self.factor

    def with_prescribed(self, prescribed: np.ndarray | None) -> Conduction:
        """Copy with other prescribed rises (n_owned,), zero in the free values; None: as is [K]."""
        return self if prescribed is None else replace(self, prescribed=prescribed)

    def per_ambient(self) -> np.ndarray:
        """Nodal heat per rise of ambient and of entering material, (n_owned,) [W/K]."""
        ones = np.ones(len(self.fixed))
        heat = multiply(self.cooling, ones)
        return heat if self.advection is None else heat + multiply(self.advection.carried, ones)

    def implicit_euler(self, step: float) -> Conduction:
        """Conduction at the end of an implicit Euler step of time [s].

        Its nodal heat is that of the bodies plus `stored_heat` of the previous state divided by the
        step.

        Raises
        ------
        ComputationError
            If the heat capacity is not given.
        """
        if self.capacity is None:
            raise ComputationError("heat: density and specific heat of the bodies are not given")
        return self.with_added(self.capacity, 1 / step, self.symmetric)

    def tangent(self, rise: np.ndarray, step: float | None = None) -> Conduction:
        """Linearised conduction at a rise (n_owned,), within a time step [s] if one is given."""
        return self if step is None else self.implicit_euler(step)

    def linearisation_error(self, rise: np.ndarray, reference: np.ndarray) -> np.ndarray | float:
        """Difference of tangent (at a reference) and nonlinear conduction of a rise [W]."""
        return 0.0

    def with_added(self, matrix: PETSc.Mat, times: float, symmetric: bool) -> Conduction:
        """Add a multiple of a matrix of the same pattern to the conductivity; a new solver."""
        total = self.conductivity.copy()
        total.axpy(times, matrix, PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
        factor = self._solver(conductivity=total, symmetric=symmetric)
        return replace(self, conductivity=total, factor=factor, symmetric=symmetric)

    def coupled(self, exchange: PETSc.Mat) -> Conduction:
        """Copy whose solver includes heat exchange between the bodies instead of the bath [W/K]."""
        factor = self._solver(bath=exchange, coupled=True)
        if isinstance(factor, MultigridSolver) and isinstance(self.factor, MultigridSolver):
            factor.iterations = self.factor.iterations  # counted together
        return replace(self, bath=exchange, factor=factor)

    def for_columns(self) -> Conduction:
        """Copy for many columns, where single solutions are found by multigrid: it factorises.

        The same if the memory does not suffice. Every rank calls.
        """
        if not self.choice.factorises_heat_columns:
            return self
        return replace(self, factor=self._solver(choice=SolverChoice(one_at_a_time=True)))

    def _solver(self, **others) -> ConductionSolver:
        """Solver of this problem with other arguments of `conduction_solver`."""
        names = "spaces", "conductivity", "bath", "fixed", "even", "choice", "symmetric", "joints"
        own = {name: getattr(self, name) for name in names}
        return conduction_solver(**(own | {"moving": self.advection} | others))

    def release(self) -> None:
        """Free levels of multigrid and factors of columns, until they are needed again."""
        if isinstance(self.factor, GroupSolvers | MultigridSolver):
            self.factor.release()

    def in_group(self, group: int) -> GroupConduction:
        """Conduction in one group of bodies, for heat in it. Every rank calls."""
        solver, rows = solver_in_group(self.factor, self.spaces, group), self.spaces.groups[group]
        return GroupConduction(solver, self.fixed[self.spaces.rows(*rows)], self.symmetric)

    def multipliers(self, rise: np.ndarray, heat: np.ndarray) -> np.ndarray:
        """Multipliers of the joints (m,) of a state and its nodal heat, see `losses`; collective.

        Heat fluxes into the first of the bodies [W/m²].
        """
        if not self.joints.count:
            return np.zeros(0)
        residual = heat - multiply(self.conductivity, rise)
        return self._joined.multipliers(residual, self.joints.jumps(self.spaces, rise))

    def joint_heat(self, rise: np.ndarray, heat: np.ndarray) -> np.ndarray:
        """Nodal heat that the joints pass to the bodies [W], see `multipliers`; owned rows."""
        if not self.joints.count:
            return np.zeros(len(rise))
        return -(self.joints.jump @ self.multipliers(rise, heat))

    def stored_heat(self, rise: np.ndarray) -> np.ndarray:
        """Nodal stored heat [J], owned rows; its sum over all ranks is that of the bodies."""
        assert self.capacity is not None
        return multiply(self.capacity, rise)

    def storage_rate(self, rise: np.ndarray, heat: np.ndarray) -> np.ndarray:
        """Rate of a rise by nodal heat that conduction does not carry off [K/s], owned rows.

        Zero where temperatures are prescribed. Every rank calls.
        """
        assert self.capacity is not None
        solver = PETSc.KSP().create(self.spaces.comm)
        matrix = self.capacity.copy()
        eliminate(matrix, self.fixed)
        solver.setOperators(matrix)
        solver.setType(PETSc.KSP.Type.GMRES)
        solver.getPC().setType(PETSc.PC.Type.JACOBI)
        solver.setTolerances(rtol=_RATE_TOLERANCE, max_it=200)
        x, b = matrix.createVecs()
        b.setArray(self._free(heat - self.conducted(rise)))
        solver.solve(b, x)
        return x.getArray().copy()

    def balance_scale(self, rise: np.ndarray) -> float:
        """Smallest meaningful scale of the heat balance of a rise (n_owned,) [W].

        In bodies of uniform temperature all heat flows are rounding errors.
        """
        size = float(np.abs(self.conductivity.getDiagonal().getArray()) @ np.abs(rise))
        return _BALANCE_FLOOR * float(sum_over_ranks(self.spaces.comm, np.array(size)))

    def losses(
        self, rise: np.ndarray, heat: np.ndarray, ambient: float = 0.0
    ) -> tuple[float, float, float]:
        """Heat removed by cooling, by prescribed temperatures, and by advection [W].

        Parameters
        ----------
        rise, heat : ndarray, shape (n_owned,)
            A state and its nodal heat, from the contact and from `per_ambient`, less the rate of
            the nodal stored heat.
        ambient : float, optional
            Rise of the ambient temperature [K].

        Returns
        -------
        tuple of float
            Sums over all ranks.
        """
        cooling_per_rise, advective = self._per_rise
        excess = rise - ambient
        into_prescribed = self._into_prescribed(rise, heat).sum()
        parts = np.array([cooling_per_rise @ excess, into_prescribed, advective @ excess])
        return tuple(sum_over_ranks(self.spaces.comm, parts))

    def into_bodies(self, rise: np.ndarray, heat: np.ndarray) -> np.ndarray:
        """Net heat into the bodies by node, and the magnitudes of its parts, (2, n_owned) [W].

        Nodal heat and that of the joints, less what `losses` counts; parameters as there. The sum
        over a body vanishes if its heat balances.
        """
        lost = sum(self._per_rise) * rise  # the rise of the surroundings is in the heat
        joined = self.joint_heat(rise, heat)
        lost[self.fixed] += (heat + joined - self.conducted(rise))[self.fixed]
        rounding = _BALANCE_FLOOR * np.abs(self.conductivity.getDiagonal().getArray() * rise)
        return np.array(
            [heat + joined - lost, np.abs(heat) + np.abs(joined) + np.abs(lost) + rounding]
        )

    def exchanged_heat(self, rise: np.ndarray, heat: np.ndarray, ambient: float = 0.0) -> float:
        """Sum of the magnitudes of heat through cooled and prescribed-temperature surfaces [W].

        Parameters as in `losses`.
        """
        size = np.abs(multiply(self.cooling, rise - ambient)).sum()
        size += np.abs(self._into_prescribed(rise, heat)).sum()
        return float(sum_over_ranks(self.spaces.comm, size))

    def _into_prescribed(self, rise: np.ndarray, heat: np.ndarray) -> np.ndarray:
        """Heat into the values with a prescribed temperature [W]."""
        if not self._has_prescribed:
            return np.zeros(0)
        heat = heat + self.joint_heat(rise, heat)
        return (heat - self.conducted(rise))[self.fixed]

    def conducted(self, rise: np.ndarray) -> np.ndarray:
        """Nodal heat that a rise (n_owned,) conducts away, and that it loses by cooling [W]."""
        return multiply(self.conductivity, rise)

    @cached_property
    def _from_prescribed(self) -> np.ndarray:
        """Nodal heat of the prescribed temperatures alone, into the bath too, which is part of the
        solver where surfaces with prescribed temperatures meet a contact face [W]; collective.
        """
        return multiply(self.conductivity, self.prescribed) + multiply(self.bath, self.prescribed)

    @cached_property
    def _has_prescribed(self) -> bool:
        """True if any rank has a prescribed temperature. Every rank calls."""
        return any(self.spaces.comm.allgather(bool(self.fixed.any())))

    @cached_property
    def _per_rise(self) -> tuple[np.ndarray, np.ndarray]:
        """Heat removed by cooling and by advection per nodal rise [W/K]."""
        nothing = np.zeros(len(self.fixed))
        return (
            _column_sums(self.cooling),
            nothing if self.advection is None else self.advection.outflow,
        )

    def _free(self, heat):
        """Nodal heat with zeros in the values with a prescribed temperature."""
        return without_fixed(heat, self.fixed) if self._has_prescribed else heat


def _column_sums(matrix: PETSc.Mat) -> np.ndarray:
    """Column sums of a matrix, owned columns. Every rank calls."""
    sums, ones = matrix.createVecs()
    ones.set(1.0)
    matrix.multTranspose(ones, sums)
    return sums.getArray().copy()

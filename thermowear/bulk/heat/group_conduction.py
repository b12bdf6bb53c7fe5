"""Heat conduction in one body, or in glued ones, for many columns of heat."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ..field import without_fixed
from ..group_solvers import AnyFactor, SolverInGroup


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

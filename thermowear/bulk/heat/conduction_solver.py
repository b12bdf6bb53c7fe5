"""Choice of the solver of heat conduction."""

from __future__ import annotations

from petsc4py import PETSc

import numpy as np

from ..joints.joint import NO_JOINTS, Joints
from ..solver_choice import AnySolver, SolverChoice, linear_solver
from ..spaces import Spaces
from .advection import Advection
from .even_paths import EvenFactor, EvenPaths
from .path_solver import PathSolver

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

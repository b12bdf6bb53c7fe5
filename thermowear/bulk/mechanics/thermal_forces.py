"""Nodal forces of thermal expansion."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from petsc4py import PETSc

import numpy as np
import ufl

from ..compiled import assembled, assembled_matrix, compiled
from ..direct_solver import multiply
from ..spaces import Spaces


@dataclass(frozen=True)
class ThermalForces:
    """Nodal forces of temperature rises, linear in them, body by body.

    Attributes
    ----------
    forms : tuple of UFL forms
        Work of the thermal stress of a rise, bilinear, by body.
    columns : Spaces
        Spaces of the rise.
    once : bool
        True if a single product is expected: its vector takes less memory than a matrix.
    """

    forms: tuple[ufl.Form, ...]
    columns: Spaces
    once: bool = False

    @cached_property
    def each(self) -> tuple[PETSc.Mat, ...]:
        """Matrices G of the nodal forces per nodal rise by body [N/K]. Every rank calls first."""
        return tuple(assembled_matrix(form) for form in self.forms)

    def multiply(self, rise: np.ndarray) -> np.ndarray:
        """Forces [N] of a rise (n_owned,) of all bodies [K], owned rows. Every rank calls."""
        if self.once and "each" not in vars(self):
            rises = zip(self.forms, self.columns.functions(rise, "rise"), strict=True)
            return np.concatenate([assembled(compiled(ufl.action(*one))) for one in rises])
        parts = zip(self.each, self.columns.split(rise), strict=True)
        return np.concatenate([multiply(matrix, part) for matrix, part in parts])

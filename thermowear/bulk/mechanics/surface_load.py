"""Uniformly distributed forces and pressures on named surfaces, for `compiled.nodal_loads`."""

from __future__ import annotations

from collections.abc import Callable

from petsc4py import PETSc

import numpy as np
import ufl
from dolfinx import fem

from ..surface_area import surface_area
from .elasticity import Elasticity


def surface_work(elastic: Elasticity, surface: str, force: np.ndarray) -> Callable:
    """Form of the work of a force distributed over a surface, as a function of displacement [J].

    Parameters
    ----------
    elastic : Elasticity
    surface : str
    force : ndarray, shape (gdim,)
        Total force on the ring or over the thickness [N].
    """
    mesh, measure = elastic.bodies.mesh, elastic.bodies.surface_measure(surface)
    area = surface_area(elastic.bodies, elastic.kinematics, surface)
    traction = fem.Constant(mesh, np.asarray(force, dtype=PETSc.ScalarType) / area)
    return lambda δu: elastic.kinematics.integral(mesh, ufl.inner(traction, δu), measure)


def pressure_work(elastic: Elasticity, surface: str, pressure: float) -> Callable:
    """Form of the work of a pressure [Pa] along the inward normal; see `surface_work`."""
    mesh, measure = elastic.bodies.mesh, elastic.bodies.surface_measure(surface)
    traction = -fem.Constant(mesh, PETSc.ScalarType(pressure)) * ufl.FacetNormal(mesh)
    return lambda δu: elastic.kinematics.integral(mesh, ufl.inner(traction, δu), measure)

"""Uniformly distributed forces and pressures on named surfaces."""

from __future__ import annotations

from collections.abc import Callable

from petsc4py import PETSc

import numpy as np
import ufl
from dolfinx import fem

from ..compiled import assembled, compiled
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


def surface_load(elastic: Elasticity, surface: str, force: np.ndarray) -> np.ndarray:
    """Nodal loads of a force on a surface [N], owned rows; see `surface_work`. Every rank calls."""
    work = surface_work(elastic, surface, force)
    return assembled(compiled(work(ufl.TestFunction(elastic.space))))


def surface_pressure(elastic: Elasticity, surface: str, pressure: float) -> np.ndarray:
    """Nodal loads of a pressure [Pa], along the inward normal [N], owned rows. Every rank calls."""
    work = pressure_work(elastic, surface, pressure)
    return assembled(compiled(work(ufl.TestFunction(elastic.space))))

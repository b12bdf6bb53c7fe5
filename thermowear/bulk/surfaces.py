"""Areas of named surfaces, and uniformly distributed forces, pressures and heat on them."""

from __future__ import annotations

from collections.abc import Callable

from mpi4py import MPI

import numpy as np
import ufl
from dolfinx import default_scalar_type, fem

from .bodies import Bodies
from .compiled import compiled, nodal_loads
from .kinematics import Kinematics
from .mechanics.elasticity import Elasticity


def surface_area(bodies: Bodies, kinematics: Kinematics, surface: str) -> float:
    """Area of a surface of the solid according to its kinematic model [m²]. Every rank calls."""
    one = fem.Constant(bodies.mesh, default_scalar_type(1.0))
    form = kinematics.integral(bodies.mesh, one, bodies.surface_measure(surface))
    return bodies.mesh.comm.allreduce(fem.assemble_scalar(compiled(form)), op=MPI.SUM)


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
    traction = fem.Constant(mesh, np.asarray(force, dtype=default_scalar_type) / area)
    return lambda δu: elastic.kinematics.integral(mesh, ufl.inner(traction, δu), measure)


def pressure_work(elastic: Elasticity, surface: str, pressure: float) -> Callable:
    """Form of the work of a pressure [Pa] along the inward normal; see `surface_work`."""
    mesh, measure = elastic.bodies.mesh, elastic.bodies.surface_measure(surface)
    traction = -fem.Constant(mesh, default_scalar_type(pressure)) * ufl.FacetNormal(mesh)
    return lambda δu: elastic.kinematics.integral(mesh, ufl.inner(traction, δu), measure)


def surface_heat(
    bodies: Bodies, kinematics: Kinematics, space: fem.FunctionSpace, surface: str, flux: float
) -> np.ndarray:
    """Nodal heat of a uniform flux [W/m²] into the body through a surface [W], owned rows.

    Every rank calls; `space` is that of the temperature.
    """
    measure = bodies.surface_measure(surface)
    q = fem.Constant(bodies.mesh, default_scalar_type(flux))
    return nodal_loads(space, lambda δT: kinematics.integral(bodies.mesh, q * δT, measure))

"""Heat through named surfaces of the bodies."""

from __future__ import annotations

from mpi4py import MPI

import numpy as np
import ufl
from dolfinx import default_scalar_type, fem

from .bodies import Bodies
from .compiled import assembled, compiled
from .kinematics import Model


def surface_heat(
    bodies: Bodies, model: Model, space: fem.FunctionSpace, surface: str, flux: float
) -> np.ndarray:
    """Nodal heat of an even flux into the body through a surface [W], owned rows.

    Every rank calls.

    Parameters
    ----------
    bodies : Bodies
    model : Model
    space : dolfinx.fem.FunctionSpace
        Of the temperature.
    surface : str
    flux : float
        [W/m²]
    """
    δT, q = ufl.TestFunction(space), fem.Constant(bodies.mesh, default_scalar_type(flux))
    form = model.integral(bodies.mesh, q * δT, bodies.surface_measure(surface))
    return assembled(compiled(form))


def surface_area(bodies: Bodies, model: Model, surface: str) -> float:
    """Area of a surface, as its model counts it [m²]. Every rank calls."""
    one = fem.Constant(bodies.mesh, default_scalar_type(1.0))
    form = model.integral(bodies.mesh, one, bodies.surface_measure(surface))
    return bodies.mesh.comm.allreduce(fem.assemble_scalar(compiled(form)), op=MPI.SUM)

"""Heat through named surfaces of the bodies."""

from __future__ import annotations

from mpi4py import MPI
from petsc4py import PETSc

import numpy as np
import ufl
from dolfinx import default_scalar_type, fem
from dolfinx.fem.petsc import assemble_vector

from ..compat import exterior_facet_domain
from .bodies import Bodies
from .compiled import compiled
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
    form = model.integral(bodies.mesh, q * δT, _measure(bodies, surface))
    vector = assemble_vector(compiled(form))
    vector.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
    result = vector.getArray().copy()
    vector.destroy()
    return result


def surface_area(bodies: Bodies, model: Model, surface: str) -> float:
    """Area of a surface, as its model counts it [m²]. Every rank calls."""
    one = fem.Constant(bodies.mesh, default_scalar_type(1.0))
    form = model.integral(bodies.mesh, one, _measure(bodies, surface))
    return bodies.mesh.comm.allreduce(fem.assemble_scalar(compiled(form)), op=MPI.SUM)


def _measure(bodies: Bodies, surface: str) -> ufl.Measure:
    """Of one surface; all surfaces share one compiled form."""
    facets = exterior_facet_domain(bodies.mesh, bodies.facets(surface))
    return ufl.Measure("ds", domain=bodies.mesh, subdomain_data=[(1, facets)])(1)

"""Forces spread evenly over named surfaces, and pressures on them."""

from __future__ import annotations

from mpi4py import MPI
from petsc4py import PETSc

import numpy as np
import ufl
from dolfinx import fem
from dolfinx.fem.petsc import assemble_vector

from .compiled import compiled
from .elasticity import Elasticity


def surface_load(elastic: Elasticity, surface: str, force: np.ndarray) -> np.ndarray:
    """Nodal loads of a force on a surface [N], owned rows. Every rank calls.

    Parameters
    ----------
    elastic : Elasticity
    surface : str
    force : ndarray, shape (gdim,)
        Of the whole ring, or of the thickness [N].
    """
    mesh, measure = elastic.bodies.mesh, _measure(elastic, surface)
    one = fem.Constant(mesh, PETSc.ScalarType(1.0))
    local = fem.assemble_scalar(compiled(elastic.model.integral(mesh, one, measure)))
    area = mesh.comm.allreduce(local, op=MPI.SUM)
    traction = fem.Constant(mesh, np.asarray(force, dtype=PETSc.ScalarType) / area)
    return _nodal(elastic, traction, measure)


def surface_pressure(elastic: Elasticity, surface: str, pressure: float) -> np.ndarray:
    """Nodal loads of a pressure [Pa], along the inward normal [N], owned rows. Every rank calls."""
    mesh = elastic.bodies.mesh
    size = fem.Constant(mesh, PETSc.ScalarType(pressure))
    return _nodal(elastic, -size * ufl.FacetNormal(mesh), _measure(elastic, surface))


def _measure(elastic: Elasticity, surface: str) -> ufl.Measure:
    """Integration over a surface, exact on straight facets."""
    bodies = elastic.bodies
    measure = ufl.Measure("ds", domain=bodies.mesh, subdomain_data=bodies.facet_tags)
    return measure(bodies.surface_tag(surface))


def _nodal(elastic: Elasticity, traction, measure: ufl.Measure) -> np.ndarray:
    """Nodal loads of a traction, owned rows [N]."""
    mesh, δu = elastic.bodies.mesh, ufl.TestFunction(elastic.space)
    work = elastic.model.integral(mesh, ufl.inner(traction, δu), measure)
    vector = assemble_vector(compiled(work))
    vector.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
    result = vector.getArray().copy()
    vector.destroy()
    return result

"""Areas of named surfaces."""

from __future__ import annotations

from mpi4py import MPI

from dolfinx import default_scalar_type, fem

from .bodies import Bodies
from .compiled import compiled
from .kinematics import Kinematics


def surface_area(bodies: Bodies, kinematics: Kinematics, surface: str) -> float:
    """Area of a surface of the solid according to its kinematic model [m²]. Every rank calls."""
    one = fem.Constant(bodies.mesh, default_scalar_type(1.0))
    form = kinematics.integral(bodies.mesh, one, bodies.surface_measure(surface))
    return bodies.mesh.comm.allreduce(fem.assemble_scalar(compiled(form)), op=MPI.SUM)

"""Prescribed heat flux through named surfaces of the bodies."""

from __future__ import annotations

import numpy as np
from dolfinx import default_scalar_type, fem

from ..bodies import Bodies
from ..compiled import nodal_loads
from ..kinematics import Kinematics


def surface_heat(
    bodies: Bodies, kinematics: Kinematics, space: fem.FunctionSpace, surface: str, flux: float
) -> np.ndarray:
    """Nodal heat of a uniform flux into the body through a surface [W], owned rows.

    Every rank calls.

    Parameters
    ----------
    bodies : Bodies
    kinematics : Kinematics
    space : dolfinx.fem.FunctionSpace
        Temperature space.
    surface : str
    flux : float
        Heat flux into the body [W/m²].
    """
    q, measure = (
        fem.Constant(bodies.mesh, default_scalar_type(flux)),
        bodies.surface_measure(surface),
    )
    return nodal_loads(space, lambda δT: kinematics.integral(bodies.mesh, q * δT, measure))

"""Prescribed heat flux through named surfaces of the bodies."""

from __future__ import annotations

import numpy as np
import ufl
from dolfinx import default_scalar_type, fem

from ..bodies import Bodies
from ..compiled import assembled, compiled
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
    δT, q = ufl.TestFunction(space), fem.Constant(bodies.mesh, default_scalar_type(flux))
    form = kinematics.integral(bodies.mesh, q * δT, bodies.surface_measure(surface))
    return assembled(compiled(form))

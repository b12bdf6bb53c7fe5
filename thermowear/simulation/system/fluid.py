"""Forces of the fluid between contact faces, and loads that it overcomes.

The fluid presses on both faces, where they touch and where they are open, besides the contact
pressure: a dead load ``Bᵀ w p_f`` of the bodies. Friction, heat and wear are those of the contact
pressure alone.
"""

from __future__ import annotations

import numpy as np

from ...contact.operators.rigid_motion import RigidMode
from ...errors import ComputationError
from ...laws.principle.steady import NotCarried, not_carried
from .rigid_modes import fluid_pressure
from .system import System

_NOTHING = 1e-9  # of the largest load


def fluid_forces(system: System) -> dict[int, float]:
    """Opening force of the fluid along the load direction by interface, where it is given [N]."""
    pressure = fluid_pressure(system.model, system.contacts)
    if pressure is None:
        return {}
    along = np.einsum("ni,ni->n", system.contacts.normals, system.load_directions)
    force = system.weights * along * pressure
    each = enumerate(zip(system.model.interfaces, system.contacts.ranges, strict=True))
    return {
        index: float(force[own].sum())
        for index, (one, own) in each
        if one.fluid_pressure is not None
    }


def parted_by_fluid(system: System, load: np.ndarray) -> ComputationError | None:
    """Error with the forces if the loads are carried without the fluid only; otherwise None.

    Parameters
    ----------
    system : System
    load : ndarray, shape (k,)
        Generalised forces on the free motions, with those of the fluid [N or N m].
    """
    pressure = fluid_pressure(system.model, system.contacts)
    if pressure is None:
        return None
    modes, weights, model = system.holder.modes, system.weights, system.model
    opening = modes.T @ (weights * pressure)
    closing = load + opening
    left = load - _NOTHING * opening  # what is left by rounding carries nothing
    if not_carried(weights, modes, left) is None or not_carried(weights, modes, closing):
        return None
    forces = fluid_forces(system)
    opens = [
        f"{force:.4g} N" + (f" in {name}" if (name := model.interfaces[index].name) else "")
        for index, force in forces.items()
    ]
    loads = [
        f"{force:.4g} {'N m' if mode.motion.rotation.any() else 'N'}"
        for mode, force in zip(_free(system), closing, strict=True)
        if abs(force) > _NOTHING * np.abs(closing).max()
    ]
    table = model.interfaces[max(forces, key=lambda index: forces[index])].table
    return NotCarried(
        f"{table}.fluid_pressure: the fluid parts the faces: it presses with {', '.join(opens)}, "
        f"the loads with {', '.join(loads)}; raise the loads or lower the pressure"
    )


def _free(system: System) -> list[RigidMode]:
    """Rigid modes under a given load."""
    return [mode for mode in system.holder.rigid_modes if mode.load is not None]

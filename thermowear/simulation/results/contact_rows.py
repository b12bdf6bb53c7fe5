"""Rows of the contacts of several bodies at the end of a time step."""

from __future__ import annotations

import numpy as np

from ...results import ContactRow
from ..interface.sdirk import InterfaceState
from ..system.conditions import InterfaceConditions
from ..system.system import System


def contact_rows(
    system: System,
    conditions: InterfaceConditions,
    state: InterfaceState,
    time: float,
    ambient: float,
) -> list[ContactRow]:
    """Rows of the contacts of several bodies in a state.

    Parameters
    ----------
    system : System
    conditions : InterfaceConditions
        Conditions at that time.
    state : InterfaceState
    time : float
        [s]
    ambient : float
        Temperature that rises refer to [K].
    """
    p, nothing = state.pressure, np.full((2, len(state.pressure)), np.nan)
    powers = system.weights * conditions.heating * p
    areas = system.weights * (p > 0)
    kept = system.worn_areas * (state.by_body(system.laws) - system.moved)
    faces = nothing if state.faces is None else np.array(state.faces.rise) + ambient
    each = zip(system.contacts.ranges, system.lost, system.normal_forces(p), strict=True)
    return [
        ContactRow(
            time=time,
            contact=number,
            normal_force=force,
            friction_power=float(powers[own].sum()),
            max_pressure=float(p[own].max()),
            contact_area=float(areas[own].sum()),
            wear_volume_1=float(kept[0, own].sum() + lost[0]),
            wear_volume_2=float(kept[1, own].sum() + lost[1]),
            max_temperature_1=float(faces[0, own].max()),
            max_temperature_2=float(faces[1, own].max()),
        )
        for number, (own, lost, force) in enumerate(each, start=1)
    ]

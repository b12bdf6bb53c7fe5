"""Plausibility checks: holder moved against its load, contact of strongly inclined faces."""

from __future__ import annotations

import numpy as np

from ...errors import ComputationError
from ...model.analyses import Analysis
from ..results.recording import Snapshot
from ..system.rigid_modes import applied
from ..system.system import System

_ANALYSES = ("initial", "transient", "fretting", "reciprocating")
"""Analyses with a defined holder position; a steady state has no history leading to one."""
_BACK = 1e-9
"""Rounding tolerance of the position, relative to the size of the face."""
_STEEP = -0.75
"""Largest cosine between the outward normals where faces press; up to -0.5 they are paired."""


def went_back(system: System, analysis: Analysis, end: Snapshot) -> ComputationError | None:
    """Error for a holder that has moved against its load; None if it has not.

    Without heat and loads on surfaces, ``F·d = ∫ p g dA + ∫ p A p dA``: the loads do positive work
    on the holder unless the drawn faces overlap.
    """
    holder, pairing = system.model.holder, system.pairing
    if analysis.type not in _ANALYSES or system.thermal is not None or holder.surface_forces:
        return None
    if holder.force is None or system.worn is not None:
        return None
    back = -applied(holder, end.motion) / holder.force
    if back <= _BACK * pairing.extent:
        return None
    pressing = end.contact.pressure > 0
    overlap = -float(pairing.gap[pressing].min(initial=0.0))
    return ComputationError(
        f"contact: the holder ends {back:.3g} m behind where it was drawn, though it is pressed "
        f"on: the contact faces overlap by up to {overlap:.3g} m before any load. Draw the bodies "
        "apart, so that they just touch; or name only the part of each face that is to touch"
    )


def too_steep(system: System, pressure: np.ndarray) -> str | None:
    """Note on contact of faces far from parallel; None if there is none."""
    first, second = (side.face.normals(side.facet, side.t) for side in system.pairing.sides)
    cosine = np.einsum("ni,ni->n", first, second)[pressure > 0].max(initial=-1.0)
    if cosine <= _STEEP:
        return None
    angle = 180 - np.degrees(np.arccos(cosine))
    return (
        f"the contact reaches points where the unloaded faces are inclined by {angle:.0f} degrees "
        "to each other; strains are taken to be small, and from 60 degrees on faces are not paired"
    )

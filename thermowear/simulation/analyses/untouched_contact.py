"""Check for contacts that are open at the end."""

from __future__ import annotations

import numpy as np

from ...errors import ComputationError
from ...results import InterfaceFields
from ..system.system import System


def untouched(system: System, interface: InterfaceFields) -> ComputationError | str | None:
    """Error or note for an analysis that ends without contact. Every rank calls.

    A constant pressing force must be carried, or the computation has failed. A given approach, a
    surface load or a load history may leave the faces apart, and wear may separate them: that is a
    valid result with a note.

    Returns
    -------
    ComputationError, str or None
        Error, note, or None with contact.
    """
    if interface.pressure.max() > 0.0:
        return None
    gap = np.nanmin(interface.gap, initial=np.inf)
    apart = f"; the faces are {1e6 * gap:.4g} µm apart at least" if np.isfinite(gap) else ""
    holder = system.model.holder
    force = holder.force if holder.history is None else None
    if force is None:
        return f"nothing touches at the end{apart}"
    return ComputationError(f"nothing carries the pressing force of {force:.4g} N{apart}")

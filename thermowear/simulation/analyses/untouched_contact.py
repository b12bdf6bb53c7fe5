"""Check for contacts that are open at the end."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...errors import ComputationError
from ..results.outcome import Outcome
from ..system.system import System


def touching(system: System, outcome: Outcome) -> tuple[Outcome, str | None]:
    """Mark an outcome without contact as failed, or return a note on it. Every rank calls.

    A constant pressing force must be carried, or the computation has failed. A given approach, a
    surface load or a load history may leave the faces apart, and wear may separate them: that is a
    valid result with a note.

    Returns
    -------
    outcome : Outcome
    note : str or None
    """
    if outcome.stopped is not None or outcome.contact.pressure.max() > 0.0:
        return outcome, None
    gap = np.nanmin(outcome.interface.gap, initial=np.inf)
    apart = f"; the faces are {1e6 * gap:.4g} µm apart at least" if np.isfinite(gap) else ""
    holder = system.model.holder
    force = holder.force if holder.history is None else None
    if force is None:
        return outcome, f"nothing touches at the end{apart}"
    reason = ComputationError(f"nothing carries the pressing force of {force:.4g} N{apart}")
    return replace(outcome, stopped=reason), None

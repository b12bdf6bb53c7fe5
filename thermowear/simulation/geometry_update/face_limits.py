"""Contacts that reach beyond where the face was meshed for them."""

from __future__ import annotations

import numpy as np

from ..model.system import System


def beyond(system: System) -> tuple[bool, bool]:
    """Whether the first and the last end of the face lie beyond where it is to touch."""
    case, x = system.case, system.pairing.points[:, 0]
    zone = case.geometry.expected_zone(case.pressing())
    if zone is None:
        return False, False
    margin = 1e-6 * (zone[1] - zone[0])
    return bool(x[0] < zone[0] - margin), bool(x[-1] > zone[1] + margin)


def outgrown(system: System, pressure: np.ndarray) -> bool:
    """Whether it presses at an end of the face that should lie beyond the contact."""
    ends = zip(beyond(system), (0, -1), strict=True)
    return any(lies_beyond and pressure[end] > 0 for lies_beyond, end in ends)

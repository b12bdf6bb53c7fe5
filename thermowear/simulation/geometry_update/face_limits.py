"""Limits of the contact zone that the faces are meshed for."""

from __future__ import annotations

import numpy as np

from ..system.system import System


def beyond(system: System) -> tuple[bool, bool]:
    """Test whether the first and the last end of the face lie outside the expected zone."""
    zone, x = system.model.expected_zone, system.pairing.points[:, 0]
    if zone is None:
        return False, False
    margin = 1e-6 * (zone[1] - zone[0])
    return bool(x[0] < zone[0] - margin), bool(x[-1] > zone[1] + margin)


def outgrown(system: System, pressure: np.ndarray) -> bool:
    """True if the contact reaches an end of the face that lies outside the expected zone."""
    ends = zip(beyond(system), (0, -1), strict=True)
    return any(lies_beyond and pressure[end] > 0 for lies_beyond, end in ends)

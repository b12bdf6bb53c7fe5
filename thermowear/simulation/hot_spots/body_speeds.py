"""Velocities of the bodies in a common frame, from their relative motions at the interfaces."""

from __future__ import annotations

import numpy as np

from ...contact.search.contacts import Contacts
from ...errors import CaseError
from ...model.model import Model


def body_speeds(model: Model, contacts: Contacts) -> np.ndarray:
    """Velocity of each body along the waves, shape (n_bodies,) [rad/s, or m/s along a prism].

    Bodies that are not in contact with the first one, also through others, have a frame of their
    own; so has a body whose contacts lead to it in circles, which must agree.

    Raises
    ------
    CaseError
        If the relative motions of a circle of bodies contradict each other.
    """
    speeds = np.full(len(model.bodies), np.nan)
    links = [
        (*interface.bodies, _relative(interface, pairing.points[:, 0], pairing.weights))
        for interface, pairing in zip(model.interfaces, contacts.each, strict=True)
    ]
    links += [(*tie.bodies, 0.0) for tie in model.ties]
    largest = max(abs(speed) for *_, speed in links)
    while np.isnan(speeds).any():
        speeds[int(np.argmax(np.isnan(speeds)))] = 0.0
        _spread(speeds, links)
    for first, second, relative in links:
        if abs(speeds[first] - speeds[second] - relative) > 1e-9 * largest:
            raise CaseError(
                f"motions: {model.bodies[first].name} and {model.bodies[second].name} slide on "
                "each other otherwise than by the motions of the other bodies between them"
            )
    return speeds


def _spread(speeds: np.ndarray, links: list[tuple[int, int, float]]) -> None:
    """Complete the speeds of bodies that are linked to others with known speeds, in place."""
    for _ in range(len(speeds)):
        for first, second, relative in links:
            if np.isnan(speeds[first]) and not np.isnan(speeds[second]):
                speeds[first] = speeds[second] + relative
            elif np.isnan(speeds[second]) and not np.isnan(speeds[first]):
                speeds[second] = speeds[first] - relative


def _relative(interface, radii: np.ndarray, weights: np.ndarray) -> float:
    """Velocity of body 1 relative to body 2; a circumferential one is that at the mean radius."""
    motion = interface.motion
    if motion.at_rest:
        return 0.0
    if motion.angular_velocity is not None:
        return motion.angular_velocity
    assert motion.velocity is not None
    if motion.across:
        return motion.velocity
    return motion.velocity / float(np.average(radii, weights=weights))

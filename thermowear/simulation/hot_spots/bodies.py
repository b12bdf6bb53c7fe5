"""Bodies under waves: velocities in a common frame, and supports."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from dolfinx import fem

from ...bulk.bodies import Bodies
from ...bulk.elasticity.elasticity import pin
from ...bulk.kinematics import Wave
from ...bulk.spaces import Spaces
from ...contact.search.pairing import Contacts
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


Symmetry = Literal["whole", "symmetric", "antisymmetric"]
"""Parity of a mode about the mirror plane of a half model; ``"whole"`` without one."""

Guided = tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]
"""Surfaces on which the first, the second and the third displacement component vanish."""


@dataclass
class FreeMotions:
    """Rigid motions that no support prevents, shifted to zero at single nodes.

    The modes of a stability analysis carry no resultant along them.

    Attributes
    ----------
    fields : list of ndarray, shape (n_owned,)
        Displacement of all bodies in each motion, filled in as the supports are set up.
    """

    fields: list[np.ndarray] = field(default_factory=list)


def antisymmetric(guided: Guided, mirror: tuple[str, ...]) -> Guided:
    """Surfaces by component that vanishes, with antisymmetric modes about the mirror planes.

    Components that vanish there by symmetry are free then, and the others vanish.
    """
    first, second, third = guided
    facing = [set(first) & set(mirror), set(second) & set(mirror)]
    return (
        tuple(s for s in first if s not in mirror) + tuple(facing[1]),
        tuple(s for s in second if s not in mirror) + tuple(facing[0]),
        (*third, *mirror),
    )


def pinning(
    bodies: Bodies, wave: Wave, free: FreeMotions
) -> Callable[[Spaces, list[np.ndarray]], list[np.ndarray]]:
    """Function of the spaces and masks of fixed values that completes these for waves.

    Without a wave the displacement along it vanishes: torsion is not coupled to the contact. Where
    a group of bodies can move freely in a rigid motion, the motion is noted in `free` and single
    values are fixed, which then carry no load.
    """

    def completed(spaces: Spaces, held: list[np.ndarray]) -> list[np.ndarray]:
        fixed = np.concatenate(held)
        if wave.is_uniform:
            fixed[spaces.components - 1 :: spaces.components] = True
        motions = _rigid_motions(spaces.nodes(), wave)
        for members in spaces.groups:
            own = np.zeros(len(fixed), dtype=bool)
            own[spaces.rows(*members)] = True
            free.fields += list(pin(fixed, motions * own[:, None], spaces.comm).T)
        return spaces.split(fixed)

    return completed


def _rigid_motions(nodes: np.ndarray, wave: Wave) -> np.ndarray:
    """Rigid motions of all bodies alike that vary as the wave, shape (n_owned, k)."""
    found = wave.rigid_motions(nodes)
    return np.stack([np.zeros(3 * len(nodes)), *(f.ravel() for f in found.values())], axis=1)[:, 1:]


def surface_values(bodies: Bodies, spaces: Spaces, surfaces: tuple[str, ...]) -> np.ndarray:
    """Mask of the owned values of scalar spaces on surfaces, shape (n_owned,)."""
    fixed = np.zeros(spaces.owned, dtype=bool)
    for body, space, held in zip(bodies.each, spaces.each, spaces.split(fixed), strict=True):
        for surface in surfaces:
            dofs = fem.locate_dofs_topological(space, bodies.dim - 1, body.facets(surface))
            held[dofs[dofs < len(held)]] = True
    return fixed

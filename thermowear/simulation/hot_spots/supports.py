"""Supports of the bodies for waves: planes of symmetry, the axis, and free rigid motions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from dolfinx import fem

from ...bulk.bodies import Bodies
from ...bulk.mechanics.pins import pin
from ...bulk.spaces import Spaces
from ...bulk.waves import Wave

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

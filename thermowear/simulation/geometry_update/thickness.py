"""Thickness of the bodies behind their worn faces."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..system.system import System
from .moving_faces import FaceKey


def thicknesses(system: System, keys: Iterable[FaceKey]) -> list[dict[int, float]]:
    """Thickness behind the worn faces of each interface, by side [m]; every rank calls.

    Faces of one body share it equally, as a disk becomes thinner by the wear of both of its faces.
    """
    bodies = {key: system.contacts.bodies[key[0]][key[1]] for key in keys}
    of_body, found = list(bodies.values()), [dict[int, float]() for _ in system.contacts.each]
    for (index, side), body in bodies.items():
        found[index][side] = _thickness_behind(system, (index, side)) / of_body.count(body)
    return found


def _thickness_behind(system: System, key: FaceKey) -> float:
    """Thickness of a body behind the middle of a contact face [m]; every rank calls."""
    bodies, (index, side) = system.bodies, key
    pairing = system.contacts.each[index]
    out = (pairing.weights @ pairing.normals) * (1 if side == 0 else -1)
    out = out / np.linalg.norm(out)
    middle = np.average(pairing.points, axis=0, weights=pairing.weights)
    mesh = bodies.each[pairing.sides[side].face.body].mesh
    nodes = mesh.geometry.x[:, : len(middle)]
    return max(system.comm.allgather(float(((middle - nodes) @ out).max(initial=0.0))))

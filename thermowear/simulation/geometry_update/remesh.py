"""Remeshing of the bodies of sections: criterion and transfer to the new faces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import scipy

from ...bulk.mesh_motion import serial_extension
from ...contact.faces.face import Face
from ...contact.search.contacts import Contacts
from ...contact.search.pairing import PairedFace, Pairing
from ...errors import ComputationError
from ...geometry.mesh.mixed import block_of
from ...geometry.mesh.tagged import TaggedMesh, quality
from ...geometry.moving.new_face import NewFace
from ...geometry.moving.remeshed import meshed_anew
from ..system.system import System
from ..system.worn_geometry import WornContact, WornGeometry, along
from .moving_faces import FaceKey

Renewed = dict[FaceKey, NewFace]
"""Redivided faces."""
FLOOR = 0.1
"""Smallest acceptable scaled Jacobian."""
_SOFT = 0.25
"""Scaled Jacobian below which remeshing is tried,"""
_WORSE = 0.75
"""and the same as a fraction of that of the new mesh."""


def improved(
    mesh: TaggedMesh,
    parts: tuple[str, ...],
    face: np.ndarray,
    sizes: np.ndarray,
    factor: Callable[[np.ndarray], np.ndarray],
    best: float,
) -> tuple[TaggedMesh, NewFace | None]:
    """Remesh a body if its cells are distorted and the new ones are better.

    Parameters are those of `geometry.moving.remeshed.meshed_anew`, and the smallest scaled Jacobian
    of the body's first mesh.

    Raises
    ------
    ComputationError
        If remeshing fails and the old cells are not acceptable.
    """
    worst = quality(mesh, parts)
    if worst >= max(FLOOR, min(_SOFT, _WORSE * best)):
        return mesh, None
    try:
        anew, divided = meshed_anew(mesh, parts, face, sizes, factor, serial_extension)
    except ComputationError as reason:
        if worst >= FLOOR:
            return mesh, None
        raise ComputationError(f"geometry update: {reason}") from None
    return (anew, divided) if quality(anew, parts) > worst else (mesh, None)


def on_new_faces(worn: WornGeometry, system: System, faces: Renewed) -> WornGeometry:
    """Transfer worn-face data to the remeshed faces.

    Offsets of the new faces from the former ones count as depth lost or gained by the mesh, so that
    the gap is preserved.
    """
    contacts, best = list(worn.contacts), worn.best.copy()
    for (index, side), new in faces.items():
        pairing, interface = system.contacts.each[index], system.model.interfaces[index]
        contacts[index] = _on_new_face(contacts[index], pairing, side, new)
        parts = system.model.bodies[interface.bodies[side]].parts
        best[interface.bodies[side]] = quality(block_of(worn.mesh, *parts), parts)
    return replace(
        worn,
        contacts=tuple(contacts),
        best=best,
        meshed_anew=worn.meshed_anew + len(faces),
    )


def _on_new_face(contact: WornContact, pairing: Pairing, index: int, new: NewFace) -> WornContact:
    """Data of an interface one of whose faces, by side, has been remeshed."""
    side, at, depth = pairing.sides[index], contact.at, contact.depth.copy()
    assert isinstance(side.face, Face)
    depth[index] += _behind_former(side, new)
    if index == 0:
        at = new.at(along(pairing))
    carried = new.carried(contact.directions[index])
    held = np.zeros(len(carried), dtype=bool)
    held[[0, -1]] = contact.held[index][[0, -1]]
    directions = carried / np.linalg.norm(carried, axis=1, keepdims=True)
    return replace(
        contact,
        directions=_exchanged(contact.directions, index, directions),
        held=_exchanged(contact.held, index, held),
        sizes=_exchanged(contact.sizes, index, new.sizes),
        at=at,
        depth=depth,
        renewed=contact.renewed | {index: new},
    )


def _exchanged(pair: tuple[np.ndarray, ...], index: int, new: np.ndarray) -> tuple[np.ndarray, ...]:
    """Values of both sides with new ones of one of them."""
    return tuple(new if side == index else values for side, values in enumerate(pair))


def carrying_error(worn: WornGeometry, contacts: Contacts) -> float:
    """Round-trip error of depths carried over to new pairings, relative to the largest."""
    each = zip(worn.contacts, contacts.each, strict=True)
    return max(_carrying_error(one, pairing) for one, pairing in each if one.renewed)


def _carrying_error(worn: WornContact, pairing: Pairing) -> float:
    there = worn.carried(worn.depth, pairing)
    back = scipy.interpolate.Akima1DInterpolator(along(pairing), there, axis=-1, method="makima")
    after = np.clip(worn.at, *along(pairing)[[0, -1]])
    return float(np.abs(back(after) - worn.depth).max() / np.abs(worn.depth).max())


def _behind_former(side: PairedFace, new: NewFace) -> np.ndarray:
    """Offset of the curve of a new face behind points of the former face, shape (n,) [m]."""
    assert isinstance(side.face, Face)
    former = replace(side.face, nodes=new.former)
    out = former.normals(side.facet, side.t)
    to = new.on_curve(new.at(side.facet + side.t)) - former.points(side.facet, side.t)
    return -np.einsum("ni,ni->n", to, out)

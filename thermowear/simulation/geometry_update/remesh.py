"""Remeshing of the bodies of a section: criterion and transfer to the new faces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import scipy

from ...bulk.mesh_motion import serial_extension
from ...contact.search.face import Face
from ...contact.search.pairing import PairedFace, Pairing
from ...errors import ComputationError
from ...geometry.mesh.mixed import block_of
from ...geometry.mesh.tagged import TaggedMesh, quality
from ...geometry.moving.new_face import NewFace
from ...geometry.moving.remeshed import meshed_anew
from ..system.system import System
from ..system.worn_geometry import WornGeometry, along

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


def on_new_faces(worn: WornGeometry, system: System, faces: dict[int, NewFace]) -> WornGeometry:
    """Transfer worn-face data to the remeshed faces, by index of the body.

    Offsets of the new faces from the former ones count as depth lost or gained by the mesh, so that
    the gap is preserved.
    """
    directions, held, sizes = (list(pair) for pair in (worn.directions, worn.held, worn.sizes))
    best = worn.best.copy()
    depth, at, bodies = worn.depth.copy(), worn.at, system.model.bodies
    for index, new in faces.items():
        side = system.pairing.sides[index]
        assert isinstance(side.face, Face)
        depth[index] += _behind_former(side, new)
        if index == 0:
            at = new.at(along(system.pairing))
        carried = new.carried(worn.directions[index])
        directions[index] = carried / np.linalg.norm(carried, axis=1, keepdims=True)
        held[index] = np.zeros(len(carried), dtype=bool)
        held[index][[0, -1]] = worn.held[index][[0, -1]]
        sizes[index] = new.sizes
        parts = bodies[index].parts
        best[index] = quality(block_of(worn.mesh, *parts), parts)
    return replace(
        worn,
        directions=tuple(directions),
        held=tuple(held),
        sizes=tuple(sizes),
        best=best,
        at=at,
        depth=depth,
        renewed=faces,
        meshed_anew=worn.meshed_anew + len(faces),
    )


def carrying_error(worn: WornGeometry, pairing: Pairing) -> float:
    """Round-trip error of depths carried over to a pairing, relative to the largest."""
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

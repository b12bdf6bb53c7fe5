"""Rigid motions of a body that its supports leave free."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...errors import CaseError
from .mixed import AnyMesh
from .tagged import TaggedMesh

_NAMES = {
    2: ("along x", "along y", "about z"),
    3: ("along x", "along y", "along z", "about x", "about y", "about z"),
}
"""Rigid motions by dimension: translations, then rotations."""
_NONE = 1e-12
"""Largest stiffness against a free motion, relative to that against the best held one."""


def free_motions(
    mesh: AnyMesh, parts: Sequence[str], clamped: Sequence[str], guided: Sequence[Sequence[str]]
) -> list[str]:
    """Names of the rigid motions of a body, or of glued ones, that are free, alone or with others.

    Springs of equal stiffness are thought at the held components of the nodes: a motion that does
    not deform any of them is free.

    Parameters
    ----------
    mesh : TaggedMesh or MixedMesh
        Of a section or in space.
    parts : sequence of str
        Parts of the body, or of all bodies that are glued to each other.
    clamped : sequence of str
        Surfaces, of any body, fixed in all directions.
    guided : sequence of sequences of str
        Surfaces fixed in the first, the second (and the third) direction.
    """
    dim = mesh.blocks[0].points.shape[1]
    each = [_held(mesh, parts, (*clamped, *guided[axis])) for axis in range(dim)]
    held = np.concatenate(each)
    if not len(held):
        return list(_NAMES[dim])
    middle, size = held.mean(axis=0), np.ptp(held, axis=0).max() or 1.0
    rows = [_motions((points - middle) / size)[:, axis] for axis, points in enumerate(each)]
    springs = np.concatenate(rows)
    values, modes = np.linalg.eigh(springs.T @ springs)
    free = modes[:, values < _NONE * values.max()]
    # components of the projection of each motion on the free ones
    share = np.einsum("ij,ij->i", free, free)
    return [name for name, part in zip(_NAMES[dim], share, strict=True) if part > _NONE]


def check_held(body: str, free: Sequence[str]) -> None:
    """Reject a body with free rigid motions: its stiffness would be singular.

    Raises
    ------
    CaseError
    """
    if free:
        *others, last = free
        motions = f"{', '.join(others)} and {last}" if others else last
        raise CaseError(
            f"Body {body!r}: its supports leave it free to move {motions}; clamp one of its "
            "surfaces, or add planes of symmetry"
        )


def _held(mesh: AnyMesh, parts: Sequence[str], surfaces: Sequence[str]) -> np.ndarray:
    """Points of parts on any of some surfaces, shape (n, dim) [m]."""
    return np.concatenate([block.points[_nodes(block, parts, surfaces)] for block in mesh.blocks])


def _nodes(block: TaggedMesh, parts: Sequence[str], surfaces: Sequence[str]) -> np.ndarray:
    """Nodes of parts on any of some surfaces."""
    own, on_them = np.zeros((2, len(block.points)), dtype=bool)
    tags = [block.bodies.index(part) + 1 for part in parts]
    own[block.cells[np.isin(block.cell_tags, tags)]] = True
    for surface in surfaces:
        on_them[block.facets_of(surface)] = True
    return np.flatnonzero(own & on_them)


def _motions(points: np.ndarray) -> np.ndarray:
    """Displacements of points (n, dim) in all rigid motions, shape (n, dim, n_motions)."""
    count, dim = points.shape
    in_space = np.column_stack([points, np.zeros((count, 3 - dim))])
    axes = np.eye(3)[-1:] if dim == 2 else np.eye(3)
    turns = [np.cross(axis, in_space)[:, :dim] for axis in axes]
    moves = [np.broadcast_to(axis, (count, dim)) for axis in np.eye(dim)]
    return np.stack([*moves, *turns], axis=2)

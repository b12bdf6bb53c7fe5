"""A body whose contact face is moved to a worn shape; its sides end on it, its inside follows."""

from __future__ import annotations

import numpy as np

from ..mesh.tagged import TaggedMesh
from ..moving.moved import MovableBody
from .design import Design
from .outline import loops

_ALONG = 0.2
"""Least cosine between a side and the normal of the face at which the face's end slides on it."""


def moved_body(mesh: TaggedMesh, design: Design, face: str) -> np.ndarray:
    """Where the nodes of a body are when its contact face has a worn shape.

    In a plane as in `moved`; in space the body is a prism on its face, z upwards, whose nodes sink
    the less the higher they are.

    Parameters
    ----------
    mesh : TaggedMesh
        Of one body.
    design : Design
    face : str
        Name of its contact face.

    Returns
    -------
    ndarray, shape (n_points, gdim) [m]
    """
    points = mesh.points
    if points.shape[1] == 3:
        low, high = points[:, 2].min(), points[:, 2].max()
        foot = np.column_stack([points[:, :2], np.full(len(points), low)])
        return points + offsets(design, foot) * ((high - points[:, 2]) / (high - low))[:, None]
    (piece,) = (piece for pieces in loops(mesh, face) for piece in pieces if piece.is_face)
    on_face = points[piece.nodes]
    body = MovableBody(mesh, mesh.bodies, on_face)
    ends = [
        slide(design, *points[side.nodes[:2]]) if side.is_corner else None for side in body.sides
    ]
    return body.followed(body.outlined(face_motion(design, on_face, ends)))


def offsets(design: Design, points: np.ndarray) -> np.ndarray:
    """From points (n, gdim) of the unworn face to the worn one, along the normal [m]."""
    return -design.depth_at(points)[:, None] * design.normals_at(points)


def slide(design: Design, corner: np.ndarray, side: np.ndarray) -> np.ndarray | None:
    """How far an end of the face moves along a side until it is as deep as the face, shape (2,).

    None where the side goes on along the face.

    Parameters
    ----------
    design : Design
    corner, side : ndarray, shape (2,)
        The end, and the next point of the side [m].
    """
    along = (side - corner) / np.linalg.norm(side - corner)
    down = -float(along @ design.normals_at(corner[None])[0])
    return along * design.depth_at(corner[None])[0] / down if down > _ALONG else None


def face_motion(design: Design, points: np.ndarray, ends: list[np.ndarray | None]) -> np.ndarray:
    """How far points of a plane face move, in order along it, shape (n, 2) [m].

    To their depth along the normal, and along the face as its ends do, the less the farther off.

    Parameters
    ----------
    design : Design
    points : ndarray, shape (n, 2)
    ends : list of ndarray or None
        How far the first and the last point are to move; None: along the normal.
    """
    motion, normals = offsets(design, points), design.normals_at(points)
    tangents = np.column_stack([-normals[:, 1], normals[:, 0]])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    share = np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
    for k, near, end in ((0, 1.0 - share, ends[0]), (-1, share, ends[1])):
        if end is not None:
            motion = motion + (near * float((end - motion[k]) @ tangents[k]))[:, None] * tangents
    return motion

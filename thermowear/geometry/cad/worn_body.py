"""Mesh of a body with a worn contact face: motion of face, sides and interior; its export."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from ..mesh.nodes import chord_lengths
from ..mesh.tagged import TaggedMesh, compact, quadratic
from ..moving.moved import Extension, MovableBody
from ..moving.moved_solid import MovableSolid
from ..moving.outline import loops
from ..reading.export import write_mesh
from .design import Design

_ALONG = 0.2
"""Least cosine between a side and the face normal for which the end of the face slides along it."""


def moved_body(mesh: TaggedMesh, design: Design, face: str, extension: Extension) -> np.ndarray:
    """Nodes of a body after its contact face has been moved to a worn shape.

    Plane bodies as in `moving.moved`, bodies of tetrahedra as in `moving.moved_solid`; one of
    hexahedra is a prism on its face, z upwards, whose nodal displacement decreases linearly with
    height.

    Parameters
    ----------
    mesh : TaggedMesh
        Mesh of one body.
    design : Design
    face : str
        Name of its contact face.
    extension : callable
        Factory of harmonic extensions, for the interior nodes.

    Returns
    -------
    ndarray, shape (n_points, gdim) [m]
    """
    points = mesh.points
    if mesh.cell_type == "tetrahedron":
        return points + _sunk(mesh, design, face, extension)
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
    follow = extension(mesh, mesh.cell_type, mesh.cells, None)
    return points + follow(body.outlined(face_motion(design, on_face, ends)))


def _sunk(mesh: TaggedMesh, design: Design, face: str, extension: Extension) -> np.ndarray:
    """Displacement of the nodes of a body of tetrahedra, shape (n_points, 3) [m]."""
    on_face = mesh.points[np.unique(mesh.facets_of(face))]
    body = MovableSolid(mesh, mesh.bodies, on_face, extension)
    normals = design.normals_at(mesh.points[body.face])
    paths, held = body.motion_paths(normals)
    depth = np.where(held, 0.0, design.depth_at(mesh.points[body.face]))
    along = np.einsum("ni,ni->n", paths, normals)
    outlined = body.outlined(-(depth / along)[:, None] * paths)
    return extension(mesh, mesh.cell_type, mesh.cells, None)(outlined)


def only_body(mesh: TaggedMesh, parts: tuple[str, ...]) -> TaggedMesh:
    """Mesh of one body, with its surfaces.

    Parameters
    ----------
    mesh : TaggedMesh
    parts : tuple of str
        Names of the body and its zones.
    """
    tags = sorted(mesh.tags_of(part for part in parts if part in mesh.bodies))
    cells = np.isin(mesh.cell_tags, tags)
    has = np.zeros(len(mesh.points), dtype=bool)
    has[mesh.cells[cells]] = True
    facets = has[mesh.facets].all(axis=1)
    marks, facet_tags = np.unique(mesh.facet_tags[facets], return_inverse=True)
    return compact(
        replace(
            mesh,
            cells=mesh.cells[cells],
            cell_tags=(np.searchsorted(tags, mesh.cell_tags[cells]) + 1).astype(np.int32),
            facets=mesh.facets[facets],
            facet_tags=(facet_tags + 1).astype(np.int32),
            bodies=tuple(mesh.bodies[tag - 1] for tag in tags),
            surfaces=tuple(mesh.surfaces[mark - 1] for mark in marks),
        )
    )


def offsets(design: Design, points: np.ndarray) -> np.ndarray:
    """Displacement of points (n, gdim) of the unworn face to the worn one, along the normal [m]."""
    return -design.depth_at(points)[:, None] * design.normals_at(points)


def slide(design: Design, corner: np.ndarray, side: np.ndarray) -> np.ndarray | None:
    """Displacement of an end of the face along the adjacent side to the worn depth, shape (2,) [m].

    None if the side continues the face tangentially.

    Parameters
    ----------
    design : Design
    corner, side : ndarray, shape (2,)
        End of the face, and the next point of the side [m].
    """
    along = (side - corner) / np.linalg.norm(side - corner)
    down = -float(along @ design.normals_at(corner[None])[0])
    return along * design.depth_at(corner[None])[0] / down if down > _ALONG else None


def face_motion(design: Design, points: np.ndarray, ends: list[np.ndarray | None]) -> np.ndarray:
    """Displacement of points along a plane face, shape (n, 2) [m].

    Normal to the face by the depth; tangential by linear interpolation between the ends.

    Parameters
    ----------
    design : Design
    points : ndarray, shape (n, 2)
    ends : list of ndarray or None
        Displacement of the first and the last point; None: along the normal.
    """
    motion, normals = offsets(design, points), design.normals_at(points)
    tangents = np.column_stack([-normals[:, 1], normals[:, 0]])
    share = chord_lengths(points) / chord_lengths(points)[-1]
    for k, near, end in ((0, 1.0 - share, ends[0]), (-1, share, ends[1])):
        if end is not None:
            motion = motion + (near * float((end - motion[k]) @ tangents[k]))[:, None] * tangents
    return motion


def write_design_mesh(
    mesh: TaggedMesh, design: Design, face: str, path: Path, extension: Extension
) -> None:
    """Write the mesh of a body whose contact face has a worn shape.

    Straight-sided cells become quadratic to follow the shape; .vtu supports no higher order.
    ``displacement_m`` holds the displacement of the nodes.

    Parameters
    ----------
    mesh : TaggedMesh
        Mesh of the unworn body.
    design : Design
    face : str
        Name of its contact face.
    path : Path
    extension : callable
        Factory of harmonic extensions, see `moved_body`.

    Raises
    ------
    CaseError
        If the file cannot be written.
    """
    if mesh.order == 1 or (path.suffix == ".vtu" and mesh.order > 2):
        mesh = quadratic(mesh)
    points = moved_body(mesh, design, face, extension)
    displacement = np.pad(points - mesh.points, ((0, 0), (0, 3 - points.shape[1])))
    write_mesh(replace(mesh, points=points), path, {"displacement_m": displacement})

"""Checks of the named bodies and surfaces of a mesh file in space."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...case.tables.geometry import Geometry
from ...errors import CaseError, note
from ..mesh.held import check_held, free_motions
from ..mesh.mixed import AnyMesh, block_of, block_with
from ..mesh.nodes import boundary, components, meeting, numbered
from ..mesh.tagged import TaggedMesh
from .mesh_checks import LEVEL, has_any, length, on_surface, whole_bodies
from .solid_checks import CORNERS, at, node_links

_FLUSH = 0.95
"""Least cosine of the angle between facets on both sides of the rim of a hole in one surface."""
PLANES = {"symmetry": 0, "rollers": 1, "mid_plane": 2}
"""Keys of surfaces on planes, and the coordinate that is constant there."""
_CUTS_BOTH = ("symmetry", "rollers")
"""Keys of planes that cut both bodies."""


def check_solid_mesh(mesh: AnyMesh, geometry: Geometry) -> None:
    """Check the named bodies and surfaces of a mesh; note holes in contact faces.

    Raises
    ------
    CaseError
        If surfaces share facets, a contact face branches, a piece of a body is not held, a surface
        of symmetry or on rollers does not lie in a plane, or a body is free to move.
    """
    mesh = whole_bodies(mesh, geometry)
    for block in mesh.blocks:
        check_shared_facets(block)
    for index, surface in enumerate(geometry.contact):
        check_solid_face(block_with(mesh, surface), surface, index, "geometry.contact")
    for body, surface in zip(geometry.bodies, (geometry.held, geometry.fixed), strict=True):
        check_solid_pieces(block_of(mesh, body), body, [surface])
    for key, axis in PLANES.items():
        for surface in getattr(geometry, key):
            check_plane(mesh, mesh.points, f"geometry.{key}", surface, axis)
    _check_supports(mesh, geometry)
    for key in _CUTS_BOTH:
        if getattr(geometry, key):
            _check_both_cut(mesh, key, getattr(geometry, key))


def facet_corners(mesh: TaggedMesh, facets: np.ndarray) -> np.ndarray:
    """Corners of facets, shape (n, 3 or 4)."""
    return facets[:, : 3 if mesh.facet_type == "triangle" else 4]


def check_shared_facets(mesh: TaggedMesh) -> None:
    """Reject facets with more than one surface name."""
    corners = facet_corners(mesh, mesh.facets)
    number, count = numbered(corners)
    double = count[number] > 1
    if double.any():
        same = np.flatnonzero(number == number[np.argmax(double)])
        one, two = (mesh.surfaces[mesh.facet_tags[k] - 1] for k in same[:2])
        raise CaseError(
            f"geometry.surfaces: {one!r} and {two!r} share {np.count_nonzero(count > 1)} facets of "
            f"the mesh, one {at(mesh.points[corners[same[0]]])}; a facet can belong to one surface "
            "only"
        )


def _edges(corners: np.ndarray) -> np.ndarray:
    """Ends of the edges of facets, facet by facet, shape (n * n_corners, 2)."""
    return np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)


def check_solid_face(mesh: TaggedMesh, surface: str, body: int, path: str) -> None:
    """Reject a branched contact face; note holes in it that lie in the same surface of the body.

    Parameters
    ----------
    mesh : TaggedMesh
    surface : str
    body : int
        Index of its body.
    path : str
        Key that names the face, for messages.
    """
    corners = facet_corners(mesh, mesh.facets_of(surface))
    edges = _edges(corners)
    number, count = numbered(edges)
    branched = count[number] > 2
    if branched.any():
        raise CaseError(
            f"{path}: {surface!r} branches {at(mesh.points[edges[np.argmax(branched)]])};"
            " an edge of a contact face has at most two facets"
        )
    rim = np.flatnonzero(count[number] == 1)
    if not len(rim):
        return
    label = components(edges[rim], len(mesh.points))[edges[rim, 0]]
    loops = [rim[label == loop] for loop in np.unique(label)]
    sizes = [np.ptp(mesh.points[edges[loop].ravel()], axis=0) for loop in loops]
    outer = int(np.argmax([np.linalg.norm(size) for size in sizes]))
    inner = [k for k in range(len(loops)) if k != outer]
    flush = _flush(mesh, corners, edges, rim, body) if inner else np.empty(0)
    for k in inner:
        if flush[np.isin(rim, loops[k])].all():
            lengths = " by ".join(length(x) for x in np.sort(sizes[k])[:0:-1])
            note(
                f"{path}: {surface!r} has a hole of {lengths} "
                f"{at(mesh.points[edges[loops[k], 0]])}: its facets are in no named surface, and "
                "have no contact"
            )


def _flush(
    mesh: TaggedMesh, corners: np.ndarray, edges: np.ndarray, rim: np.ndarray, body: int
) -> np.ndarray:
    """Mask of rim edges beyond which an unnamed facet of the body continues the surface."""
    nodes = np.zeros(len(mesh.points), dtype=bool)
    nodes[edges[rim]] = True
    kind = mesh.cell_type
    cells = mesh.cells[mesh.cell_tags == body + 1][:, : CORNERS[kind]]
    around = boundary(kind, 1, cells[nodes[cells].any(axis=1)])
    around = around[nodes[around].sum(axis=1) >= 2]
    named = facet_corners(mesh, mesh.facets)
    number, _ = numbered(np.concatenate([around, named]))
    around = around[~np.isin(number[: len(around)], number[len(around) :])]
    sides = corners.shape[1]
    pairs = meeting(np.concatenate([edges[rim], _edges(around)]))
    pairs = pairs[(pairs[:, 0] < len(rim)) & (pairs[:, 1] >= len(rim))]
    inside = _normals(mesh, corners[rim[pairs[:, 0]] // sides])
    beyond = _normals(mesh, around[(pairs[:, 1] - len(rim)) // sides])
    result = np.zeros(len(rim), dtype=bool)
    result[pairs[:, 0]] = np.einsum("ni,ni->n", inside, beyond) > _FLUSH
    return result


def _normals(mesh: TaggedMesh, corners: np.ndarray) -> np.ndarray:
    """Unit normals of facets at their first corner, shape (n, 3)."""
    x = mesh.points[corners]
    normals = np.cross(x[:, 1] - x[:, 0], x[:, -1] - x[:, 0])
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def check_solid_pieces(mesh: TaggedMesh, body: str, surfaces: Sequence[str]) -> None:
    """Check that every piece of a body has part of the surfaces that hold it."""
    cells = mesh.cells[mesh.cell_tags == mesh.bodies.index(body) + 1][:, : CORNERS[mesh.cell_type]]
    label = components(node_links(cells), len(mesh.points))
    of_cells = label[cells[:, 0]]
    pieces = np.unique(of_cells)
    corners = [facet_corners(mesh, mesh.facets_of(surface)) for surface in surfaces]
    held, by = label[np.concatenate(corners)], " or ".join(map(repr, surfaces))
    loose = np.isin(of_cells, held, invert=True)
    if loose.any():
        raise CaseError(
            f"geometry.path: {loose.sum()} of {len(cells)} cells of {body!r} are not joined to "
            f"those held at {by}, one {at(mesh.points[cells[np.argmax(loose)]])}; a body "
            "must be in one piece"
        )
    if len(pieces) > 1:
        note(f"geometry.path: {body!r} has {len(pieces)} pieces, all held by {by}")


def check_plane(mesh: AnyMesh, points: np.ndarray, path: str, surface: str, axis: int) -> None:
    """Check that a surface lies in a plane x, y or z = const, with its bodies on one side.

    Parameters
    ----------
    mesh : TaggedMesh or MixedMesh
    points : ndarray, shape (n, gdim)
        Nodes of these bodies [m].
    path : str
        Key that names the surface, for messages.
    surface : str
    axis : int
        Index of the constant coordinate.

    Raises
    ------
    CaseError
    """
    letter, size = "xyz"[axis], np.ptp(points, axis=0).max()
    level = on_surface(mesh, surface)[:, axis]
    if np.ptp(level) > LEVEL * size:
        raise CaseError(
            f"{path}: {surface!r} does not lie in a plane {letter} = const; it ranges from"
            f" {letter} = {level.min():.6g} to {level.max():.6g} m"
        )
    beyond = points[:, axis] - level.mean()
    if min(beyond.max(), -beyond.min()) > LEVEL * size:
        raise CaseError(
            f"{path}: the bodies lie on both sides of the plane of {surface!r}, "
            f"{letter} = {level.mean():.6g} m"
        )


def _check_supports(mesh: AnyMesh, geometry: Geometry) -> None:
    """Reject a body that its supports leave free to move."""
    guided = [getattr(geometry, key) for key in PLANES]
    smooth = {name for names in guided for name in names}
    clamped = [name for name in (geometry.held, geometry.fixed) if name not in smooth]
    for body in geometry.bodies:
        check_held(body, free_motions(mesh, [body], clamped, guided))


def _check_both_cut(mesh: AnyMesh, key: str, names: tuple[str, ...]) -> None:
    """Check that each body has a surface on one of the planes of a key."""
    for body in mesh.bodies:
        if not has_any(mesh, body, names):
            raise CaseError(
                f"geometry.{key}: no surface of {body!r} is listed; each body needs one"
            )

"""Checks of the bodies and named surfaces of a mesh file against the case."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy

from ...case.tables.geometry import Geometry
from ...errors import CaseError, note
from ..mesh.tagged import TaggedMesh

_LEVEL = 1e-6
"""Tolerance for nodes on a plane of symmetry, relative to the size of the bodies."""


def check_mesh(mesh: TaggedMesh, geometry: Geometry, model: str) -> None:
    """Check the named bodies and surfaces of a mesh.

    Raises
    ------
    CaseError
        If surfaces share edges, a contact face is not one curve, a piece of a body is not held, or
        a surface of symmetry does not lie in a plane x = const.
    """
    mesh = whole_bodies(mesh, geometry)
    _check_shared_edges(mesh)
    for surface in geometry.contact:
        _check_one_curve(_ends(mesh, surface), surface)
    for body, surface in zip(geometry.bodies, (geometry.held, geometry.fixed), strict=True):
        _check_pieces_held(mesh, body, surface)
    if geometry.symmetry:
        if model == "axisymmetric":
            raise CaseError("geometry.half: an axisymmetric model has no plane of symmetry")
        _symmetry(mesh, geometry)


def whole_bodies(mesh: TaggedMesh, geometry: Geometry) -> TaggedMesh:
    """Mesh with the cells of each body under one tag, those of its cell sets included."""
    tags = np.zeros_like(mesh.cell_tags)
    for number, body in enumerate(geometry.bodies, start=1):
        parts = [mesh.bodies.index(part) + 1 for part in geometry.parts_of(body)]
        tags[np.isin(mesh.cell_tags, parts)] = number
    return replace(mesh, cell_tags=tags, bodies=geometry.bodies)


def described(mesh: TaggedMesh) -> list[str]:
    """Size and number of cells of each body, as short text."""
    lines = []
    for tag, body in enumerate(mesh.bodies, start=1):
        cells = mesh.cells[mesh.cell_tags == tag]
        size = " by ".join(length(x) for x in np.ptp(mesh.points[np.unique(cells)], axis=0))
        lines.append(f"{body} {size} with {len(cells)} cells")
    return lines


def length(value: float) -> str:
    """Length in millimetres or micrometres."""
    return f"{1e3 * value:.4g} mm" if abs(value) >= 1e-4 else f"{1e6 * value:.4g} µm"


def _ends(mesh: TaggedMesh, surface: str) -> np.ndarray:
    """Nodes at both ends of the edges of a surface, shape (n, 2)."""
    return mesh.facets[mesh.facet_tags == mesh.surfaces.index(surface) + 1][:, :2]


def _check_shared_edges(mesh: TaggedMesh) -> None:
    """Reject edges with more than one surface name."""
    edges = np.sort(mesh.facets[:, :2], axis=1)
    _, first, edge = np.unique(edges, axis=0, return_index=True, return_inverse=True)
    other = np.flatnonzero(first[edge.ravel()] != np.arange(len(edges)))
    if len(other):
        one, two = (
            mesh.surfaces[mesh.facet_tags[k] - 1] for k in (first[edge.ravel()[other[0]]], other[0])
        )
        raise CaseError(
            f"geometry.surfaces: {one!r} and {two!r} share {len(other)} edges of the mesh; an edge "
            "can belong to one surface only"
        )


def _check_one_curve(ends: np.ndarray, surface: str) -> None:
    """Check that a contact face is one curve, open or closed."""
    nodes, compact, count = np.unique(ends, return_inverse=True, return_counts=True)
    pairs = compact.reshape(ends.shape)
    links = scipy.sparse.coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(nodes), len(nodes)))
    parts, _ = scipy.sparse.csgraph.connected_components(links, directed=False)
    if parts > 1 or count.max() > 2:
        raise CaseError(
            f"geometry.contact: the edges of {surface!r} are in {parts} pieces; a contact "
            "face must be "
            "one curve without branches"
        )


def _check_pieces_held(mesh: TaggedMesh, body: str, surface: str) -> None:
    """Check that every piece of a body has part of the surface that holds it."""
    cells = mesh.cells[mesh.cell_tags == mesh.bodies.index(body) + 1]
    rows, columns = np.repeat(cells[:, 0], cells.shape[1]), cells.ravel()
    links = scipy.sparse.coo_matrix(
        (np.ones(len(rows)), (rows, columns)), shape=(len(mesh.points),) * 2
    )
    _, label = scipy.sparse.csgraph.connected_components(links, directed=False)
    pieces = np.unique(label[cells[:, 0]])
    held = np.unique(label[_ends(mesh, surface)])
    loose = np.setdiff1d(pieces, held)
    if len(loose):
        count = np.count_nonzero(np.isin(label[cells[:, 0]], loose))
        raise CaseError(
            f"geometry.path: {count} of {len(cells)} cells of {body!r} are not joined to those "
            f"held at {surface!r}; a body must be in one piece"
        )
    if len(pieces) > 1:
        note(f"geometry.path: {body!r} has {len(pieces)} pieces, all held by {surface!r}")


def _symmetry(mesh: TaggedMesh, geometry: Geometry) -> None:
    """Check that surfaces of symmetry lie in one plane x = const, with the bodies on one side."""
    size = np.ptp(mesh.points, axis=0).max()
    planes = {name: mesh.points[np.unique(_ends(mesh, name)), 0] for name in geometry.symmetry}
    for name, x in planes.items():
        if np.ptp(x) > _LEVEL * size:
            raise CaseError(
                f"geometry.symmetry: {name!r} does not lie in a plane x = const; it ranges from "
                f"x = {x.min():.6g} to {x.max():.6g} m"
            )
    every = np.concatenate(list(planes.values()))
    if np.ptp(every) > _LEVEL * size:
        raise CaseError(
            f"geometry.symmetry: the surfaces lie in different planes, x = {every.min():.6g} and "
            f"{every.max():.6g} m"
        )
    beyond = mesh.points[:, 0] - every.mean()
    if min(beyond.max(), -beyond.min()) > _LEVEL * size:
        raise CaseError(
            f"geometry.half: the bodies lie on both sides of the plane of symmetry "
            f"x = {every.mean():.6g} m; a half model lies on one side"
        )
    on_plane = np.unique(np.concatenate([_ends(mesh, name).ravel() for name in geometry.symmetry]))
    for tag, body in enumerate(mesh.bodies, start=1):
        if not np.isin(mesh.cells[mesh.cell_tags == tag], on_plane).any():
            raise CaseError(
                f"geometry.symmetry: no surface of {body!r} is listed; each body needs one"
            )

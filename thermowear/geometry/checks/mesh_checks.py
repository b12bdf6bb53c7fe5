"""Checks of the cells, bodies and named surfaces of a mesh file.

A mesh is valid if no edge has more than two cells, cells that share an edge lie on both sides of
it, and the map from the unit cell to each cell preserves orientation everywhere (det J > 0).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy

from ...case.assembly.geometry import AssemblyGeometry
from ...case.tables.geometry import Geometry
from ...errors import CaseError, note
from ..mesh.curved import Curving, curving
from ..mesh.mixed import AnyMesh, block_of, block_with, retagged
from ..mesh.nodes import CORNERS, boundary, components, meeting, numbered, turned
from ..mesh.tagged import TaggedMesh, jacobians

_FLAT = 1e-8
"""Sine of the angle between grid lines below which a cell is degenerate."""
_SAME = 1e-7
"""Distance relative to the size of a body below which nodes coincide."""
_LARGE = 2.0
"""Size of a body above which a note is issued [m]."""
_NO_PRESSURE = 1.0
"""Mean pressure below which a note is issued [Pa]."""
_CHORDS = 0.01
"""Distance of chords from arcs relative to the depth that a load closes; a note is issued above."""
AnyMeshed = Geometry | AssemblyGeometry
"""Geometry of two bodies, or of several."""
LEVEL = 1e-6
"""Tolerance for nodes on a plane of symmetry, relative to the size of the bodies."""


def oriented(points: np.ndarray, cells: np.ndarray, kind: str, order: int, body: str) -> np.ndarray:
    """Cells of a body with their nodes counter-clockwise.

    Cells may be listed in either orientation, which is found from shared edges instead of signed
    areas, as a tangled mesh has areas of both signs.

    Parameters
    ----------
    points : ndarray, shape (n, 2) [m]
    cells : ndarray of int, shape (n_cells, nodes_per_cell)
    kind, order : str, int
    body : str
        Name of the body in the case, for messages.

    Raises
    ------
    CaseError
        If the mesh is invalid.
    """
    reversed_, piece = _sides(points, cells[:, : CORNERS[kind]], body)
    signs = np.where(reversed_, -1.0, 1.0)
    # dense enough to bound det J, a polynomial; the extrema of straight cells are at corners
    least, most, areas = jacobians(kind, order, points[cells], 4 * order - 2)
    least, most = np.where(reversed_, -most, least), np.where(reversed_, -least, most)
    mirrored = (np.bincount(piece, signs * areas) < 0)[piece]
    worst = np.where(mirrored, -most, least)
    tangled = ~(worst > _FLAT)
    if tangled.any():
        raise CaseError(
            f"geometry.path: {tangled.sum()} of {len(cells)} cells of {body!r} are tangled or flat "
            f"(det J <= 0), one {_position_text(points[cells[np.argmax(tangled)]])}"
        )
    turn = reversed_ ^ mirrored
    cells = cells.copy()
    cells[turn] = cells[turn][:, turned(kind, order)]
    _check_conforming(points, boundary(kind, order, cells), body)
    return cells


def _sides(points: np.ndarray, corners: np.ndarray, body: str) -> tuple[np.ndarray, np.ndarray]:
    """Mask of cells oriented oppositely to the cells they are joined to, and connected pieces.

    Two cells that share an edge traverse it in opposite directions. Each cell has two nodes in a
    graph, one per orientation; a connected component holds consistent orientations.
    """
    count, sides = corners.shape
    ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
    cell = np.repeat(np.arange(count), sides)
    ascending = ends[:, 0] < ends[:, 1]
    edge, number = numbered(ends)
    if number.max() > 2:
        wrong = number[edge] > 2
        raise CaseError(
            f"geometry.path: {np.count_nonzero(number > 2)} edges of {body!r} have three or more "
            f"cells, one {_position_text(points[ends[np.argmax(wrong)]])}"
        )
    shared = meeting(ends)
    (one, other), same = cell[shared].T, ascending[shared[:, 0]] == ascending[shared[:, 1]]
    links = np.concatenate(
        [
            np.stack([one, other + count * same], 1),
            np.stack([one + count, other + count * ~same], 1),
        ]
    )
    as_listed, turned_round = components(links, 2 * count).reshape(2, count)
    if np.any(as_listed == turned_round):
        raise CaseError(
            f"geometry.path: the cells of {body!r} cannot be oriented consistently in a plane"
        )
    _, piece = np.unique(np.minimum(as_listed, turned_round), return_inverse=True)
    return as_listed > turned_round, piece.ravel()


def _check_conforming(points: np.ndarray, edges: np.ndarray, body: str) -> None:
    """Reject adjacent cells with duplicate nodes, or joined at a corner only."""
    ends = points[edges[:, :2]]
    near = _SAME * np.ptp(ends.reshape(-1, 2), axis=0).max()
    pairs = scipy.spatial.cKDTree(ends.mean(axis=1)).query_pairs(near, output_type="ndarray")
    one, other = ends[pairs[:, 0]], ends[pairs[:, 1]]
    apart = np.minimum(np.abs(one - other).max((1, 2)), np.abs(one - other[:, ::-1]).max((1, 2)))
    cracks = pairs[apart < 2 * near]
    if len(cracks):
        raise CaseError(
            f"geometry.path: cells of {body!r} are not joined along {len(cracks)} edges with "
            f"duplicate nodes, one {_position_text(ends[cracks[0, 0]])}; merge these nodes"
        )
    nodes, count = np.unique(edges[:, :2], return_counts=True)
    if count.max() > 2:
        node = nodes[np.argmax(count)]
        raise CaseError(
            f"geometry.path: cells of {body!r} are joined by a single node "
            f"{_position_text(points[node][None])}; join them along an edge, or separate them"
        )


def _position_text(nodes: np.ndarray) -> str:
    x, y = nodes.mean(axis=0)
    return f"at x = {x:.6g} m, y = {y:.6g} m"


def check_mesh(mesh: AnyMesh, geometry: Geometry, model: str) -> None:
    """Check the named bodies and surfaces of a mesh.

    Raises
    ------
    CaseError
        If surfaces share edges, a contact face is not one curve, a piece of a body is not held, or
        a surface of symmetry does not lie in a plane x = const.
    """
    mesh = whole_bodies(mesh, geometry)
    for block in mesh.blocks:
        check_shared_edges(block)
    for surface in geometry.contact:
        check_one_curve(block_with(mesh, surface), surface, "geometry.contact")
    for body, surface in zip(geometry.bodies, (geometry.held, geometry.fixed), strict=True):
        check_pieces(block_of(mesh, body), body, [surface])
    if geometry.symmetry:
        if model == "axisymmetric":
            raise CaseError("geometry.half: an axisymmetric model has no plane of symmetry")
        _symmetry(mesh, geometry)


def whole_bodies(mesh: AnyMesh, geometry: AnyMeshed) -> AnyMesh:
    """Mesh with the cells of each body under one tag, those of its cell sets included."""
    given = mesh.cell_tags
    tags = np.zeros_like(given)
    for number, body in enumerate(geometry.bodies, start=1):
        parts = [mesh.bodies.index(part) + 1 for part in geometry.parts_of(body)]
        tags[np.isin(given, parts)] = number
    return retagged(mesh, tags, geometry.bodies)


def points_of(mesh: AnyMesh, body: str) -> np.ndarray:
    """Nodes of a body, shape (n, gdim) [m]."""
    block = block_of(mesh, body)
    return block.points[np.unique(block.cells[block.cell_tags == mesh.bodies.index(body) + 1])]


def described(mesh: AnyMesh) -> list[str]:
    """Size and number of cells of each body, as short text."""
    lines, tags = [], mesh.cell_tags
    for tag, body in enumerate(mesh.bodies, start=1):
        size = " by ".join(length(x) for x in np.ptp(points_of(mesh, body), axis=0))
        lines.append(f"{body} {size} with {np.count_nonzero(tags == tag)} cells")
    return lines


def note_size(mesh: AnyMesh, key: str = "geometry.length_unit", unit: str = "length_unit") -> None:
    """Note a body that is larger than usual ones, as in a wrong unit of length at a key."""
    for body in mesh.bodies:
        size = float(np.ptp(points_of(mesh, body), axis=0).max())
        if size > _LARGE:
            note(f"{key}: {body!r} is {size:.4g} m large; wrong {unit}?")


def note_pressure(key: str, pressure: float) -> None:
    """Note a mean pressure that no load causes, as in a wrong unit of length [Pa]."""
    if 0.0 < pressure < _NO_PRESSURE:
        note(f"{key}: the mean pressure is {pressure:.3g} Pa; wrong length_unit?")


def depth(force: float, area: float, modulus: float, thickness: float | None) -> float:
    """Rough approach of bodies whose whole faces touch, as by a flat punch [m].

    Parameters
    ----------
    force : float
        [N]
    area : float
        Of the face [m²].
    modulus : float
        Of the softer body [Pa].
    thickness : float or None
        Of a plane model [m].
    """
    width = thickness or 2 * np.sqrt(area / np.pi)
    return force / (width * modulus) if width > 0.0 else 0.0


def note_polygons(mesh: AnyMesh, faces: Sequence[str], closed: float, advice: str) -> None:
    """Note contact faces of straight-sided cells that stand for curved ones.

    Parameters
    ----------
    mesh : TaggedMesh or MixedMesh
    faces : sequence of str
        Both faces of a contact.
    closed : float
        Depth that the load closes; not positive if it is not known [m].
    advice : str
        What to do, with ``{}`` for the names of the faces.
    """
    found: dict[str, Curving] = {}
    for face in faces:
        block = block_with(mesh, face)
        if block.order <= 2:
            found[face] = curving(block, [face])
    heights = {face: of.heights[face] for face, of in found.items() if of.heights[face] > 0.0}
    if not heights or sum(heights.values()) <= _CHORDS * closed:
        return
    angle = np.degrees(max(found[face].angles[face] for face in heights))
    against = f", where the load closes about {length(closed)}" if closed > 0.0 else ""
    names = " and ".join(map(repr, heights))
    note(
        f"{names}: facets are flat, their normals jump by up to {angle:.2g}°, and the smooth face "
        f"lies up to {' and '.join(map(length, heights.values()))} off them{against}; pressures "
        f"are those of the edges between facets, also with a higher mesh.degree: {advice} curves "
        "the cells there".replace("{}", ", ".join(f'"{face}"' for face in heights))
    )


def length(value: float) -> str:
    """Length in millimetres or micrometres."""
    return f"{1e3 * value:.4g} mm" if abs(value) >= 1e-4 else f"{1e6 * value:.4g} µm"


def _ends(mesh: TaggedMesh, surface: str) -> np.ndarray:
    """Nodes at both ends of the edges of a surface, shape (n, 2)."""
    return mesh.facets_of(surface)[:, :2]


def check_shared_edges(mesh: TaggedMesh) -> None:
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


def check_one_curve(mesh: TaggedMesh, surface: str, path: str) -> None:
    """Check that a contact face is one curve, open or closed; `path` is the key that names it."""
    ends = _ends(mesh, surface)
    nodes, compact, count = np.unique(ends, return_inverse=True, return_counts=True)
    parts = 1 + components(compact.reshape(ends.shape), len(nodes)).max()
    if parts > 1 or count.max() > 2:
        raise CaseError(
            f"{path}: the edges of {surface!r} are in {parts} pieces; a contact "
            "face must be one curve without branches"
        )


def check_pieces(mesh: TaggedMesh, body: str, surfaces: Sequence[str]) -> None:
    """Check that every piece of a body has part of the surfaces that hold it."""
    cells = mesh.cells[mesh.cell_tags == mesh.bodies.index(body) + 1]
    links = np.column_stack([np.repeat(cells[:, 0], cells.shape[1]), cells.ravel()])
    label = components(links, len(mesh.points))
    pieces = np.unique(label[cells[:, 0]])
    held = np.unique(label[np.concatenate([_ends(mesh, surface) for surface in surfaces])])
    loose, at = np.setdiff1d(pieces, held), " or ".join(map(repr, surfaces))
    if len(loose):
        count = np.count_nonzero(np.isin(label[cells[:, 0]], loose))
        raise CaseError(
            f"geometry.path: {count} of {len(cells)} cells of {body!r} are not joined to those "
            f"held at {at}; a body must be in one piece"
        )
    if len(pieces) > 1:
        note(f"geometry.path: {body!r} has {len(pieces)} pieces, all held by {at}")


def on_surface(mesh: AnyMesh, surface: str) -> np.ndarray:
    """Corners of the facets of a surface, shape (n, gdim) [m]."""
    corners = [b.facets_of(surface)[:, : CORNERS.get(b.facet_type, 2)] for b in mesh.blocks]
    pairs = zip(mesh.blocks, corners, strict=True)
    return np.concatenate([block.points[np.unique(nodes)] for block, nodes in pairs])


def has_any(mesh: AnyMesh, body: str, surfaces: tuple[str, ...]) -> bool:
    """True if a body has nodes on any of some surfaces."""
    block = block_of(mesh, body)
    nodes = np.concatenate([block.facets_of(surface).ravel() for surface in surfaces])
    return bool(np.isin(block.cells[block.cell_tags == mesh.bodies.index(body) + 1], nodes).any())


def _symmetry(mesh: AnyMesh, geometry: Geometry) -> None:
    """Check that surfaces of symmetry lie in one plane x = const, with the bodies on one side."""
    points = mesh.points
    size = np.ptp(points, axis=0).max()
    planes = {name: on_surface(mesh, name)[:, 0] for name in geometry.symmetry}
    for name, x in planes.items():
        if np.ptp(x) > LEVEL * size:
            raise CaseError(
                f"geometry.symmetry: {name!r} does not lie in a plane x = const; it ranges from "
                f"x = {x.min():.6g} to {x.max():.6g} m"
            )
    every = np.concatenate(list(planes.values()))
    if np.ptp(every) > LEVEL * size:
        raise CaseError(
            f"geometry.symmetry: the surfaces lie in different planes, x = {every.min():.6g} and "
            f"{every.max():.6g} m"
        )
    beyond = points[:, 0] - every.mean()
    if min(beyond.max(), -beyond.min()) > LEVEL * size:
        raise CaseError(
            f"geometry.half: the bodies lie on both sides of the plane of symmetry "
            f"x = {every.mean():.6g} m; a half model lies on one side"
        )
    for body in mesh.bodies:
        if not has_any(mesh, body, geometry.symmetry):
            raise CaseError(
                f"geometry.symmetry: no surface of {body!r} is listed; each body needs one"
            )

"""Orientation and validity checks of the cells of a body read from a file.

A mesh is valid if no edge has more than two cells, cells that share an edge lie on both sides of
it, and the map from the unit cell to each cell preserves orientation everywhere (det J > 0).
"""

from __future__ import annotations

import numpy as np
import scipy

from ...errors import CaseError
from ..mesh.nodes import CORNERS
from ..mesh.orders import boundary, turned
from ..mesh.shapes import jacobians

_FLAT = 1e-8
"""Sine of the angle between grid lines below which a cell is degenerate."""
_SAME = 1e-7
"""Distance relative to the size of a body below which nodes coincide."""


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
    _, edge, number = np.unique(
        np.sort(ends, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    edge = edge.ravel()
    if number.max() > 2:
        wrong = number[edge] > 2
        raise CaseError(
            f"geometry.path: {np.count_nonzero(number > 2)} edges of {body!r} have three or more "
            f"cells, one {_position_text(points[ends[np.argmax(wrong)]])}"
        )
    shared = np.argsort(edge, kind="stable")
    shared = shared[number[edge[shared]] == 2].reshape(-1, 2)
    (one, other), same = cell[shared].T, ascending[shared[:, 0]] == ascending[shared[:, 1]]
    rows = np.concatenate([one, one + count])
    columns = np.concatenate([other + count * same, other + count * ~same])
    links = scipy.sparse.coo_matrix(
        (np.ones(len(rows)), (rows, columns)), shape=(2 * count, 2 * count)
    )
    _, label = scipy.sparse.csgraph.connected_components(links, directed=False)
    as_listed, turned_round = label.reshape(2, count)
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

"""Checks of the cells of bodies in space.

A mesh is valid if no facet has more than two cells, cells that share a facet lie on both sides of
it, all cells of a piece are joined by facets, and the map from the unit cell to each cell has a
determinant of one sign (det J ≠ 0).
"""

from __future__ import annotations

import numpy as np
import scipy

from ...errors import CaseError
from ..mesh.nodes import components, facet_nodes, numbered, reference_nodes, turned
from ..mesh.tagged import jacobians

CORNERS = {"tetrahedron": 4, "hexahedron": 8}
"""Number of corners of the cells."""
_AXES = {"tetrahedron": [1, 2, 3], "hexahedron": [1, 3, 4]}
"""Corners at unit distance from the first one."""
_FLAT = 1e-8
"""Determinant of the unit tangents along grid lines below which a cell is degenerate."""
_AFFINE = 1e-3
"""Distance of nodes from an affine cell, relative to its height, up to which det J is constant."""
_SAME = 1e-7
"""Distance relative to the size of a body below which nodes coincide."""
_AT_ONCE = 100_000
"""Number of cells that are checked together."""


def oriented_solid(
    points: np.ndarray, cells: np.ndarray, kind: str, order: int, body: str
) -> tuple[np.ndarray, np.ndarray]:
    """Cells of a body with det J > 0, and the facets of its boundary with outward normals.

    Cells may be listed in either orientation.

    Parameters
    ----------
    points : ndarray, shape (n, 3) [m]
    cells : ndarray of int, shape (n_cells, nodes_per_cell)
    kind, order : str, int
    body : str
        Name of the body in the case, for messages.

    Returns
    -------
    cells : ndarray of int, shape (n_cells, nodes_per_cell)
    facets : ndarray of int, shape (n_facets, nodes_per_facet)

    Raises
    ------
    CaseError
        If the mesh is invalid.
    """
    sign, flat = _signs(points, cells, kind, order)
    _check_cells(points, cells, flat, body)
    cells = cells.copy()
    cells[sign < 0] = cells[sign < 0][:, turned(kind, order)]
    local = facet_nodes(kind, order)
    sides = len(local)
    corners = cells[:, local[:, : 3 if kind == "tetrahedron" else 4]]
    corners = corners.reshape(-1, corners.shape[2])
    number, count = numbered(corners)
    if count.max() > 2:
        wrong = count[number] > 2
        raise CaseError(
            f"geometry.path: {np.count_nonzero(count > 2)} facets of {body!r} have three or more "
            f"cells, one {at(points[corners[np.argmax(wrong)]])}"
        )
    order_ = np.argsort(number, kind="stable")
    pairs = order_[count[number[order_]] == 2].reshape(-1, 2)
    _check_cells(points, cells, _overlapping(corners, pairs, sides), body)
    cell, facet = np.divmod(np.flatnonzero(count[number] == 1), sides)
    facets = cells[cell[:, None], local[facet]]
    _check_cracks(points, facets[:, : corners.shape[1]], body)
    _check_hinges(points, cells[:, : CORNERS[kind]], pairs // sides, body)
    return cells, facets


def at(nodes: np.ndarray) -> str:
    """Position of the centre of some nodes (n, 3), as text."""
    x, y, z = nodes.mean(axis=0)
    return f"at x = {x:.6g} m, y = {y:.6g} m, z = {z:.6g} m"


def _signs(
    points: np.ndarray, cells: np.ndarray, kind: str, order: int
) -> tuple[np.ndarray, np.ndarray]:
    """Sign of the volume of each cell, and mask of cells with a determinant of no single sign."""
    sign, flat = np.empty(len(cells)), np.empty(len(cells), dtype=bool)
    along = 3 if order == 1 else 4 * order - 2
    for first in range(0, len(cells), _AT_ONCE):
        some = slice(first, first + _AT_ONCE)
        x = points[cells[some]]
        affine = x[:, [0, *_AXES[kind]]]
        least, most, volume = jacobians("tetrahedron", 1, affine, 1)
        bent = _bent(x, affine, volume, kind, order)
        if bent.any():
            found = jacobians(kind, order, x[bent], along)
            least[bent], most[bent], volume[bent] = found
        sign[some] = np.sign(volume)
        flat[some] = ~(np.where(volume < 0, -most, least) > _FLAT)
    return sign, flat


def _bent(
    x: np.ndarray, affine: np.ndarray, volume: np.ndarray, kind: str, order: int
) -> np.ndarray:
    """Mask of cells (n, nodes, 3) that are not affine images of the unit cell."""
    places, edges = reference_nodes(kind, order), affine[:, 1:] - affine[:, :1]
    off = np.abs(x - x[:, :1] - np.einsum("qd,cdi->cqi", places, edges)).max(axis=(1, 2))
    size = np.abs(edges).max(axis=(1, 2))
    return ~(off * size**2 <= _AFFINE * np.abs(volume))


def _check_cells(points: np.ndarray, cells: np.ndarray, tangled: np.ndarray, body: str) -> None:
    if tangled.any():
        raise CaseError(
            f"geometry.path: {tangled.sum()} of {len(cells)} cells of {body!r} are tangled or flat "
            f"(det J <= 0), one {at(points[cells[np.argmax(tangled)]])}"
        )


def _overlapping(corners: np.ndarray, pairs: np.ndarray, sides: int) -> np.ndarray:
    """Mask of cells on the same side of a common facet as their neighbours, shape (n_cells,).

    Two cells on both sides of a facet go round it in opposite directions. Where only some
    neighbours of a cell do not, the cells with most of them are inverted.
    """
    first = corners.argmin(axis=1)
    rows, count = np.arange(len(corners)), corners.shape[1]
    ahead, behind = (corners[rows, (first + step) % count] for step in (1, -1))
    forward = ahead < behind
    wrong = pairs[forward[pairs[:, 0]] == forward[pairs[:, 1]]].ravel() // sides
    number = np.bincount(wrong, minlength=len(corners) // sides)
    joined = np.bincount(pairs.ravel() // sides, minlength=len(number))
    inverted = (number == joined) & (number > 0)
    return inverted if inverted.any() else number > 0


def _check_cracks(points: np.ndarray, facets: np.ndarray, body: str) -> None:
    """Reject adjacent cells with duplicate nodes; corners of boundary facets (n, n_corners)."""
    x = points[facets]
    near = _SAME * np.ptp(x.reshape(-1, 3), axis=0).max()
    pairs = scipy.spatial.cKDTree(x.mean(axis=1)).query_pairs(near, output_type="ndarray")
    distances = np.abs(x[pairs[:, 0], :, None] - x[pairs[:, 1], None]).max(axis=3)
    cracks = pairs[distances.min(axis=2).max(axis=1) < 2 * near]
    if len(cracks):
        raise CaseError(
            f"geometry.path: cells of {body!r} are not joined along {len(cracks)} facets with "
            f"duplicate nodes, one {at(x[cracks[0, 0]])}; merge these nodes"
        )


def _check_hinges(points: np.ndarray, corners: np.ndarray, joined: np.ndarray, body: str) -> None:
    """Reject pieces joined by a node or an edge only; pairs of cells that share a facet (n, 2)."""
    by_facets = components(joined, len(corners))
    if by_facets.max() == 0:
        return
    by_nodes = components(node_links(corners), len(points))[corners[:, 0]]
    _, first = np.unique(by_facets, return_index=True)
    again = np.setdiff1d(first, first[np.unique(by_nodes[first], return_index=True)[1]])
    if len(again):
        own = by_facets == by_facets[again[0]]
        others = (by_nodes == by_nodes[again[0]]) & ~own
        shared = np.intersect1d(corners[own], corners[others])
        what = "a single node" if len(shared) == 1 else "an edge only"
        raise CaseError(
            f"geometry.path: cells of {body!r} are joined by {what} "
            f"{at(points[shared[:1]])}; join them along a facet, or separate them"
        )


def node_links(corners: np.ndarray) -> np.ndarray:
    """Pairs of nodes that connect the corners of each cell, shape (n, 2)."""
    first = np.repeat(corners[:, 0], corners.shape[1] - 1)
    return np.column_stack([first, corners[:, 1:].ravel()])

"""Values of nodal fields at given points of the bodies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np
import scipy.sparse as sp

from ...compat import geometry_dofmap
from ...lagrange import tabulated
from ..bodies import Bodies
from ..body_mesh import BodyMesh
from ..field import reference_element
from ..spaces import Spaces
from .cell_search import CellSearch

_INSIDE = 1e-6
"""Largest distance of a point from its cell, see `CellSearch.near`."""


@dataclass(frozen=True)
class CellPoint:
    """Point in a cell that this rank owns.

    Attributes
    ----------
    distance : float
        Distance from the cell, see `CellSearch.near`; zero inside, to rounding.
    body, cell : int
        Index of the body in `Bodies.each`, and local index of the cell.
    place : ndarray, shape (gdim,)
        Reference coordinates.
    """

    distance: float
    body: int
    cell: int
    place: np.ndarray


def located(
    bodies: Bodies, points: Sequence[tuple[float, ...]], owners: Mapping[str, str]
) -> list[dict[str, CellPoint | None]]:
    """Cells of points by the name of the owner of their parts. Every rank calls.

    Parameters
    ----------
    bodies : Bodies
    points : sequence of tuple of float [m]
    owners : mapping of str to str
        Owner of each part.

    Returns
    -------
    list of dict
        For each point its owners, the same on all ranks; with the cell on one rank, None on others.
    """
    rows = []
    for point in points:
        found: dict[str, CellPoint] = {}
        for index, body in enumerate(bodies.each):
            for owner, at in _in_body(body, index, np.array(point), owners).items():
                if owner not in found or at.distance < found[owner].distance:
                    found[owner] = at
        rows.append(found)
    distances = bodies.comm.allgather([{k: at.distance for k, at in row.items()} for row in rows])
    result: list[dict[str, CellPoint | None]] = []
    for row, of_ranks in zip(rows, zip(*distances, strict=True), strict=True):
        names = sorted(set().union(*of_ranks))
        ranks = {name: _nearest(name, of_ranks) for name in names}
        mine = bodies.comm.rank
        result.append({name: row[name] if ranks[name] == mine else None for name in names})
    return result


def _nearest(name: str, distances: Sequence[Mapping[str, float]]) -> int:
    """Rank with the cell that is nearest to a point; the first of several."""
    return int(np.argmin([each.get(name, np.inf) for each in distances]))


def _in_body(
    body: BodyMesh, index: int, point: np.ndarray, owners: Mapping[str, str]
) -> dict[str, CellPoint]:
    """Cells of one body that contain a point and that this rank owns, by owner."""
    dofmap, mesh = geometry_dofmap(body.mesh), body.mesh
    nodes = mesh.geometry.x[dofmap[: body.n_cells]][..., : mesh.geometry.dim]
    search, found = CellSearch(mesh, degree=1), dict[str, CellPoint]()
    for cell, place, distance in zip(*search.near(nodes, point), strict=True):
        owner = owners[body.names[body.parts_of_cells(np.array([cell]))[0]]]
        closer = owner not in found or distance < found[owner].distance
        if distance <= _INSIDE and closer:
            found[owner] = CellPoint(float(distance), index, int(cell), place)
    return found


def point_rows(spaces: Spaces, points: Sequence[CellPoint | None]) -> sp.csr_matrix:
    """Values of a nodal field at points, as a matrix (n_points, n_owned). Every rank calls.

    Products with the owned values add up to the values at the points over all ranks.
    """
    entries = []
    for row, at in enumerate(points):
        if at is not None:
            space = spaces.each[at.body]
            weights = tabulated(reference_element(space.mesh, spaces.degree), at.place[None])[0, 0]
            nodes = space.dofmap.index_map.local_to_global(space.dofmap.list[at.cell])
            entries.append((row, at.body, nodes, weights))
    rows = sp.lil_matrix((len(points), spaces.owned))
    for row, body, nodes, weights in chain.from_iterable(spaces.comm.allgather(entries)):
        first, end = spaces.each[body].dofmap.index_map.local_range
        own = (nodes >= first) & (nodes < end)
        rows[row, spaces.starts[body] + nodes[own] - first] = weights[own]
    return rows.tocsr()

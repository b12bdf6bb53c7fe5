"""Quadratic tetrahedra of CAD bodies by gmsh, with curved cells that are checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..mesh.tagged import jacobians
from .request import CadError
from .solids import UNIT, CadBody, CadFace, in_mm

_TETRAHEDRON, _TRIANGLE = 11, 9
"""Quadratic elements of gmsh."""
_GOOD, _LEAST = 0.1, 1e-3
"""Smallest scaled Jacobian that is not improved, and the least that is accepted."""
_PLACES = 4
"""Points along each side of a cell at which its Jacobian is evaluated."""
_OPTIMISERS = ("HighOrder", "HighOrderElastic", "HighOrder")
"""Optimisers of curved cells, one after the other until the cells are good."""


def make_mesh(gmsh, bodies: Sequence[CadBody]) -> None:
    """Mesh all bodies in the sizes that have been set.

    Raises
    ------
    CadError
        If gmsh fails, or cells are tangled.
    """
    mesh = gmsh.model.mesh
    try:
        mesh.generate(3)
        mesh.setOrder(2)
        for optimiser in _OPTIMISERS:
            if min(_quality(gmsh, body).min() for body in bodies) >= _GOOD:
                break
            mesh.optimize(optimiser)
    except CadError:
        raise
    except Exception as trouble:  # gmsh raises nothing more specific
        raise CadError(f"mesh.size: gmsh could not mesh the bodies: {trouble}") from None
    for body in bodies:
        found = _quality(gmsh, body)
        if found.min() < _LEAST:
            _, places = _cells(gmsh, body)
            where = places[int(found.argmin())].mean(axis=0)
            raise CadError(
                f"mesh.size: {np.count_nonzero(found < _LEAST)} of {len(found)} curved cells of "
                f"{body.name!r} are tangled (smallest scaled Jacobian {found.min():.2g}), one at "
                f"{in_mm(where)}; use smaller elements"
            )


def _quality(gmsh, body: CadBody) -> np.ndarray:
    """Smallest scaled Jacobian of each cell of a body, shape (n,)."""
    _, places = _cells(gmsh, body)
    if not len(places):
        raise CadError(f"mesh.size: gmsh could not mesh {body.name!r} with tetrahedra")
    signed = jacobians("tetrahedron", 2, places, _PLACES)
    return np.nan_to_num(np.where(signed[2] < 0, -signed[1], signed[0]), nan=-1.0)


def _cells(gmsh, body: CadBody) -> tuple[np.ndarray, np.ndarray]:
    """Node tags of the cells of a body, and their coordinates, shape (n, 10, 3) [mm]."""
    found = [gmsh.model.mesh.getElementsByType(_TETRAHEDRON, s.tag)[1] for s in body.solids]
    cells = np.concatenate(found).astype(np.int64).reshape(-1, 10)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    row = _rows(tags)
    return cells, coordinates.reshape(-1, 3)[row[cells]]


def _rows(tags: np.ndarray) -> np.ndarray:
    """Indices of nodes by their tags."""
    row = np.zeros(int(tags.max(initial=0)) + 1, dtype=np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    return row


def mesh_arrays(
    gmsh, bodies: Sequence[CadBody], surfaces: Mapping[str, Mapping[str, Sequence[CadFace]]]
) -> dict[str, np.ndarray]:
    """Nodes [m] and elements of the mesh.

    Parameters
    ----------
    gmsh : module
    bodies : sequence of CadBody
    surfaces : mapping
        Faces by name of the surface and body.

    Returns
    -------
    dict of str to ndarray
        ``points``; ``cells_B`` of body B and ``solid_B_S`` with the indices of those of its solid
        S; ``facets_B`` and ``surface_B_K`` of the K-th surface.
    """
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    row = _rows(tags)
    arrays = {"points": UNIT * coordinates.reshape(-1, 3)}
    for b, body in enumerate(bodies):
        arrays[f"cells_{b}"], of_solid = _elements(
            gmsh, _TETRAHEDRON, row, [[solid.tag] for solid in body.solids]
        )
        arrays |= {f"solid_{b}_{s}": found for s, found in enumerate(of_solid)}
        own = [surfaces[name].get(body.name, ()) for name in surfaces]
        arrays[f"facets_{b}"], of_surface = _elements(
            gmsh, _TRIANGLE, row, [[face.tag for face in faces] for faces in own]
        )
        arrays |= {f"surface_{b}_{k}": found for k, found in enumerate(of_surface) if len(found)}
    return arrays


def _elements(
    gmsh, kind: int, row: np.ndarray, groups: list[list[int]]
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Nodes of the elements of some entities, and the indices of those of each group."""
    count = 10 if kind == _TETRAHEDRON else 6
    found, members, start = [np.empty((0, count), dtype=np.int64)], [], 0
    for tags in groups:
        nodes = [gmsh.model.mesh.getElementsByType(kind, tag)[1] for tag in tags]
        of_group = np.concatenate([np.empty(0), *nodes]).astype(np.int64).reshape(-1, count)
        found.append(row[of_group])
        members.append(np.arange(start, start + len(of_group)))
        start += len(of_group)
    return np.concatenate(found), members

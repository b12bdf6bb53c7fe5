"""Quadratic tetrahedra of CAD bodies by gmsh, with curved cells that are checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..mesh.tagged import jacobians
from .request import CadError
from .sizes import width
from .solids import UNIT, CadBody, CadFace, in_mm

_TETRAHEDRON, _TRIANGLE = 11, 9
"""Quadratic elements of gmsh."""
_ATTEMPTS = ((6, 0.3, 1.0), (5, 0.6, 1.0), (6, 0.3, 0.9), (6, 0.3, 0.8), (5, 0.6, 0.7))
"""Algorithms of gmsh on faces (frontal, Delaunay), quality that it aims at for cells, and factor of
their sizes: tried until there are no poor cells."""
_POOR, _LEAST = 0.05, 1e-3
"""Scaled Jacobian of poor cells, and the least that is accepted."""
_PLACES = 4
"""Points along each side of a cell at which its Jacobian is evaluated."""


def make_mesh(gmsh, bodies: Sequence[CadBody]) -> None:
    """Mesh all bodies in the sizes that have been set.

    Raises
    ------
    CadError
        If gmsh fails, or cells are tangled.
    """
    mesh = gmsh.model.mesh
    try:
        if _best_mesh(gmsh, bodies) < _POOR:
            mesh.optimize("HighOrderElastic")
        if _least(gmsh, bodies) < _LEAST:
            mesh.optimize("HighOrder")  # ends the process where it fails
    except CadError:
        raise
    except Exception as trouble:  # gmsh raises nothing more specific
        reason = str(trouble).strip() or f"it gave no reason; {_narrowest(gmsh, bodies)}"
        raise CadError(f"mesh.size: gmsh could not mesh the bodies: {reason}") from None
    for body in bodies:
        found = _quality(gmsh, body)
        if found.min() < _LEAST:
            where = _places(gmsh, body)[int(found.argmin())].mean(axis=0)
            raise CadError(
                f"mesh.size: {np.count_nonzero(found < _LEAST)} of {len(found)} curved cells of "
                f"{body.name!r} are tangled (smallest scaled Jacobian {found.min():.2g}), one at "
                f"{in_mm(where)}; use smaller elements"
            )


def _narrowest(gmsh, bodies: Sequence[CadBody]) -> str:
    """Text on the narrowest face of all bodies, which often cannot be meshed."""
    faces = [(width(gmsh, face), body.name, face) for body in bodies for face in body.faces]
    size, name, face = min(faces, key=lambda of: of[0])
    return (
        f"the narrowest face, {size:.3g} mm wide, is one of {name!r} near "
        f"{in_mm(np.mean(face.box, axis=0))}: leave it out in the CAD program, or use a smaller "
        "mesh.size"
    )


def _best_mesh(gmsh, bodies: Sequence[CadBody]) -> float:
    """Mesh the bodies in the ways of `_ATTEMPTS`; the smallest scaled Jacobian of the best one."""
    found: dict[tuple[int, float, float], float] = {}
    for attempt in _ATTEMPTS:
        found[attempt] = _generated(gmsh, bodies, *attempt)
        if found[attempt] >= _POOR:
            return found[attempt]
    best = max(found, key=found.__getitem__)
    return _generated(gmsh, bodies, *best)


def _generated(
    gmsh, bodies: Sequence[CadBody], algorithm: int, quality: float, factor: float
) -> float:
    """Mesh the bodies with quadratic cells; their smallest scaled Jacobian."""
    gmsh.option.setNumber("Mesh.Algorithm", algorithm)
    gmsh.option.setNumber("Mesh.OptimizeThreshold", quality)
    gmsh.option.setNumber("Mesh.MeshSizeFactor", factor)
    gmsh.model.mesh.clear()
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(2)
    return _least(gmsh, bodies)


def _least(gmsh, bodies: Sequence[CadBody]) -> float:
    """Smallest scaled Jacobian of all cells."""
    return float(min(_quality(gmsh, body).min() for body in bodies))


def _quality(gmsh, body: CadBody) -> np.ndarray:
    """Smallest scaled Jacobian of each cell of a body, shape (n,)."""
    places = _places(gmsh, body)
    if not len(places):
        raise CadError(f"mesh.size: gmsh could not mesh {body.name!r} with tetrahedra")
    least, most, mean = jacobians("tetrahedron", 2, places, _PLACES)
    return np.nan_to_num(np.where(mean < 0, -most, least), nan=-1.0)


def _places(gmsh, body: CadBody) -> np.ndarray:
    """Nodes of the cells of a body, shape (n, 10, 3) [mm]."""
    found = [gmsh.model.mesh.getElementsByType(_TETRAHEDRON, s.tag)[1] for s in body.solids]
    cells = np.concatenate(found).astype(np.int64).reshape(-1, 10)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    return coordinates.reshape(-1, 3)[_rows(tags)[cells]]


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
    count = 6 if kind == _TRIANGLE else 10
    found, members, start = [np.empty((0, count), dtype=np.int64)], [], 0
    for tags in groups:
        nodes = [gmsh.model.mesh.getElementsByType(kind, tag)[1] for tag in tags]
        of_group = np.concatenate([np.empty(0), *nodes]).astype(np.int64).reshape(-1, count)
        found.append(row[of_group])
        members.append(np.arange(start, start + len(of_group)))
        start += len(of_group)
    return np.concatenate(found), members

"""STEP export (CAD, in millimetres) by OpenCASCADE through gmsh.

A worn body in space is a prism on a B-spline surface through its worn face.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import scipy

from ...errors import CaseError
from ..mesh.gmsh_session import gmsh_model
from ..mesh.nodes import shape_functions
from ..mesh.tagged import TaggedMesh
from .design import Design
from .worn_body import offsets

UNIT = 1e3
"""Millimetres in a metre."""
_WITHIN = 5
"""Points of the surface along each side of a facet, both ends included."""


def save(gmsh, path: Path) -> None:
    """Write a gmsh model to a file, with the output of OpenCASCADE suppressed.

    Written to a temporary file and renamed: gmsh derives the format from a fixed file ending.
    """
    draft = path.with_name(f".{path.name}.step")
    try:
        draft.open("wb").close()
        with _silence():
            gmsh.write(str(draft))
        os.replace(draft, path)
    except OSError as error:
        raise CaseError(f"-o {path}: cannot be written: {error.strerror}") from None


@contextmanager
def _silence() -> Iterator[None]:
    """Suppress the standard output of the process."""
    sys.stdout.flush()
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


def write_prism(mesh: TaggedMesh, design: Design, face: str, path: Path) -> None:
    """Write the solid of a body whose contact face has a worn shape.

    The body stands on its face, z upwards, with vertical sides and a plane top. The surface
    interpolates a grid of points of the worn face.

    Parameters
    ----------
    mesh : TaggedMesh
        Mesh of the unworn body.
    design : Design
    face : str
        Name of its contact face, a structured patch of quadrilateral facets.
    path : Path

    Raises
    ------
    CaseError
        If the file cannot be written.
    """
    grid = face_grid(mesh, face)
    flat = grid.reshape(-1, 3)
    worn = (flat + offsets(design, flat)).reshape(grid.shape)
    low, high = mesh.points.min(axis=0) * UNIT, mesh.points.max(axis=0) * UNIT
    size = high - low
    with gmsh_model("worn body") as gmsh:
        occ = gmsh.model.occ
        prism = occ.extrude([(2, _surface(occ, worn * UNIT))], 0.0, 0.0, 2 * size[2])
        below = low - size
        box = occ.addBox(*below, *(3 * size[:2]), high[2] - below[2])
        occ.intersect([entity for entity in prism if entity[0] == 3], [(3, box)])
        occ.synchronize()
        save(gmsh, path)


def face_grid(mesh: TaggedMesh, face: str) -> np.ndarray:
    """Grid of points of a face of structured facets, shape (n_u, n_v, 3) [m]."""
    facets = mesh.facets_of(face)
    corners = _lattice(facets[:, :4])
    xi, eta = (step[:, None] for step in np.indices((_WITHIN, _WITHIN)).reshape(2, -1))
    points = shape_functions("quadrilateral", mesh.order, np.hstack([xi, eta]) / (_WITHIN - 1))
    grid = np.full((*(corners.max(axis=(0, 1)) * (_WITHIN - 1) + 1), 3), np.nan)
    for nodes, (a, b, _, d) in zip(facets, corners, strict=True):
        i, j = (a * (_WITHIN - 1) + xi * (b - a) + eta * (d - a)).T
        grid[i, j] = points @ mesh.points[nodes]
    return grid


def _lattice(facets: np.ndarray) -> np.ndarray:
    """Integer coordinates (i, j) of the corners of structured facets, shape (n, 4, 2) from 0.

    The patch is traversed from the first facet across common edges.
    """
    edges: dict[frozenset, list[tuple[int, int]]] = {}
    for f, corners in enumerate(facets.tolist()):
        for k in range(4):
            edges.setdefault(frozenset((corners[k], corners[k - 3])), []).append((f, k))
    found = np.full((*facets.shape, 2), np.iinfo(np.int64).min)
    found[0] = [[0, 0], [1, 0], [1, 1], [0, 1]]
    waiting, seen = [0], {0}
    while waiting:
        f = waiting.pop()
        for k in range(4):
            across = found[f, k] - found[f, k - 1]
            for g, m in edges[frozenset(facets[f, [k, k - 3]].tolist())]:
                if g in seen:
                    continue
                same = facets[g, m] == facets[f, k]
                first, second = (found[f, k], found[f, k - 3])[:: 1 if same else -1]
                found[g, [m, m - 3, m - 2, m - 1]] = [
                    first,
                    second,
                    second + across,
                    first + across,
                ]
                seen.add(g)
                waiting.append(g)
    return found - found.min(axis=(0, 1))


def _surface(occ, grid: np.ndarray) -> int:
    """Bicubic B-spline through a grid of points, parametrised by their mean distances [mm]."""
    control, knots, multiplicities = grid, [], []
    for axis in (0, 1):
        steps = np.linalg.norm(np.diff(grid, axis=axis), axis=2).mean(axis=1 - axis)
        at = np.concatenate([[0.0], np.cumsum(steps)])
        spline = scipy.interpolate.make_interp_spline(at, control, k=3, axis=axis)
        control = np.moveaxis(spline.c, 0, axis) if axis else spline.c
        values, counts = np.unique(spline.t, return_counts=True)
        knots.append(values)
        multiplicities.append(counts)
    tags = [occ.addPoint(*point) for row in np.moveaxis(control, 0, 1) for point in row]
    return occ.addBSplineSurface(
        tags,
        len(control),
        degreeU=3,
        degreeV=3,
        knotsU=knots[0],
        knotsV=knots[1],
        multiplicitiesU=multiplicities[0],
        multiplicitiesV=multiplicities[1],
    )

"""``fields.vtu``: fields of the bodies for ParaView and for pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..results import FIELDS
from .atomic_write import atomic_write

_CELLS = {3: "triangle", 4: "quad", 8: "hexahedron"}


def write_fields(path: Path, fields) -> None:
    """Write the fields on linear subcells, discontinuous between the cells of the mesh.

    Parameters
    ----------
    path : Path
    fields : thermowear.results.BodyFields
    """
    import meshio

    n_cells, n_points, gdim = fields.points.shape
    first = np.arange(n_cells)[:, None, None] * n_points
    corners = fields.pieces.shape[1]
    pieces = (first + fields.pieces).reshape(-1, corners)
    values = {"displacement": _three(fields.displacement.reshape(-1, gdim))}
    values["von_mises"] = fields.von_mises.ravel()
    if fields.temperature is not None:
        values["temperature"] = fields.temperature.ravel()
    data = {FIELDS[name].header: value for name, value in values.items()}
    body = np.repeat(fields.body, len(fields.pieces))
    mesh = meshio.Mesh(
        _three(fields.points.reshape(-1, gdim)), [(_CELLS[corners], pieces)], data, {"body": [body]}
    )
    with atomic_write(path) as draft:
        mesh.write(draft, file_format="vtu")


def _three(vectors: np.ndarray) -> np.ndarray:
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))

"""Writing a tagged mesh for other programs; the format follows the file's ending."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..errors import CaseError
from .orders import order_of, quadratic
from .tagged import TaggedMesh

_MESHIO_CELLS = {
    ("quadrilateral", 4): "quad",
    ("quadrilateral", 9): "quad9",
    ("quadrilateral", 16): "quad16",
    ("triangle", 3): "triangle",
    ("triangle", 6): "triangle6",
    ("triangle", 10): "triangle10",
}
_MESHIO_FACETS = {2: "line", 3: "line3", 4: "line4"}
_FORMATS = {".msh": "gmsh22", ".vtu": "vtu", ".xdmf": "xdmf", ".inp": "abaqus"}


def check_ending(path: Path) -> None:
    """Raise a `CaseError` if a file's ending names no known format."""
    if path.suffix not in _FORMATS:
        raise CaseError(f"-o {path}: unknown ending; one of: {', '.join(_FORMATS)}")


def write_mesh(mesh: TaggedMesh, path: Path) -> None:
    """Write bodies and named surfaces as physical groups (.msh), sets (.inp) or tags (.vtu, .xdmf).

    Cells of the third order are known to .msh only; elsewhere the second stands for it.

    Raises
    ------
    CaseError
        If the ending is not known, or the file cannot be written.
    """
    import meshio

    check_ending(path)
    if path.suffix != ".msh" and order_of(mesh) > 2:
        mesh = quadratic(mesh)
    cells = [
        (_MESHIO_CELLS[mesh.cell_type, mesh.cells.shape[1]], mesh.cells),
        (_MESHIO_FACETS[mesh.facets.shape[1]], mesh.facets),
    ]
    n = len(mesh.bodies)
    # one numbering for both dimensions, so that a tag names one thing in every format
    tags = [mesh.cell_tags, mesh.facet_tags + n]
    points = np.pad(mesh.points, ((0, 0), (0, 3 - mesh.points.shape[1])))
    result = meshio.Mesh(points, cells)
    if path.suffix == ".inp":
        result.cell_sets = _sets(mesh)
    elif path.suffix == ".msh":
        result.cell_data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
        dims = [2] * n + [1] * len(mesh.surfaces)
        names = (*mesh.bodies, *mesh.surfaces)
        result.field_data = {
            name: np.array([tag, dim])
            for tag, (name, dim) in enumerate(zip(names, dims, strict=True), start=1)
        }
    else:
        result.cell_data = {"tag": tags}
    try:
        # text, and in one file: nothing beside it can be overwritten
        keywords = {".msh": {"binary": False}, ".xdmf": {"data_format": "XML"}}.get(path.suffix, {})
        meshio.write(path, result, file_format=_FORMATS[path.suffix], **keywords)
    except OSError as error:
        raise CaseError(f"-o {path}: cannot be written: {error.strerror}") from None


def _sets(mesh: TaggedMesh) -> dict[str, list[np.ndarray]]:
    """Elements of each name, per block of cells."""
    none = np.array([], dtype=np.int64)
    bodies = {
        name: [np.flatnonzero(mesh.cell_tags == tag), none]
        for tag, name in enumerate(mesh.bodies, start=1)
    }
    surfaces = {
        name: [none, np.flatnonzero(mesh.facet_tags == tag)]
        for tag, name in enumerate(mesh.surfaces, start=1)
    }
    return bodies | surfaces

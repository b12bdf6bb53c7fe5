"""Export of a tagged mesh for other programs; the format follows the file's ending."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from ...errors import CaseError
from ..mesh.mixed import AnyMesh
from ..mesh.tagged import TaggedMesh, compact, quadratic
from .contents import VTK_ORDER

_MESHIO_CELLS = {
    "interval": ("line", 2),
    "triangle": ("triangle", 3),
    "quadrilateral": ("quad", 4),
    "tetrahedron": ("tetra", 4),
    "hexahedron": ("hexahedron", 8),
}
"""Meshio's name of straight cells, to which that of others adds their number of nodes."""
_FORMATS = {".msh": "gmsh22", ".vtu": "vtu", ".xdmf": "xdmf", ".inp": "abaqus"}


def check_ending(path: Path) -> None:
    """Raise a `CaseError` if a file's ending is not supported."""
    if path.suffix not in _FORMATS:
        raise CaseError(f"-o {path}: unknown file ending; must be one of: {', '.join(_FORMATS)}")


def write_mesh(mesh: AnyMesh, path: Path, point_data: dict[str, np.ndarray] | None = None) -> None:
    """Write bodies and named surfaces as physical groups (.msh), sets (.inp) or tags (.vtu, .xdmf).

    Third-order cells are supported in .msh only; other formats get second-order cells.

    Parameters
    ----------
    mesh : TaggedMesh or MixedMesh
    path : Path
    point_data : dict of str to ndarray, optional
        Scalars or vectors at the points, if the format supports the mesh unchanged.

    Raises
    ------
    CaseError
        If the ending is not supported, or the file cannot be written.
    """
    import meshio

    check_ending(path)
    blocks = [_prepared(block, path) for block in mesh.blocks]
    starts = np.cumsum([0] + [len(block.points) for block in blocks])
    pairs, n = list(zip(blocks, starts, strict=False)), len(mesh.bodies)
    cells = [_block(block.cell_type, block.cells + start) for block, start in pairs]
    cells += [_block(block.facet_type, block.facets + start) for block, start in pairs]
    # one numbering for both dimensions, so that a tag is unique in every format
    tags = [block.cell_tags for block in blocks] + [block.facet_tags + n for block in blocks]
    names = list(enumerate((*mesh.bodies, *mesh.surfaces), start=1))
    points = np.concatenate([block.points for block in blocks])
    dim = points.shape[1]
    points = np.pad(points, ((0, 0), (0, 3 - dim)))
    result = meshio.Mesh(points, cells, point_data=point_data)
    if path.suffix == ".inp":
        result.cell_sets = {name: [np.flatnonzero(of == tag) for of in tags] for tag, name in names}
    elif path.suffix == ".msh":
        result.cell_data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
        result.field_data = {
            name: np.array([tag, dim if tag <= n else dim - 1]) for tag, name in names
        }
    else:
        result.cell_data = {"tag": tags}
    try:
        # text, and in one file: no other file can be overwritten
        keywords = {".msh": {"binary": False}, ".xdmf": {"data_format": "XML"}}.get(path.suffix, {})
        meshio.write(path, result, file_format=_FORMATS[path.suffix], **keywords)
    except OSError as error:
        raise CaseError(f"-o {path}: cannot be written: {error.strerror}") from None


def _prepared(mesh: TaggedMesh, path: Path) -> TaggedMesh:
    """Mesh with cells that a format supports, with nodes in its order."""
    if path.suffix != ".msh" and mesh.order > 2:
        mesh = quadratic(mesh)
    kind, _ = _block(mesh.cell_type, mesh.cells)
    if kind in VTK_ORDER:
        mesh = replace(mesh, cells=mesh.cells[:, np.argsort(VTK_ORDER[kind])])
    if kind == "hexahedron27" and path.suffix == ".inp":  # supports no nodes inside facets
        mesh = compact(replace(mesh, cells=mesh.cells[:, :20], facets=mesh.facets[:, :8]))
    return mesh


def _block(kind: str, nodes: np.ndarray) -> tuple[str, np.ndarray]:
    """Cells or facets with meshio's name of their type."""
    name, corners = _MESHIO_CELLS[kind]
    return name if nodes.shape[1] == corners else f"{name}{nodes.shape[1]}", nodes

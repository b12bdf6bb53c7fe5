"""What a mesh file holds, whatever its format: nodes, elements, and sets of them by name."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..errors import CaseError
from .abaqus import read_abaqus
from .gmsh_session import gmsh_model

_SHAPES = {
    "line": (1, 2),
    "line3": (1, 2),
    "line4": (1, 2),
    "triangle": (2, 3),
    "triangle6": (2, 3),
    "triangle10": (2, 3),
    "quad": (2, 4),
    "quad8": (2, 4),
    "quad9": (2, 4),
    "quad16": (2, 4),
}
"""Dimension and corners of the elements of meshio that are of use."""


@dataclass
class Contents:
    """A mesh file.

    Attributes
    ----------
    points : ndarray, shape (n_points, 2 or 3)
        In the file's unit of length.
    blocks : list of Block
    node_sets : dict of str to ndarray of int
    """

    points: np.ndarray
    blocks: list[Block]
    node_sets: dict[str, np.ndarray] = field(default_factory=dict)

    def names(self, dim: int) -> list[str]:
        """Names of sets of elements of a dimension."""
        found = [block.sets for block in self.blocks if block.dim == dim]
        return sorted({name for sets in found for name in sets})


@dataclass
class Block:
    """Elements of one type.

    Attributes
    ----------
    dim, corners : int
        Dimension and number of corners.
    nodes : ndarray of int64, shape (n_elements, n_nodes)
        In gmsh's order.
    sets : dict of str to ndarray of int
        Elements of each named set.
    """

    dim: int
    corners: int
    nodes: np.ndarray
    sets: dict[str, np.ndarray]


def read_contents(path: Path) -> Contents:
    """Read a mesh file; its ending tells the format.

    Raises
    ------
    CaseError
        One line, charged to ``geometry.path``.
    """
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise CaseError(f"geometry.path: {path}: unknown ending; one of: {', '.join(_READERS)}")
    try:
        path.open("rb").close()
        with contextlib.redirect_stdout(io.StringIO()):
            contents = reader(path)
    except CaseError:
        raise
    except OSError as error:
        raise CaseError(f"geometry.path: {path} cannot be read: {error.strerror}") from None
    except (Exception, SystemExit) as error:  # readers raise whatever a broken file leads them to
        reason = " ".join(str(error).split()) or type(error).__name__
        raise CaseError(f"geometry.path: {path} cannot be read: {reason}") from None
    if not any(block.dim == 2 and len(block.nodes) for block in contents.blocks):
        raise CaseError(f"geometry.path: {path} has no plane cells")
    return contents


def _read_abaqus(path: Path) -> Contents:
    points, blocks, node_sets = read_abaqus(path.read_text(encoding="utf-8", errors="replace"))
    return Contents(points, [Block(*block) for block in blocks], node_sets)


def _read_gmsh(path: Path) -> Contents:
    with gmsh_model("file") as gmsh:
        gmsh.merge(str(path))
        model = gmsh.model
        if model.getEntities(3):
            raise ValueError("it has three-dimensional cells; a plane section is needed")
        tags, coordinates, _ = model.mesh.getNodes()
        number = np.full(int(tags.max(initial=0)) + 1, -1, dtype=np.int64)
        number[tags.astype(np.int64)] = np.arange(len(tags))
        blocks = []
        for dim, entity in model.getEntities(2) + model.getEntities(1):
            groups = model.getPhysicalGroupsForEntity(dim, entity)
            names = [model.getPhysicalName(dim, group) or str(group) for group in groups]
            for kind, ids, nodes in zip(*model.mesh.getElements(dim, entity), strict=True):
                corners = model.mesh.getElementProperties(kind)[5]
                of_elements = number[nodes.astype(np.int64)].reshape(len(ids), -1)
                every = np.arange(len(ids))
                blocks.append(Block(dim, corners, of_elements, dict.fromkeys(names, every)))
        return Contents(coordinates.reshape(-1, 3), blocks)


def _read_meshio(path: Path) -> Contents:
    import meshio

    mesh = meshio.read(path)
    blocks = []
    for index, cells in enumerate(mesh.cells):
        if cells.type == "vertex":
            continue
        if cells.type not in _SHAPES:
            raise ValueError(f"it has cells of type {cells.type}, which are of no use here")
        sets = _sets_of_block(mesh, index)
        blocks.append(Block(*_SHAPES[cells.type], np.asarray(cells.data, dtype=np.int64), sets))
    return Contents(np.asarray(mesh.points, dtype=float), blocks, _node_sets(mesh))


def _sets_of_block(mesh, index: int) -> dict[str, np.ndarray]:
    """Sets by name (families of .med), or by the numbers of integer data (.vtu, .xdmf)."""
    found: dict[str, list[np.ndarray]] = {}
    for key, data in mesh.cell_data.items():
        values = np.asarray(data[index])
        if values.ndim != 1 or not np.issubdtype(values.dtype, np.integer):
            continue
        families = getattr(mesh, "cell_tags", {}) if key == "cell_tags" else None
        for value in np.unique(values):
            names = [str(value)] if families is None else families.get(value, [])
            for name in names:
                found.setdefault(name, []).append(np.flatnonzero(values == value))
    return {name: np.unique(np.concatenate(parts)) for name, parts in found.items()}


def _node_sets(mesh) -> dict[str, np.ndarray]:
    """Sets of nodes of .med."""
    values = mesh.point_data.get("point_tags", np.empty(0))
    found: dict[str, list[np.ndarray]] = {}
    for family, names in getattr(mesh, "point_tags", {}).items():
        for name in names:
            found.setdefault(name, []).append(np.flatnonzero(values == family))
    return {name: np.concatenate(parts) for name, parts in found.items()}


def _read_xdmf(path: Path) -> Contents:
    try:
        return _read_meshio(path)
    except KeyError:  # of meshio's table of the types that it knows beside others
        raise ValueError("cells of this kind are not understood in .xdmf; use .msh") from None


_READERS: dict[str, Callable[[Path], Contents]] = {
    ".msh": _read_gmsh,
    ".inp": _read_abaqus,
    ".vtu": _read_meshio,
    ".xdmf": _read_xdmf,
    ".med": _read_meshio,
}

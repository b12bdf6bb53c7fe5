"""Contents of a mesh file of any format: nodes, elements, and their named sets."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

_SHAPES = {
    **dict.fromkeys(("line", "line3", "line4"), (1, 2)),
    **dict.fromkeys(("triangle", "triangle6", "triangle10"), (2, 3)),
    **dict.fromkeys(("quad", "quad8", "quad9", "quad16"), (2, 4)),
    **dict.fromkeys(("tetra", "tetra10", "tetra20"), (3, 4)),
    **dict.fromkeys(("hexahedron", "hexahedron20", "hexahedron27", "hexahedron64"), (3, 8)),
}
"""Dimension and number of corners of the supported elements, by meshio's names."""

VTK_ORDER = {
    "tetra10": [0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
    "hexahedron20": [*range(9), 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14],
    "hexahedron27": [*range(9), 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14, 24, 22, 20, 21, 23, 25]
    + [26],
}
"""Nodes of VTK, Abaqus and MED (but for those inside its faces) in the order of gmsh."""

_SHOWN = 40
"""Number of characters of a faulty line that a message quotes."""


@dataclass
class CellBlock:
    """Elements of one type.

    Attributes
    ----------
    kind : str
        Meshio's name of the type, such as ``"quad8"``.
    nodes : ndarray of int64, shape (n_elements, n_nodes)
        Indices of points, in gmsh's order; of lines in any order.
    sets : dict of str to ndarray of int
        Indices of the elements of each named set.
    body : int or None
        Index of the only body that the elements can belong to, if it has a file of its own.
    """

    kind: str
    nodes: np.ndarray
    sets: dict[str, np.ndarray]
    body: int | None = None

    @property
    def dim(self) -> int:
        return _SHAPES[self.kind][0]

    @property
    def corners(self) -> int:
        return _SHAPES[self.kind][1]


@dataclass
class MeshContents:
    """Contents of a mesh file.

    Attributes
    ----------
    points : ndarray, shape (n_points, 2 or 3)
        Coordinates in the file's unit of length.
    blocks : list of CellBlock
    node_sets : dict of str to ndarray of int
    dim : int
        Dimension of the cells of bodies: 2 of a section, 3 in space.
    any_case : bool
        Whether names of sets may be written in another case of letters.
    """

    points: np.ndarray
    blocks: list[CellBlock]
    node_sets: dict[str, np.ndarray] = field(default_factory=dict)
    dim: int = 2
    any_case: bool = False

    def spelled(self, name: str) -> str:
        """Name of a set as in the file."""
        known = {*self.node_sets, *(own for block in self.blocks for own in block.sets)}
        alike = [own for own in known if own.casefold() == name.casefold()]
        return alike[0] if self.any_case and name not in known and len(alike) == 1 else name

    def names(self, dim: int) -> list[str]:
        """Names of sets of elements of a dimension."""
        found = [block.sets for block in self.blocks if block.dim == dim]
        return sorted({name for sets in found for name in sets})

    def checked(self, dim: int) -> MeshContents:
        """Copy with elements of bodies of a dimension and their surfaces, after checks of these.

        Raises
        ------
        ValueError
            If there are elements of other types, or with undefined nodes.
        """
        left_out = ("vertex",) if dim == 2 else ("vertex", "line")
        blocks = [b for b in self.blocks if not b.kind.startswith(left_out) and len(b.nodes)]
        for block in blocks:
            if block.kind not in _SHAPES:
                raise ValueError(f"cells of type {block.kind} are not supported")
            if block.dim > dim:
                raise ValueError("it has three-dimensional cells; a plane section is needed")
            if block.nodes.ndim != 2 or block.nodes.min() < 0:
                raise ValueError(f"the connectivity of cells of type {block.kind} is invalid")
            if block.nodes.max() >= len(self.points):
                raise ValueError(f"cells of type {block.kind} have undefined nodes")
            ordered = np.sort(block.nodes, axis=1) if block.dim == 1 else np.empty((0, 0))
            if np.any(ordered[:, 1:] == ordered[:, :-1]):
                raise ValueError(f"an element of type {block.kind} has a node twice")
        if self.points.ndim != 2 or self.points.shape[1] not in (2, 3):
            raise ValueError("nodes must have two or three coordinates")
        if self.points.shape[1] < dim:
            raise ValueError("the nodes of bodies in space need three coordinates")
        return MeshContents(self.points, blocks, self.node_sets, dim, self.any_case)


def joined(files: list[MeshContents]) -> MeshContents:
    """Contents of several files, each with one body, as if they were one."""
    starts = np.cumsum([0] + [len(of.points) for of in files])
    blocks: list[CellBlock] = []
    node_sets: dict[str, np.ndarray] = {}
    for body, (of, start) in enumerate(zip(files, starts, strict=False)):
        blocks += [CellBlock(b.kind, b.nodes + start, b.sets, body) for b in of.blocks]
        for name, nodes in of.node_sets.items():
            known = node_sets.get(name, np.empty(0, dtype=np.int64))
            node_sets[name] = np.concatenate([known, nodes + start])
    points = np.concatenate([of.points for of in files])
    any_case = any(of.any_case for of in files)
    return MeshContents(points, blocks, node_sets, files[0].dim, any_case)


def numbering(numbers: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Function that maps node numbers, of any shape, to indices into a list of numbers.

    Raises
    ------
    ValueError
        If a number occurs twice; the function raises it for an unknown number.
    """
    order = np.argsort(numbers, kind="stable")
    ordered = numbers[order]
    double = np.flatnonzero(ordered[1:] == ordered[:-1])
    if len(double):
        raise ValueError(f"node {ordered[double[0]]} is defined twice")

    without_gaps = len(ordered) > 0 and ordered[-1] - ordered[0] == len(ordered) - 1

    def positions(wanted: np.ndarray) -> np.ndarray:
        if without_gaps:
            at = np.clip(wanted - ordered[0], 0, len(ordered))
        else:
            at = np.searchsorted(ordered, wanted)
        missing = at == len(ordered)
        missing[~missing] = ordered[at[~missing]] != wanted[~missing]
        if missing.any():
            raise ValueError(f"node {wanted[missing][0]} of an element is not defined")
        return order[at].astype(np.int64)

    return positions


def shown(line: bytes) -> str:
    """Beginning of a line, for a message."""
    text = line.strip().decode("utf-8", "replace")
    return repr(text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…")


def parsed(text: str, where: str, between: str = " ") -> np.ndarray:
    """All numbers of a text, shape (n,).

    Parameters
    ----------
    text : str
    where : str
        Location, for the message.
    between : str
        Separator of numbers, besides blanks.

    Raises
    ------
    ValueError
        If there are other words.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # for words that are not numbers
        try:
            return np.fromstring(text, sep=between) if text.strip() else np.empty(0)
        except (DeprecationWarning, ValueError):
            words = (word[0] for word in re.finditer(f"[^\\s{between}]+", text))
            wrong = next(filter(_is_wrong, words), "")
    raise ValueError(f"{where} has {shown(wrong.encode())} where a number is expected")


def _is_wrong(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return True
    return False

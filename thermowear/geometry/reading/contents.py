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
}
"""Dimension and number of corners of the supported elements, by meshio's names."""

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
    """

    kind: str
    nodes: np.ndarray
    sets: dict[str, np.ndarray]

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
    """

    points: np.ndarray
    blocks: list[CellBlock]
    node_sets: dict[str, np.ndarray] = field(default_factory=dict)

    def names(self, dim: int) -> list[str]:
        """Names of sets of elements of a dimension."""
        found = [block.sets for block in self.blocks if block.dim == dim]
        return sorted({name for sets in found for name in sets})

    def checked(self) -> MeshContents:
        """Copy without point elements, after checks of the others.

        Raises
        ------
        ValueError
            If there are elements of other types, or with undefined nodes.
        """
        blocks = [block for block in self.blocks if block.kind != "vertex" and len(block.nodes)]
        for block in blocks:
            if block.kind not in _SHAPES:
                raise ValueError(f"cells of type {block.kind} are not supported")
            if block.nodes.ndim != 2 or block.nodes.min() < 0:
                raise ValueError(f"the connectivity of cells of type {block.kind} is invalid")
            if block.nodes.max() >= len(self.points):
                raise ValueError(f"cells of type {block.kind} have undefined nodes")
            ordered = np.sort(block.nodes, axis=1)
            if block.dim == 1 and np.any(ordered[:, 1:] == ordered[:, :-1]):
                raise ValueError(f"an element of type {block.kind} has a node twice")
        if self.points.ndim != 2 or self.points.shape[1] not in (2, 3):
            raise ValueError("nodes must have two or three coordinates")
        return MeshContents(self.points, blocks, self.node_sets)


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

    def positions(wanted: np.ndarray) -> np.ndarray:
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

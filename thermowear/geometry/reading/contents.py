"""What a mesh file holds, whatever its format: nodes, elements, and sets of them by name."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

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
"""Dimension and corners of the elements that are of use, in the words of meshio."""

_SHOWN = 40
"""Characters of a line at fault that a message repeats."""


@dataclass
class Block:
    """Elements of one type.

    Attributes
    ----------
    kind : str
        In the words of meshio, such as ``"quad8"``.
    nodes : ndarray of int64, shape (n_elements, n_nodes)
        Positions among the points, in gmsh's order; of lines in any order.
    sets : dict of str to ndarray of int
        Elements of each named set.
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

    def checked(self) -> Contents:
        """The same without single nodes as elements; all others are of use.

        Raises
        ------
        ValueError
            If there are elements of other types, or with nodes that are not there.
        """
        blocks = [block for block in self.blocks if block.kind != "vertex" and len(block.nodes)]
        for block in blocks:
            if block.kind not in _SHAPES:
                raise ValueError(f"it has cells of type {block.kind}, which are of no use here")
            if block.nodes.ndim != 2 or block.nodes.min() < 0:
                raise ValueError(f"its cells of type {block.kind} are broken")
            if block.nodes.max() >= len(self.points):
                raise ValueError(f"cells of type {block.kind} have nodes that are not there")
            ordered = np.sort(block.nodes, axis=1)
            if block.dim == 1 and np.any(ordered[:, 1:] == ordered[:, :-1]):
                raise ValueError(f"an element of type {block.kind} has a node twice")
        if self.points.ndim != 2 or self.points.shape[1] not in (2, 3):
            raise ValueError("its nodes need two or three coordinates")
        return Contents(self.points, blocks, self.node_sets)


def numbering(numbers: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Where nodes stand in a list of node numbers, as a function of wanted numbers of any shape.

    Raises
    ------
    ValueError
        If a number is there twice; the function raises it if one is not there at all.
    """
    order = np.argsort(numbers, kind="stable")
    ordered = numbers[order]
    double = np.flatnonzero(ordered[1:] == ordered[:-1])
    if len(double):
        raise ValueError(f"node {ordered[double[0]]} is there twice")

    def positions(wanted: np.ndarray) -> np.ndarray:
        at = np.searchsorted(ordered, wanted)
        missing = at == len(ordered)
        missing[~missing] = ordered[at[~missing]] != wanted[~missing]
        if missing.any():
            raise ValueError(f"node {wanted[missing][0]} of an element is not among the nodes")
        return order[at].astype(np.int64)

    return positions


def shown(line: bytes) -> str:
    """The beginning of a line, for a message."""
    text = line.strip().decode("utf-8", "replace")
    return repr(text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…")


def parsed(text: str, where: str, between: str = " ") -> np.ndarray:
    """All numbers of a text, shape (n,).

    Parameters
    ----------
    text : str
    where : str
        For the message.
    between : str
        What separates numbers, besides blanks.

    Raises
    ------
    ValueError
        If there are other words.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # of a word that is no number
        try:
            return np.fromstring(text, sep=between) if text.strip() else np.empty(0)
        except (DeprecationWarning, ValueError):
            words = (word[0].strip() for word in re.finditer(f"[^\\s{between}]+", text))
            wrong = next((word for word in words if not _is_number(word)), "")
    raise ValueError(f"{where} has {shown(wrong.encode())} where a number is due")


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True

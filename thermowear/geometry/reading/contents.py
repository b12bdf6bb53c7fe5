"""Contents of a mesh file of any format: nodes, elements, and sets with names."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from ...errors import CaseError, note
from ..checks.solid_checks import at
from ..mesh.nodes import FACETS, boundary, numbered

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


TYPES = {2: {3: "triangle", 4: "quadrilateral"}, 3: {4: "tetrahedron", 8: "hexahedron"}}
"""Cell types by dimension and number of corners."""
_FACET_TYPES = {3: "triangle", 4: "quadrilateral"}
"""Types of facets in space by number of corners."""
_TRIANGULAR = (3, 6, 10)
"""Numbers of nodes of triangles."""


@dataclass(frozen=True)
class Named:
    """Part of the case: its name, its sets in the file, and the key that defines it.

    `body` is the index of the only body it can belong to.
    """

    name: str
    sets: tuple[str, ...]
    key: str
    body: int | None = None

    @property
    def in_file(self) -> str:
        return " + ".join(self.sets)

    def members(self, block: CellBlock) -> np.ndarray:
        """Indices of the elements of a block that are in the sets."""
        names = self.sets if self._may_own(block) else ()
        found = [block.sets[name] for name in names if name in block.sets]
        return np.unique(np.concatenate([np.empty(0, dtype=np.int64), *found]))

    def cells(self, contents: MeshContents) -> list[tuple[CellBlock, np.ndarray]]:
        """Blocks with cells in the sets that can be a body's, and the indices of these cells.

        Raises
        ------
        CaseError
            If the file has no cells of a set.
        """
        blocks = [b for b in contents.blocks if b.dim == contents.dim and self._may_own(b)]
        for name in self.sets:
            if not any(len(block.sets.get(name, ())) for block in blocks):
                known = (
                    ", ".join(sorted({name for block in blocks for name in block.sets})) or "none"
                )
                raise CaseError(
                    f"{self.key}: the file has no cells named {name!r}; one of: {known}"
                )
        return [(block, at) for block in blocks if len(at := self.members(block))]

    def _may_own(self, block: CellBlock) -> bool:
        return block.body is None or self.body is None or block.body == self.body


def facets_of(
    contents: MeshContents,
    surface: Named,
    facets: Sequence[np.ndarray],
    bodies: list[Named],
    copies: int,
) -> list[np.ndarray]:
    """Boundary edges or facets of a surface that belong to each body.

    The nodes of body i are those of the file plus i * copies. Of a joint of bodies that share its
    nodes, they belong to both.
    """
    original = [of_body - i * copies for i, of_body in enumerate(facets)]
    masks = _members(contents, surface, original, bodies)
    if surface.body is not None:
        for i in set(range(len(masks))) - {surface.body}:
            masks[i][:] = False
    result = [of_body[mask] for of_body, mask in zip(facets, masks, strict=True)]
    if not any(map(len, result)):
        whose = "a body" if surface.body is None else f"body {bodies[surface.body].name!r}"
        raise CaseError(f"{surface.key}: {surface.in_file!r} is not on the boundary of {whose}")
    return result


def _members(
    contents: MeshContents, surface: Named, facets: list[np.ndarray], bodies: list[Named]
) -> list[np.ndarray]:
    """Masks of the boundary facets of each body on a surface, given by its elements or nodes."""
    (name,) = surface.sets
    dim = contents.dim - 1
    blocks = [b for b in contents.blocks if b.dim == dim and name in b.sets]
    if blocks and dim == 1:
        return _on_lines(contents, surface, [b.nodes[b.sets[name]] for b in blocks], facets, bodies)
    if blocks:
        chosen = [b.nodes[b.sets[name]][:, : b.corners] for b in blocks]
        return _on_facets(contents, surface, chosen, facets, bodies)
    if name in contents.node_sets:
        among = np.zeros(1 + max(len(contents.points), *(f.max(initial=0) for f in facets)), bool)
        among[contents.node_sets[name]] = True
        among[len(contents.points) :] = True  # nodes inside serendipity elements
        masks = [np.all(among[of_body], axis=1) for of_body in facets]
        _note_stray(contents, surface, facets, masks)
        return masks
    known = sorted({*contents.names(dim), *contents.node_sets})
    names = f"one of: {', '.join(known)}" if known else "it names no surface"
    raise CaseError(f"{surface.key}: the file has no surface named {name!r}; {names}")


def _note_stray(
    contents: MeshContents, surface: Named, facets: list[np.ndarray], masks: list[np.ndarray]
) -> None:
    """Note nodes of a set on the boundary of a body that are on no facet with all nodes in it."""
    covered = [of_body[mask] for of_body, mask in zip(facets, masks, strict=True)]
    on_boundary, on_surface = (
        np.unique(np.concatenate([of.ravel() for of in parts])) for parts in (facets, covered)
    )
    nodes = np.intersect1d(contents.node_sets[surface.sets[0]], on_boundary)
    stray = np.setdiff1d(nodes, on_surface)
    if len(stray) and len(on_surface):
        where = ", ".join(f"{x:.6g} m" for x in contents.points[stray[0]])
        note(
            f"{surface.key}: {len(stray)} of {len(nodes)} nodes of {surface.in_file!r} lie on no "
            f"facet with all nodes in it, one at ({where}); the surface may lack facets"
        )


def _on_facets(
    contents: MeshContents,
    surface: Named,
    wanted: list[np.ndarray],
    facets: list[np.ndarray],
    bodies: list[Named],
) -> list[np.ndarray]:
    """Masks of the boundary facets of each body among triangles or quadrilaterals in space."""
    masks: list[np.ndarray] = [np.zeros(len(of_body), dtype=bool) for of_body in facets]
    counts = [3 if of_body.shape[1] in _TRIANGULAR else 4 for of_body in facets]
    off, lost = sum(len(n) for n in wanted if n.shape[1] not in counts), []
    for corners in sorted(set(counts)):
        chosen = [i for i, count in enumerate(counts) if count == corners]
        own = [facets[i][:, :corners] for i in chosen]
        fitting = [nodes for nodes in wanted if nodes.shape[1] == corners]
        number, _ = numbered(np.concatenate([*own, *fitting]))
        starts = np.cumsum([len(of_body) for of_body in own])
        *of_bodies, of_surface = np.split(number, starts)
        for i, of_body in zip(chosen, of_bodies, strict=True):
            masks[i] = np.isin(of_body, of_surface)
        astray = ~np.isin(of_surface, number[: starts[-1]])
        lost.append(np.concatenate([*fitting, own[0][:0]])[astray])
    if off or any(map(len, lost)):
        _check_lost(contents, surface, lost, off, bodies)
    return masks


def _check_lost(
    contents: MeshContents, surface: Named, lost: list[np.ndarray], off: int, bodies: list[Named]
) -> None:
    """Reject facets off all boundaries, those of each kind and `off` ones of other kinds.

    Facets of further bodies in the file are ignored.
    """
    left = [nodes[~_on_others(contents, nodes, bodies)] for nodes in lost]
    count = sum(map(len, left)) + off
    if count:
        where = "" if off else f", one {at(contents.points[next(filter(len, left))[0]])}"
        raise CaseError(
            f"{surface.key}: {count} facets of {surface.in_file!r} are not on the boundary of any "
            f"body{where}"
        )


def _on_others(contents: MeshContents, corners: np.ndarray, bodies: list[Named]) -> np.ndarray:
    """Mask of facets, given by corners, on the boundary of further bodies in the file."""
    further = [corners[:0]]
    for block in contents.blocks:
        kind = TYPES[3].get(block.corners) if block.dim == 3 else None
        if kind is not None and FACETS[kind] == _FACET_TYPES[corners.shape[1]]:
            used = np.concatenate([body.members(block) for body in bodies])
            rest = np.delete(block.nodes[:, : block.corners], used, axis=0)
            further.append(boundary(kind, 1, rest))
    known = np.concatenate(further)
    number, _ = numbered(np.concatenate([known, corners]))
    return np.isin(number[len(known) :], number[: len(known)])


def _on_lines(
    contents: MeshContents,
    surface: Named,
    lines: list[np.ndarray],
    edges: list[np.ndarray],
    bodies: list[Named],
) -> list[np.ndarray]:
    """Masks of the boundary edges of each body among lines in a plane."""
    wanted = [_pairs(part) for part in lines]
    own = [_pairs(of_body[:, :2]).ravel() for of_body in edges]
    _check_lines(contents, surface, wanted, np.concatenate(own), bodies)
    every = np.concatenate([part.ravel() for part in wanted])
    return [np.isin(of_body, every) for of_body in own]


def _pairs(nodes: np.ndarray) -> np.ndarray:
    """Unique number of each pair of nodes of lines, shape (n_lines, n_pairs).

    One of them is the pair of end nodes, in whichever order a format lists the nodes.
    """
    one, other = np.triu_indices(nodes.shape[1], 1)
    low, high = (
        np.minimum(nodes[:, one], nodes[:, other]),
        np.maximum(nodes[:, one], nodes[:, other]),
    )
    return high * (high - 1) // 2 + low


def _check_lines(
    contents: MeshContents,
    surface: Named,
    wanted: list[np.ndarray],
    own: np.ndarray,
    bodies: list[Named],
) -> None:
    """Reject a surface with lines off all boundaries; those of further bodies are ignored."""
    lost = [part for lines in wanted for part in lines[~np.isin(lines, own).any(axis=1)]]
    if not lost:
        return
    others = [np.empty(0, dtype=np.int64)]
    for block in contents.blocks:
        if block.dim == 2:
            used = np.concatenate([body.members(block) for body in bodies])
            rest = np.delete(block.nodes, used, axis=0)
            corners = rest[:, : block.corners]
            ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
            others.append(_pairs(ends).ravel())
    further = np.concatenate(others)
    count = sum(not np.isin(part, further).any() for part in lost)
    if count:
        raise CaseError(
            f"{surface.key}: {count} of {sum(map(len, wanted))} lines of {surface.in_file!r} are "
            "not on the boundary of any body"
        )

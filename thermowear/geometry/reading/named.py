"""Bodies and surfaces by the names of sets in a mesh file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...errors import CaseError
from ..mesh.nodes import FACETS, boundary, numbered
from .contents import CellBlock, MeshContents
from .solid_checks import at

TYPES = {2: {3: "triangle", 4: "quadrilateral"}, 3: {4: "tetrahedron", 8: "hexahedron"}}
"""Cell types by dimension and number of corners."""
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
) -> np.ndarray:
    """Boundary edges or facets of a surface; nodes of body i are those of the file plus i * copies.

    Of a joint of bodies that share its nodes, they belong to both.
    """
    original = [of_body - i * copies for i, of_body in enumerate(facets)]
    masks = _members(contents, surface, original, bodies)
    allowed = range(len(facets)) if surface.body is None else [surface.body]
    result = np.concatenate([facets[i][masks[i]] for i in allowed])
    if not len(result):
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
        return [np.all(among[of_body], axis=1) for of_body in facets]
    known = sorted({*contents.names(dim), *contents.node_sets})
    names = f"one of: {', '.join(known)}" if known else "it names no surface"
    raise CaseError(f"{surface.key}: the file has no surface named {name!r}; {names}")


def _on_facets(
    contents: MeshContents,
    surface: Named,
    wanted: list[np.ndarray],
    facets: list[np.ndarray],
    bodies: list[Named],
) -> list[np.ndarray]:
    """Masks of the boundary facets of each body among triangles or quadrilaterals in space."""
    corners = 3 if facets[0].shape[1] in _TRIANGULAR else 4
    own = [of_body[:, :corners] for of_body in facets]
    fitting = [nodes for nodes in wanted if nodes.shape[1] == corners]
    number, _ = numbered(np.concatenate([*own, *fitting]))
    starts = np.cumsum([len(of_body) for of_body in own])
    *of_bodies, of_surface = np.split(number, starts)
    lost = ~np.isin(of_surface, number[: starts[-1]])
    off = sum(len(nodes) for nodes in wanted) - len(of_surface)
    if lost.any() or off:
        _check_lost(contents, surface, np.concatenate([*fitting, own[0][:0]])[lost], off, bodies)
    return [np.isin(of_body, of_surface) for of_body in of_bodies]


def _check_lost(
    contents: MeshContents, surface: Named, lost: np.ndarray, off: int, bodies: list[Named]
) -> None:
    """Reject facets off all boundaries; those of further bodies in the file are ignored."""
    further = [np.empty((0, lost.shape[1]), dtype=np.int64)]
    for block in contents.blocks:
        kind = TYPES[3].get(block.corners) if block.dim == 3 else None
        if kind is not None and FACETS[kind] == {3: "triangle", 4: "quadrilateral"}[lost.shape[1]]:
            used = np.concatenate([body.members(block) for body in bodies])
            rest = np.delete(block.nodes[:, : block.corners], used, axis=0)
            further.append(boundary(kind, 1, rest))
    known = np.concatenate(further)
    number, _ = numbered(np.concatenate([known, lost]))
    left = ~np.isin(number[len(known) :], number[: len(known)])
    if left.any() or off:
        where = "" if off else f", one {at(contents.points[lost[np.argmax(left)]])}"
        raise CaseError(
            f"{surface.key}: {left.sum() + off} facets of {surface.in_file!r} are not on the "
            f"boundary of any body{where}"
        )


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

"""Nodes and elements of a gmsh mesh file, formats 2 and 4."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from ..contents import CellBlock
from .numbers import Binary, Numbers, Text

_CELLS = {
    1: "line",
    8: "line3",
    26: "line4",
    2: "triangle",
    9: "triangle6",
    21: "triangle10",
    3: "quad",
    16: "quad8",
    10: "quad9",
    36: "quad16",
    15: "vertex",
}
"""gmsh's numbers of the element types of plane meshes."""
_NODES = {"line": 2, "triangle": 3, "quad": 4, "vertex": 1} | {
    name: int(re.sub(r"\D", "", name)) for name in _CELLS.values() if name[-1].isdigit()
}
_MOST_ENTITIES = 100_000
_SOLID = {4, 5, 6, 7, 11, 12, 13, 14, 17, 18, 19, 29, 30, 31, 32, 33, 90, 91, 92, 93, 94, 95}
"""gmsh's numbers of common element types in space."""


@dataclass
class Elements:
    """Elements of one type: node numbers, and the group numbers of each (-1: none)."""

    kind: str
    nodes: np.ndarray
    groups: list[np.ndarray]

    def named(self, names: dict[tuple[int, int], str], positions) -> CellBlock:
        """Block with node indices instead of numbers, and sets by the names of groups."""
        dim = {"vert": 0, "line": 1}.get(self.kind[:4], 2)
        sets: dict[str, list[np.ndarray]] = {}
        for of_groups in self.groups:
            for group in np.unique(np.abs(of_groups[of_groups != 0])):
                members = np.flatnonzero(np.abs(of_groups) == group)
                sets.setdefault(names.get((dim, int(group)), str(group)), []).append(members)
        unions = {name: np.unique(np.concatenate(parts)) for name, parts in sets.items()}
        return CellBlock(self.kind, positions(self.nodes), unions)


def _kind(number: int) -> str:
    if number in _SOLID:
        raise ValueError("it has three-dimensional cells; a plane section is needed")
    if number not in _CELLS:
        raise ValueError(f"elements of gmsh's type {number} are not supported")
    return _CELLS[number]


def nodes_2(source: Numbers) -> tuple[np.ndarray, np.ndarray]:
    """Numbers and coordinates of the nodes."""
    count = source.one() if source.count is None else source.count
    if isinstance(source, Binary):
        rows = source.records(count, [("tag", "int", 1), ("x", "real", 3)])
        return rows["tag"][:, 0].astype(np.int64), rows["x"].astype(np.float64)
    table = source.reals(4 * count).reshape(-1, 4)
    return table[:, 0].astype(np.int64), table[:, 1:]


def elements_2(source: Numbers, binary: bool) -> list[Elements]:
    """Rows of number, type, tags (the first is the physical group) and nodes."""
    left = source.one() if source.count is None else source.count
    nodes: dict[str, list[np.ndarray]] = {}
    groups: dict[str, list[np.ndarray]] = {}
    while left > 0:
        if binary:
            number, count, tags = (int(n) for n in source.integers(3))
            kind = _kind(number)
            rows = source.integers(count * (1 + max(tags, 0) + _NODES[kind]))
            rows = rows.reshape(max(count, 0), -1)[:, 1:]
        else:
            kind, tags, rows = _uniform_rows(source, left)
        if not 0 < len(rows) <= left:
            raise ValueError("the section $Elements contradicts its number of elements")
        left -= len(rows)
        nodes.setdefault(kind, []).append(rows[:, tags:])
        groups.setdefault(kind, []).append(rows[:, 0] if tags else np.zeros(len(rows), np.int64))
    return [
        Elements(kind, np.concatenate(parts), [np.concatenate(groups[kind])])
        for kind, parts in nodes.items()
    ]


def _uniform_rows(source: Numbers, left: int) -> tuple[str, int, np.ndarray]:
    """Type, number of tags, tags and nodes of the next text rows of equal layout."""
    assert isinstance(source, Text)
    values = source.values[source.at :]
    if len(values) < 3 or not np.isfinite(values[:3]).all():
        raise source.ends_early()
    kind, tags = _kind(int(values[1])), int(values[2])
    width = 3 + tags + _NODES[kind]
    most = min(left, len(values) // width) if tags >= 0 else 0
    if not most:
        raise source.ends_early()
    count = 1
    while count < most:
        count = min(2 * count, most)
        head = values[: count * width].reshape(count, width)[:, 1:3]
        same = np.all(head == values[1:3], axis=1)
        if not same.all():
            count = int(same.argmin())
            break
    return kind, tags, source.integers(count * width).reshape(count, width)[:, 3:]


def _check_entity_count(count: int) -> None:
    if count > _MOST_ENTITIES:
        raise ValueError(f"it has more than {_MOST_ENTITIES} entities")


def entities(source: Numbers, minor: int) -> dict[tuple[int, int], list[int]]:
    """Physical groups of the entities, by dimension and number."""
    groups: dict[tuple[int, int], list[int]] = {}
    counts = source.integers(4, "size")
    _check_entity_count(int(counts.sum()))
    for dim, count in enumerate(counts):
        for _ in range(count):
            tag = source.one()
            source.reals(3 if dim == 0 and minor >= 1 else 6)
            groups[dim, tag] = [int(n) for n in source.integers(source.one("size"))]
            if dim > 0:
                source.integers(source.one("size"))
    return groups


def nodes_4(source: Numbers, minor: int) -> tuple[np.ndarray, np.ndarray]:
    """Numbers and coordinates of the nodes, entity by entity."""
    blocks, total = (int(n) for n in source.integers(2, "size"))
    if minor >= 1:
        source.integers(2, "size")
    _check_entity_count(blocks)
    tags: list[np.ndarray] = [np.empty(0, dtype=np.int64)]
    points: list[np.ndarray] = [np.empty((0, 3))]
    for _ in range(blocks):
        head = source.integers(3)
        dim, parametric = int(head[0 if minor >= 1 else 1]), int(head[2])
        count, width = source.one("size"), 3 + (dim if parametric else 0)
        if minor >= 1:
            tags.append(source.integers(count, "size"))
            points.append(source.reals(count * width).reshape(-1, width)[:, :3])
        else:
            rows = source.reals(count * (1 + width)).reshape(-1, 1 + width)
            tags.append(rows[:, 0].astype(np.int64))
            points.append(rows[:, 1:4])
    found = np.concatenate(tags)
    if len(found) != total:
        raise ValueError(f"the section $Nodes announces {total} nodes and has {len(found)}")
    return found, np.concatenate(points)


def elements_4(source: Numbers, minor: int, groups) -> list[Elements]:
    """Elements, entity by entity, in the groups of the entity."""
    blocks, total = (int(n) for n in source.integers(2, "size"))
    if minor >= 1:
        source.integers(2, "size")
    _check_entity_count(blocks)
    result = []
    for _ in range(blocks):
        one, other, number = (int(n) for n in source.integers(3))
        entity = (one, other) if minor >= 1 else (other, one)
        kind, count = _kind(number), source.one("size")
        width = 1 + _NODES[kind]
        nodes = source.integers(count * width, "size").reshape(-1, width)[:, 1:]
        of_all = [np.full(count, group) for group in groups.get(entity, [])]
        result.append(Elements(kind, nodes, of_all))
        total -= count
    if total:
        raise ValueError("the section $Elements contradicts its number of elements")
    return result

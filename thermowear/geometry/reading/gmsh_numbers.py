"""Nodes and elements of a gmsh mesh file, formats 2 and 4, written as text or binary."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from .contents import CellBlock, parsed

_CELLS = {1: "line", 8: "line3", 26: "line4", 2: "triangle", 9: "triangle6", 21: "triangle10"}
_CELLS |= {3: "quad", 16: "quad8", 10: "quad9", 36: "quad16", 15: "vertex"}
_CELLS |= {4: "tetra", 11: "tetra10", 29: "tetra20"}
_CELLS |= {5: "hexahedron", 17: "hexahedron20", 12: "hexahedron27", 92: "hexahedron64"}
"""gmsh's numbers of the element types."""
_NODES = {"line": 2, "triangle": 3, "quad": 4, "vertex": 1, "tetra": 4, "hexahedron": 8} | {
    name: int(re.sub(r"\D", "", name)) for name in _CELLS.values() if name[-1].isdigit()
}
_OTHER_SOLIDS = {6: "prisms", 13: "prisms", 18: "prisms", 7: "pyramids", 14: "pyramids"}
_OTHER_SOLIDS |= {19: "pyramids", 90: "prisms", 91: "prisms", 118: "pyramids"}
"""gmsh's numbers of common element types in space that are not supported."""
_MOST_ENTITIES = 100_000


class Numbers(ABC):
    """Numbers of a section, read sequentially."""

    name: str
    count: int | None = None
    """Count that a binary section of format 2 gives as text at its beginning."""

    @abstractmethod
    def rows(self, count: int, *fields: tuple[str, int]) -> list[np.ndarray]:
        """Next rows of fields, each ``"int"``, ``"size"`` or ``"real"`` and its length.

        One array of shape (count, length) per field.
        """

    @abstractmethod
    def left_over(self) -> bool:
        """Test whether there are more data, such as commands."""

    def integers(self, count: int, kind: str = "int") -> np.ndarray:
        return self.rows(count, (kind, 1))[0][:, 0]

    def one(self, kind: str = "int") -> int:
        return int(self.integers(1, kind)[0])

    def counts(self, minor: int) -> tuple[int, int]:
        """Number of entities, and of all their nodes or elements."""
        blocks, total = (int(n) for n in self.integers(2, "size"))
        if minor >= 1:
            self.integers(2, "size")
        _check_entity_count(blocks)
        return blocks, total

    def ends_early(self) -> ValueError:
        return ValueError(f"the section ${self.name} holds fewer numbers than announced")


class Text(Numbers):
    """Numbers as text, separated by blanks."""

    def __init__(self, name: str, body: bytes):
        self.name, self.at = name, 0
        self.values = parsed(body.decode("latin-1"), f"the section ${name}")

    def rows(self, count, *fields):
        width = sum(length for _, length in fields)
        if not 0 <= count * width <= len(self.values) - self.at:
            raise self.ends_early()
        self.at += count * width
        table = self.values[self.at - count * width : self.at].reshape(count, width)
        parts = np.split(table, np.cumsum([length for _, length in fields])[:-1], axis=1)
        return [
            part if kind == "real" else self._whole(part)
            for (kind, _), part in zip(fields, parts, strict=True)
        ]

    def _whole(self, values: np.ndarray) -> np.ndarray:
        if not np.all(np.abs(values) < 2**53) or np.any(values != np.rint(values)):
            raise ValueError(
                f"the section ${self.name} has real numbers where integers are expected"
            )
        return values.astype(np.int64)

    def left_over(self) -> bool:
        return self.at < len(self.values)


class Binary(Numbers):
    """Binary numbers of a byte order (``"<"`` or ``">"``), with a ``size_t`` of `size` bytes."""

    def __init__(self, name: str, body: bytes, order: str, size: int, count: int | None):
        self.name, self.body, self.at, self.count = name, body, 0, count
        self.kinds = {"int": f"{order}i4", "size": f"{order}u{size}", "real": f"{order}f8"}

    def rows(self, count, *fields):
        row = np.dtype([(str(k), self.kinds[kind], (n,)) for k, (kind, n) in enumerate(fields)])
        size = count * row.itemsize
        if not 0 <= size <= len(self.body) - self.at:
            raise self.ends_early()
        self.at += size
        table = np.frombuffer(self.body, row, count, self.at - size)
        return [
            table[str(k)].astype(np.float64 if kind == "real" else np.int64)
            for k, (kind, _) in enumerate(fields)
        ]

    def left_over(self) -> bool:
        return bool(self.body[self.at :].strip())


@dataclass
class Elements:
    """Elements of one type: node numbers, and the group numbers of each (-1: none)."""

    kind: str
    nodes: np.ndarray
    groups: list[np.ndarray]

    def named(self, names: dict[tuple[int, int], str], positions) -> CellBlock:
        """Block with node indices instead of numbers, and sets by the names of groups."""
        dim = {"vert": 0, "line": 1, "tetr": 3, "hexa": 3}.get(self.kind[:4], 2)
        sets: dict[str, list[np.ndarray]] = {}
        for of_groups in self.groups:
            for group in np.unique(np.abs(of_groups[of_groups != 0])):
                members = np.flatnonzero(np.abs(of_groups) == group)
                sets.setdefault(names.get((dim, int(group)), str(group)), []).append(members)
        unions = {name: np.unique(np.concatenate(parts)) for name, parts in sets.items()}
        return CellBlock(self.kind, positions(self.nodes), unions)


def _kind(number: int) -> str:
    if number in _OTHER_SOLIDS:
        raise ValueError(
            f"{_OTHER_SOLIDS[number]} (gmsh's type {number}) are not supported; cells in space are "
            "tetrahedra or hexahedra"
        )
    if number not in _CELLS:
        raise ValueError(f"elements of gmsh's type {number} are not supported")
    return _CELLS[number]


def _check_entity_count(count: int) -> None:
    if count > _MOST_ENTITIES:
        raise ValueError(f"it has more than {_MOST_ENTITIES} entities")


def nodes_2(source: Numbers) -> tuple[np.ndarray, np.ndarray]:
    """Numbers and coordinates of the nodes."""
    count = source.one() if source.count is None else source.count
    tags, points = source.rows(count, ("int", 1), ("real", 3))
    return tags[:, 0], points


def elements_2(source: Numbers) -> list[Elements]:
    """Rows of number, type, tags (the first is the physical group) and nodes."""
    left = source.one() if source.count is None else source.count
    nodes: dict[str, list[np.ndarray]] = {}
    groups: dict[str, list[np.ndarray]] = {}
    while left > 0:
        if isinstance(source, Text):
            kind, tags, rows = _uniform_rows(source, left)
        else:
            number, count, tags = (int(n) for n in source.integers(3))
            kind = _kind(number)
            rows = source.rows(count, ("int", 1 + max(tags, 0) + _NODES[kind]))[0][:, 1:]
        if not 0 < len(rows) <= left:
            raise ValueError("the section $Elements contradicts its number of elements")
        left -= len(rows)
        nodes.setdefault(kind, []).append(rows[:, tags:])
        groups.setdefault(kind, []).append(rows[:, 0] if tags else np.zeros(len(rows), np.int64))
    return [
        Elements(kind, np.concatenate(parts), [np.concatenate(groups[kind])])
        for kind, parts in nodes.items()
    ]


def _uniform_rows(source: Text, left: int) -> tuple[str, int, np.ndarray]:
    """Type, number of tags, tags and nodes of the next rows of equal layout."""
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
    return kind, tags, source.rows(count, ("int", width))[0][:, 3:]


def entities(source: Numbers, minor: int) -> dict[tuple[int, int], list[int]]:
    """Physical groups of the entities, by dimension and number."""
    groups: dict[tuple[int, int], list[int]] = {}
    counts = source.integers(4, "size")
    _check_entity_count(int(counts.sum()))
    for dim, count in enumerate(counts):
        for _ in range(count):
            tag = source.one()
            source.rows(1, ("real", 3 if dim == 0 and minor >= 1 else 6))
            groups[dim, tag] = [int(n) for n in source.integers(source.one("size"))]
            if dim > 0:
                source.integers(source.one("size"))
    return groups


def nodes_4(source: Numbers, minor: int) -> tuple[np.ndarray, np.ndarray]:
    """Numbers and coordinates of the nodes, entity by entity."""
    blocks, total = source.counts(minor)
    tags: list[np.ndarray] = [np.empty(0, dtype=np.int64)]
    points: list[np.ndarray] = [np.empty((0, 3))]
    for _ in range(blocks):
        head = source.integers(3)
        dim, parametric = int(head[0 if minor >= 1 else 1]), int(head[2])
        count, width = source.one("size"), 3 + (dim if parametric else 0)
        if minor >= 1:
            numbers = source.integers(count, "size")
            places = source.rows(count, ("real", width))[0]
        else:
            rows = source.rows(count, ("real", 1 + width))[0]
            numbers, places = rows[:, 0].astype(np.int64), rows[:, 1:]
        tags.append(numbers)
        points.append(places[:, :3])
    found = np.concatenate(tags)
    if len(found) != total:
        raise ValueError(f"the section $Nodes announces {total} nodes and has {len(found)}")
    return found, np.concatenate(points)


def elements_4(source: Numbers, minor: int, groups) -> list[Elements]:
    """Elements, entity by entity, in the groups of the entity."""
    blocks, total = source.counts(minor)
    result = []
    for _ in range(blocks):
        one, other, number = (int(n) for n in source.integers(3))
        entity = (one, other) if minor >= 1 else (other, one)
        kind, count = _kind(number), source.one("size")
        nodes = source.rows(count, ("size", 1 + _NODES[kind]))[0][:, 1:]
        if groups and entity not in groups:
            raise ValueError(f"elements lie on the entity {entity}, which $Entities does not list")
        of_all = [np.full(count, group) for group in groups.get(entity, [])]
        result.append(Elements(kind, nodes, of_all))
        total -= count
    if total:
        raise ValueError("the section $Elements contradicts its number of elements")
    return result

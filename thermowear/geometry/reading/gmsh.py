"""Reader of gmsh meshes: ``.msh`` of the formats 2 and 4, as text or binary.

gmsh itself executes a file that does not begin as a mesh as a script, so it is never used to
open one. The grammar is in the reference manual of gmsh, section "MSH file format".
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .contents import CellBlock, MeshContents, numbering, parsed, shown

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


_NUMBERS = ("Entities", "Nodes", "Elements")
_READ = ("MeshFormat", "PhysicalNames", *_NUMBERS)
_PASSED_OVER = (
    *("Comments", "Periodic", "PartitionedEntities", "GhostElements", "Parametrizations"),
    *("NodeData", "ElementData", "ElementNodeData", "InterpolationScheme"),
)
_SECTION = re.compile(rb"\$(\w+)[ \t]*\r?\n")
_NAME = re.compile(r'\s*(\d+)\s+(-?\d+)\s+"([^"\n]*)"\s*')


def read_gmsh(data: bytes) -> MeshContents:
    """Read the bytes of a file.

    Raises
    ------
    ValueError
        If it is not a mesh, or malformed.
    """
    sections = dict(_sections(data))
    for name in ("MeshFormat", "Nodes", "Elements"):
        if name not in sections:
            raise ValueError(f"it has no section ${name}")
    form = _format(sections["MeshFormat"])
    names = _physical_names(sections.get("PhysicalNames", b""))
    sources = {name: form.numbers(sections, name) for name in _NUMBERS if name in sections}
    if form.version == 2:
        sources.pop("Entities", None)
        tags, points = nodes_2(sources["Nodes"])
        blocks = elements_2(sources["Elements"])
    else:
        groups = entities(sources["Entities"], form.minor) if "Entities" in sources else {}
        tags, points = nodes_4(sources["Nodes"], form.minor)
        blocks = elements_4(sources["Elements"], form.minor, groups)
    for source in sources.values():
        if source.left_over():
            raise ValueError(f"the section ${source.name} holds more data than announced")
    positions = numbering(tags)
    return MeshContents(points, [block.named(names, positions) for block in blocks])


def _sections(data: bytes) -> Iterator[tuple[str, bytes]]:
    """Name and body of each section; a mesh contains nothing else."""
    at = 0
    found: set[str] = set()
    while at < len(data):
        start = _SECTION.match(data, at)
        if start is None:
            if data[at : at + 1].isspace():
                at += 1
                continue
            line, number = data[at:].split(b"\n", 1)[0], 1 + data.count(b"\n", 0, at)
            raise ValueError(
                f"line {number}, {shown(line)}, belongs to no section of a "
                "mesh; commands are never executed"
            )
        name = start[1].decode("ascii", "replace")
        if name not in (*_READ, *_PASSED_OVER):
            raise ValueError(f"the section ${name} is not part of a mesh")
        if name in found and name in _READ:
            raise ValueError(f"the section ${name} occurs twice")
        end = data.find(b"$End" + start[1], start.end())
        if end < 0:
            raise ValueError(f"the section ${name} has no end")
        if not found - {"Comments"} and name not in ("MeshFormat", "Comments"):
            raise ValueError("it does not begin with $MeshFormat")
        found.add(name)
        yield name, data[start.end() : end]
        at = end + len(b"$End") + len(name)


@dataclass(frozen=True)
class _Format:
    """Major and minor version, byte order (empty: text), and number of bytes of a ``size_t``."""

    version: int
    minor: int
    order: str
    size: int

    def numbers(self, sections: dict[str, bytes], name: str) -> Numbers:
        body, count = sections[name], None
        if not self.order:
            return Text(name, body)
        if self.version == 2:
            first, _, body = body.partition(b"\n")
            count = int(first)
        return Binary(name, body, self.order, self.size, count)


def _format(body: bytes) -> _Format:
    first, _, rest = body.partition(b"\n")
    words = first.split()
    version, _, minor = words[0].decode("ascii").partition(".") if words else ("", "", "")
    if len(words) != 3 or version not in ("2", "4") or minor[:1] not in ("", "0", "1", "2"):
        raise ValueError(
            f"the format {shown(first)} is not supported; save it as version 4.1 or 2.2"
        )
    size = int(words[2])
    if words[1] == b"0":
        return _Format(int(version), int(minor[:1] or 0), "", size)
    order = {b"\1\0\0\0": "<", b"\0\0\0\1": ">"}.get(rest[:4])
    if order is None or size not in (4, 8) or (version == "4" and minor[:1] in ("", "0")):
        raise ValueError("this type of binary file is not supported; save it as version 4.1")
    return _Format(int(version), int(minor[:1] or 0), order, size)


def _physical_names(body: bytes) -> dict[tuple[int, int], str]:
    """Names by dimension and number of their group."""
    first, *lines = body.decode("utf-8", "replace").strip().splitlines() or ["0"]
    found: dict[tuple[int, int], str] = {}
    for line in lines:
        entry = _NAME.fullmatch(line)
        if entry is None:
            raise ValueError(f"{shown(line.encode())} is not a physical name")
        if found.setdefault((int(entry[1]), int(entry[2])), entry[3]) != entry[3]:
            raise ValueError(f"the group {entry[2]} of dimension {entry[1]} has two names")
    if first.strip() != str(len(found)):
        raise ValueError(
            f"the section $PhysicalNames announces {first.strip()} names and has {len(found)}"
        )
    return found

"""Reader of nodes, elements and their sets from an Abaqus input file.

Supported are ``*NODE``, ``*ELEMENT``, ``*NSET``, ``*ELSET`` and ``*SURFACE``. Parts and
assemblies are read as if they were one. Cards that generate or move nodes and elements, or
include other files, are rejected; all others (materials, steps) are skipped.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator

import numpy as np

from .contents import VTK_ORDER, CellBlock, MeshContents, numbering, parsed

_PLANE = re.compile(r"(CPS|CPE|CPEG|CAX|M3D|STRI|S|DC2D|DCAX|WARP2D|R3D)(3|4|6|8|9)(?!\d)")
_SOLID = re.compile(r"(C3D|DC3D|DCC3D)(4|8|10|20|27)(?!\d)")
_LINE = re.compile(r"(T2D|T3D|B2|B3|SAX|R2D|RAX|DC1D|W2D|W3D)\d*")
_SIDE = re.compile(r"S([1-6]|POS|NEG)", re.IGNORECASE)
_CELLS = {3: "triangle", 4: "quad", 6: "triangle6", 8: "quad8", 9: "quad9"}
_SOLIDS = {4: "tetra", 10: "tetra10", 8: "hexahedron", 20: "hexahedron20", 27: "hexahedron27"}
_ORDERS = VTK_ORDER | {
    "hexahedron27": [*VTK_ORDER["hexahedron27"][:20], 21, 23, 26, 24, 25, 22, 20]
}
_SIDES = {
    "triangle": np.array([(0, 1), (1, 2), (2, 0)]),
    "quad": np.array([(0, 1), (1, 2), (2, 3), (3, 0)]),
    "tetra": np.array([(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)]),
    "hexahedron": np.array(
        [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]
    ),
}
"""Corners of the sides S1, S2, … of elements."""
_SHELL_FACES = {"triangle": np.array([(0, 1, 2)]), "quad": np.array([(0, 1, 2, 3)])}
"""Corners of the sides SPOS and SNEG of shells and membranes, which cover cells in space."""
_NO_SIDES = np.empty((0, 2), dtype=np.int64)
_FACETS = {2: "line", 3: "triangle", 4: "quad"}
_LINES = {2: "line", 3: "line3"}
_REFUSED = {
    "INCLUDE": "includes another file; a mesh must be in one file",
    "MANIFEST": "includes other files; a mesh must be in one file",
    "SYSTEM": "transforms coordinates; write the nodes in global coordinates",
    **dict.fromkeys(
        ("NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY"),
        "generates nodes or elements; write all of them",
    ),
}
"""Unsupported cards that would change the mesh."""
_MOST_SETS = 10_000
_READ = ("NODE", "ELEMENT", "NSET", "ELSET", "SURFACE")

Member = int | str | tuple[int, int, int] | np.ndarray
"""Member of a set: a number, the name of another set, a range (first, last, step), or numbers."""


def read_abaqus(text: str, dim: int = 2) -> MeshContents:
    """Read the text of an input file with bodies of a dimension.

    Raises
    ------
    ValueError
        If it is malformed, or has cards that would change the mesh.
    """
    deck = _Deck(dim)
    for keyword, options, lines in _cards(text):
        if keyword in _REFUSED:
            raise ValueError(f"*{keyword} {_REFUSED[keyword]}")
        if keyword == "INSTANCE" and lines:
            raise ValueError("*INSTANCE moves a part; write the nodes in global coordinates")
        if keyword in _READ:
            if options.keys() & {"INPUT", "FILE"}:
                raise ValueError(f"*{keyword} includes another file; a mesh must be in one file")
            getattr(deck, f"read_{keyword.lower()}")(options, lines)
    return deck.result()


def _cards(text: str) -> Iterator[tuple[str, dict[str, str], list[str]]]:
    """Keyword, options and data lines of each card."""
    keyword, lines = "", []
    options: dict[str, str] = {}
    for line in text.splitlines():
        if line.startswith("**") or not line.strip():
            continue
        if not line.startswith("*"):
            lines.append(line.strip().rstrip(","))
            continue
        yield keyword, options, lines
        first, *rest = line[1:].split(",")
        pairs = [part.partition("=") for part in rest]
        options = {key.strip().upper(): value.strip().strip('"') for key, _, value in pairs}
        keyword, lines = first.strip().upper(), []
    yield keyword, options, lines


class _Deck:
    """Parser state; numbers are those of the file."""

    def __init__(self, dim: int) -> None:
        self.dim = dim
        self.tags: list[np.ndarray] = [np.empty(0, dtype=np.int64)]
        self.points: list[np.ndarray] = [np.empty((0, 3))]
        self.elements: defaultdict[str, list[tuple[np.ndarray, np.ndarray]]] = defaultdict(list)
        self.node_sets: defaultdict[str, list[Member]] = defaultdict(list)
        self.element_sets: defaultdict[str, list[Member]] = defaultdict(list)
        self.surfaces: dict[str, list[tuple[int | str, int]]] = {}

    def read_node(self, options, lines) -> None:
        if options.get("SYSTEM", "R").upper() != "R":
            raise ValueError("*NODE, SYSTEM= is not Cartesian; write x, y and z")
        table = _table(lines)[:, :4]
        self.tags.append(_whole(table[:, 0]))
        self.points.append(np.pad(table[:, 1:], ((0, 0), (0, 4 - table.shape[1]))))
        if "NSET" in options:
            self.node_sets[options["NSET"]].append(self.tags[-1])

    def read_element(self, options, lines) -> None:
        kind, words = options.get("TYPE", "").upper(), len(lines[0].split(",")) if lines else 0
        if plane := _PLANE.match(kind):
            count, names = int(plane[2]), _CELLS
        elif self.dim == 3 and (solid := _SOLID.match(kind)):
            count, names = int(solid[2]), _SOLIDS
        elif _LINE.match(kind) and words - 1 in _LINES:
            count, names = words - 1, _LINES
        else:
            raise ValueError(f"elements of type {kind or '?'} are not supported")
        flat = _whole(parsed(",".join(lines), f"*ELEMENT, TYPE={kind}", ","))
        if len(flat) % (count + 1):
            raise ValueError(f"an element of type {kind} does not have {count} nodes")
        table = flat.reshape(-1, count + 1)
        order = 1 + np.array(_ORDERS.get(names[count], range(count)))
        self.elements[names[count]].append((table[:, 0], table[:, order]))
        if "ELSET" in options:
            self.element_sets[options["ELSET"]].append(table[:, 0])

    def read_nset(self, options, lines) -> None:
        self.node_sets[options.get("NSET", "")] += _members(options, lines)

    def read_elset(self, options, lines) -> None:
        self.element_sets[options.get("ELSET", "")] += _members(options, lines)

    def read_surface(self, options, lines) -> None:
        name, kind = options.get("NAME", ""), options.get("TYPE", "ELEMENT").upper()
        rows = [_words(line) for line in lines]
        if kind == "NODE":
            self.node_sets[name] += [_member(row[0]) for row in rows if row[0]]
        elif kind == "ELEMENT" and all(len(row) > 1 and _SIDE.fullmatch(row[1]) for row in rows):
            self.surfaces[name] = [(_member(row[0]), _side(row[1])) for row in rows]

    def result(self) -> MeshContents:
        if max(len(self.node_sets), len(self.element_sets), len(self.surfaces)) > _MOST_SETS:
            raise ValueError(f"it has more than {_MOST_SETS} sets")
        tags, points = self._nodes()
        positions = numbering(tags)
        merged = {
            kind: tuple(map(np.concatenate, zip(*cards, strict=True)))
            for kind, cards in self.elements.items()
        }
        elements = np.concatenate([np.empty(0, int), *(numbers for numbers, _ in merged.values())])
        numbers, count = np.unique(elements, return_counts=True)
        for number in numbers[count > 1]:
            raise ValueError(
                f"element {number} is defined twice; numbers must also differ between parts"
            )
        sets = {name: _resolved(name, self.element_sets, elements) for name in self.element_sets}
        blocks = []
        for kind, (numbers, nodes) in merged.items():
            own = {n: np.flatnonzero(np.isin(numbers, found)) for n, found in sets.items()}
            blocks.append(
                CellBlock(kind, positions(nodes), {n: at for n, at in own.items() if len(at)})
            )
        for name, sides in self.surfaces.items():
            for parts in _facets(merged, sides, sets).values():
                nodes = positions(np.concatenate(parts))
                kind = _FACETS[nodes.shape[1]]
                blocks.append(CellBlock(kind, nodes, {name: np.arange(len(nodes))}))
        resolved = {name: _resolved(name, self.node_sets, tags) for name in self.node_sets}
        node_sets = {name: np.sort(positions(found)) for name, found in resolved.items()}
        return MeshContents(points, blocks, node_sets)

    def _nodes(self) -> tuple[np.ndarray, np.ndarray]:
        """Numbers and coordinates; duplicate nodes must have equal coordinates."""
        tags, points = np.concatenate(self.tags), np.concatenate(self.points)
        order = np.argsort(tags, kind="stable")
        again = np.zeros(len(tags), dtype=bool)
        again[1:] = tags[order[1:]] == tags[order[:-1]]
        moved = again[1:] & np.any(points[order[1:]] != points[order[:-1]], axis=1)
        if moved.any():
            number = tags[order[1:]][moved][0]
            raise ValueError(
                f"node {number} is defined twice; numbers must also differ between parts"
            )
        kept = np.sort(order[~again])
        return tags[kept], points[kept]


def _facets(
    elements: dict[str, tuple[np.ndarray, ...]], sides: list[tuple[int | str, int]], sets: dict
) -> dict[int, list[np.ndarray]]:
    """Corners (n, n_corners) of sides of elements, or of the elements of sets, by n_corners.

    Side 0 is the element itself, a facet of a cell in space.
    """
    members: dict[int, list[np.ndarray]] = {}
    for of, side in sides:
        found = np.array([of]) if isinstance(of, int) else sets.get(of, np.empty(0, int))
        members.setdefault(side, []).append(found)
    result: dict[int, list[np.ndarray]] = {}
    for side, parts in members.items():
        for kind, (numbers, nodes) in elements.items():
            every = (_SIDES if side else _SHELL_FACES).get(kind.rstrip("0123456789"), _NO_SIDES)
            chosen = np.isin(numbers, np.concatenate(parts))
            for corners in every[max(side - 1, 0) :][:1] if chosen.any() else ():
                result.setdefault(len(corners), []).append(nodes[chosen][:, corners])
    return result


def _words(line: str) -> list[str]:
    return [part.strip() for part in line.split(",")]


def _table(lines: list[str]) -> np.ndarray:
    """Numbers of the lines of one card; missing entries are 0, shape (n, at least 4)."""
    widths = {line.count(",") for line in lines}
    if len(widths) == 1 and not any(",," in line or ", ," in line for line in lines):
        return parsed(",".join(lines), "*NODE", ",").reshape(len(lines), -1)
    rows = [[*_words(line), "", "", ""][:4] for line in lines]
    return np.array([[float(word or 0.0) for word in row] for row in rows]).reshape(-1, 4)


def _whole(values: np.ndarray) -> np.ndarray:
    """Convert numbers of nodes or elements to integers."""
    if not np.all(np.abs(values) < 2**53) or np.any(values != np.rint(values)):
        raise ValueError("the number of a node or an element is not an integer")
    return values.astype(np.int64)


def _side(label: str) -> int:
    return int(label[1:]) if label[1:].isdigit() else 0


def _member(word: str) -> int | str:
    return int(word) if word.isdigit() else word


def _members(options, lines) -> Iterator[Member]:
    """Members of a card: numbers, ranges, or names of other sets."""
    for line in lines:
        words = [word for word in _words(line) if word]
        if "GENERATE" in options:
            first, last, *step = (int(word) for word in words)
            yield first, last, step[0] if step else 1
        else:
            yield from map(_member, words)


def _resolved(name: str, sets: dict[str, list[Member]], known: np.ndarray) -> np.ndarray:
    """Numbers of a set that exist in the mesh; others in a range are left out.

    The cost of a range is that of the numbers in the mesh, regardless of its length.
    """
    found: list[np.ndarray] = [np.empty(0, dtype=np.int64)]
    waiting, seen = [name], {name}
    while waiting:
        members = sets.get(waiting.pop(), [])
        found.append(np.array([m for m in members if isinstance(m, int)], dtype=np.int64))
        found += [m for m in members if isinstance(m, np.ndarray)]
        for member in members:
            if isinstance(member, str) and member not in seen:
                seen.add(member)
                waiting.append(member)
            elif isinstance(member, tuple):
                first, last, step = member
                if step < 1:
                    raise ValueError(f"the set {name} has a range with the step {step}")
                inside = (known >= first) & (known <= last) & ((known - first) % step == 0)
                found.append(known[inside])
    return np.unique(np.concatenate(found))

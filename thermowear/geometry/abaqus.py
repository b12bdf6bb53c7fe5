"""Reading nodes, elements and their sets from an Abaqus input file.

Understood are ``*NODE``, ``*ELEMENT``, ``*NSET``, ``*ELSET`` and ``*SURFACE``. Parts and assemblies
are read as if they were one. Cards that make or move nodes and elements are refused, as are other
files; the rest (materials, steps) is passed over.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from .contents import Block, Contents, numbering

_PLANE = re.compile(r"(CPS|CPE|CPEG|CAX|M3D|STRI|S|DC2D|DCAX|WARP2D|R3D)(3|4|6|8|9)(?!\d)")
_LINE = re.compile(r"(T2D|T3D|B2|B3|SAX|R2D|RAX|DC1D|W2D|W3D)\d*")
_CELLS = {3: "triangle", 4: "quad", 6: "triangle6", 8: "quad8", 9: "quad9"}
_CORNERS = {3: 3, 4: 4, 6: 3, 8: 4, 9: 4}
_LINES = {2: "line", 3: "line3"}
_REFUSED = {
    "INCLUDE": "takes in another file; a mesh has to be in one file",
    "MANIFEST": "takes in other files; a mesh has to be in one file",
    "SYSTEM": "turns the coordinates of nodes; write the nodes as they lie",
    **dict.fromkeys(
        ("NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY"),
        "makes nodes or elements; write all of them",
    ),
}
"""Cards that would change the mesh."""
_READ = ("NODE", "ELEMENT", "NSET", "ELSET", "SURFACE")

Member = int | str | tuple[int, int, int]
"""Of a set: a number, the name of another set, or a range (first, last, step)."""


def read_abaqus(text: str) -> Contents:
    """Read the text of an input file.

    Raises
    ------
    ValueError
        If it is broken, or has cards that would change the mesh.
    """
    deck = _Deck()
    for keyword, options, lines in _cards(text):
        if keyword in _REFUSED:
            raise ValueError(f"*{keyword} {_REFUSED[keyword]}")
        if keyword == "INSTANCE" and lines:
            raise ValueError("*INSTANCE moves a part; write the nodes as they lie")
        if keyword in _READ:
            if "INPUT" in options:
                raise ValueError(f"*{keyword} takes in another file; a mesh has to be in one file")
            read = getattr(deck, f"read_{keyword.lower()}")
            read(options, [[part.strip() for part in line.split(",")] for line in lines])
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
    """What has been read so far; numbers are those of the file."""

    def __init__(self) -> None:
        self.points: dict[int, list[float]] = {}
        self.blocks: list[tuple[str, int, dict[int, list[int]]]] = []
        self.node_sets: dict[str, list[Member]] = {}
        self.element_sets: dict[str, list[Member]] = {}
        self.surfaces: dict[str, list[tuple[int | str, int]]] = {}

    def read_node(self, options, rows) -> None:
        if options.get("SYSTEM", "R").upper() != "R":
            raise ValueError("*NODE, SYSTEM= is no Cartesian one; write x, y and z")
        for number, *place in rows:
            x = [float(value or 0.0) for value in (*place, 0.0, 0.0)[:3]]
            if self.points.setdefault(int(number), x) != x:
                raise ValueError(
                    f"node {number} is there twice; numbers must differ between parts too"
                )
            if "NSET" in options:
                self.node_sets.setdefault(options["NSET"], []).append(int(number))

    def read_element(self, options, rows) -> None:
        kind = options.get("TYPE", "").upper()
        flat = [int(part) for row in rows for part in row]
        plane = _PLANE.match(kind)
        if plane:
            count, corners = int(plane[2]), _CORNERS[int(plane[2])]
            name = _CELLS[count]
        elif _LINE.match(kind) and rows and len(rows[0]) - 1 in _LINES:
            count, corners = len(rows[0]) - 1, 2
            name = _LINES[count]
        else:
            raise ValueError(f"elements of type {kind or '?'} are of no use here")
        if len(flat) % (count + 1):
            raise ValueError(f"an element of type {kind} does not have {count} nodes")
        table = [flat[i : i + count + 1] for i in range(0, len(flat), count + 1)]
        elements = {row[0]: row[1:] for row in table}
        if len(elements) < len(table):
            raise ValueError(f"an element of type {kind} is there twice in its card")
        self.blocks.append((name, corners, elements))
        if "ELSET" in options:
            self.element_sets.setdefault(options["ELSET"], []).extend(row[0] for row in table)

    def read_nset(self, options, rows) -> None:
        self.node_sets.setdefault(options.get("NSET", ""), []).extend(_members(options, rows))

    def read_elset(self, options, rows) -> None:
        self.element_sets.setdefault(options.get("ELSET", ""), []).extend(_members(options, rows))

    def read_surface(self, options, rows) -> None:
        name, kind = options.get("NAME", ""), options.get("TYPE", "ELEMENT").upper()
        if kind == "NODE":
            self.node_sets.setdefault(name, []).extend(_members({}, [row[:1] for row in rows]))
        elif kind == "ELEMENT" and all(len(row) > 1 and _is_side(row[1]) for row in rows):
            self.surfaces[name] = [(_member(row[0]), int(row[1][1:])) for row in rows]

    def result(self) -> Contents:
        self._no_element_twice()
        tags = np.array(list(self.points), dtype=np.int64)
        positions = numbering(tags)
        elements = np.array(
            [number for _, _, block in self.blocks for number in block], dtype=np.int64
        )
        sets = {name: _resolved(name, self.element_sets, elements) for name in self.element_sets}
        blocks = []
        for kind, _, block in self.blocks:
            nodes = positions(np.array(list(block.values()), dtype=np.int64))
            own = np.array(list(block), dtype=np.int64)
            mine = {name: np.flatnonzero(np.isin(own, found)) for name, found in sets.items()}
            blocks.append(Block(kind, nodes, {name: at for name, at in mine.items() if len(at)}))
        for name, sides in self.surfaces.items():
            lines = [line for of, side in sides for line in self._lines(of, side, sets)]
            if lines:
                nodes = positions(np.array(lines, dtype=np.int64))
                blocks.append(Block("line", nodes, {name: np.arange(len(nodes))}))
        node_sets = {}
        for name in self.node_sets:
            members = _resolved(name, self.node_sets, tags)
            node_sets[name] = np.sort(positions(members))
        points = np.array(list(self.points.values()), dtype=float).reshape(-1, 3)
        return Contents(points, blocks, node_sets)

    def _no_element_twice(self) -> None:
        seen: set[int] = set()
        for _, _, block in self.blocks:
            double = seen.intersection(block)
            if double:
                raise ValueError(
                    f"element {min(double)} is there twice; numbers must differ between parts too"
                )
            seen.update(block)

    def _lines(self, of: int | str, side: int, sets: dict[str, np.ndarray]) -> Iterator[list[int]]:
        """Corners of one side of an element, or of the elements of a set."""
        numbers = np.array([of]) if isinstance(of, int) else sets.get(of, np.empty(0, int))
        members = {int(number) for number in numbers}
        for _, corners, elements in self.blocks:
            for element in members & elements.keys() if corners > 2 else ():
                nodes = elements[element]
                yield [nodes[(side - 1) % corners], nodes[side % corners]]


def _is_side(label: str) -> bool:
    return label[:1] in "Ss" and label[1:] in ("1", "2", "3", "4")


def _member(word: str) -> int | str:
    return int(word) if word.isdigit() else word


def _members(options, rows) -> Iterator[Member]:
    """Members of a card: numbers, ranges, or names of other sets."""
    for row in rows:
        if "GENERATE" in options:
            first, last, *step = (int(part) for part in row if part)
            yield first, last, step[0] if step else 1
        else:
            yield from (_member(part) for part in row if part)


def _resolved(name: str, sets: dict[str, list[Member]], known: np.ndarray) -> np.ndarray:
    """Numbers of a set that are known; those of a range that are not are left out.

    A range may be as long as it likes: it costs no more than the numbers that there are.
    """
    found: list[np.ndarray] = [np.empty(0, dtype=np.int64)]
    waiting, seen = [name], {name}
    while waiting:
        members = sets.get(waiting.pop(), [])
        found.append(np.array([m for m in members if isinstance(m, int)], dtype=np.int64))
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

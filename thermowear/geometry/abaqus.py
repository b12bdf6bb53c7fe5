"""Reading nodes, elements and their sets from an Abaqus input file.

Understood are ``*NODE``, ``*ELEMENT``, ``*NSET``, ``*ELSET`` and ``*SURFACE``; the rest is passed
over. Parts and assemblies are read as if they were one.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

_PLANE = re.compile(r"(CPS|CPE|CPEG|CAX|M3D|STRI|S|DC2D|DCAX|WARP2D|R3D)(3|4|6|8|9)(?!\d)")
_LINE = re.compile(r"(T2D|T3D|B2|B3|SAX|R2D|RAX|DC1D|W2D|W3D)\d*")
_CORNERS = {3: 3, 4: 4, 6: 3, 8: 4, 9: 4}

RawBlock = tuple[int, int, np.ndarray, dict[str, np.ndarray]]
"""Dimension, corners, nodes and sets of elements of one type."""


def read_abaqus(text: str) -> tuple[np.ndarray, list[RawBlock], dict[str, np.ndarray]]:
    """Read the text of an input file.

    Returns
    -------
    points : ndarray, shape (n_points, 3)
    blocks : list
        Elements, and one block of lines for each surface.
    node_sets : dict of str to ndarray of int
    """
    deck = _Deck()
    for keyword, options, lines in _cards(text):
        read = getattr(deck, f"read_{keyword.lower()}", None)
        if read is not None:
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
        self.blocks: list[tuple[int, int, dict[int, list[int]]]] = []
        self.node_sets: dict[str, set[int]] = {}
        self.element_sets: dict[str, set[int]] = {}
        self.surfaces: dict[str, list[tuple[str, int]]] = {}

    def read_node(self, options, rows) -> None:
        for number, *place in rows:
            self.points[int(number)] = [float(x) for x in (*place, 0.0, 0.0)[:3]]
            if "NSET" in options:
                self.node_sets.setdefault(options["NSET"], set()).add(int(number))

    def read_element(self, options, rows) -> None:
        kind = options.get("TYPE", "").upper()
        flat = [int(part) for row in rows for part in row]
        plane = _PLANE.match(kind)
        if plane:
            count = int(plane[2])
            shape = (2, _CORNERS[count])
        elif _LINE.match(kind) and rows:
            count, shape = len(rows[0]) - 1, (1, 2)
        else:
            raise ValueError(f"elements of type {kind or '?'} are of no use here")
        if len(flat) % (count + 1):
            raise ValueError(f"an element of type {kind} does not have {count} nodes")
        table = [flat[i : i + count + 1] for i in range(0, len(flat), count + 1)]
        self.blocks.append((*shape, {row[0]: row[1:] for row in table}))
        if "ELSET" in options:
            self.element_sets.setdefault(options["ELSET"], set()).update(row[0] for row in table)

    def read_nset(self, options, rows) -> None:
        _extend(self.node_sets, options.get("NSET", ""), options, rows)

    def read_elset(self, options, rows) -> None:
        _extend(self.element_sets, options.get("ELSET", ""), options, rows)

    def read_surface(self, options, rows) -> None:
        name, kind = options.get("NAME", ""), options.get("TYPE", "ELEMENT").upper()
        if kind == "NODE":
            _extend(self.node_sets, name, {}, [row[:1] for row in rows])
        elif kind == "ELEMENT":
            sides = [(row[0], row[1].upper()) for row in rows if len(row) > 1]
            self.surfaces[name] = [(of, int(s[1:])) for of, s in sides if s[1:].isdigit()]

    def result(self) -> tuple[np.ndarray, list[RawBlock], dict[str, np.ndarray]]:
        number = {node: i for i, node in enumerate(self.points)}
        blocks: list[RawBlock] = []
        for dim, corners, elements in self.blocks:
            nodes = np.array([[number[n] for n in row] for row in elements.values()])
            at = {element: i for i, element in enumerate(elements)}
            sets = {
                name: np.array([at[e] for e in sorted(members) if e in at])
                for name, members in self.element_sets.items()
                if not members.isdisjoint(at)
            }
            blocks.append((dim, corners, nodes.astype(np.int64), sets))
        for name, sides in self.surfaces.items():
            lines = [[number[n] for n in line] for of, s in sides for line in self._lines(of, s)]
            if lines:
                blocks.append((1, 2, np.array(lines), {name: np.arange(len(lines))}))
        node_sets = {
            name: np.array(sorted(number[n] for n in members))
            for name, members in self.node_sets.items()
        }
        return np.array(list(self.points.values())), blocks, node_sets

    def _lines(self, of: str, side: int) -> Iterator[list[int]]:
        """Corners of one side of an element, or of the elements of a set."""
        members = {int(of)} if of.isdigit() else self.element_sets.get(of, set())
        for dim, corners, elements in self.blocks:
            for element in members & elements.keys() if dim == 2 else ():
                nodes = elements[element]
                yield [nodes[(side - 1) % corners], nodes[side % corners]]


def _extend(sets: dict[str, set[int]], name: str, options, rows) -> None:
    """Add the members of a card to a set: numbers, ranges, or other sets."""
    members = sets.setdefault(name, set())
    for row in rows:
        if "GENERATE" in options:
            first, last, *step = (int(part) for part in row)
            members.update(range(first, last + 1, *step))
            continue
        for part in row:
            members.update({int(part)} if part.isdigit() else sets.get(part, set()))

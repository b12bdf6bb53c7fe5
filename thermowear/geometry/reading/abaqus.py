"""Reader of nodes, elements and their sets from an Abaqus input file.

Supported are ``*NODE``, ``*ELEMENT``, ``*NSET``, ``*ELSET`` and ``*SURFACE``. Labels are not
case-sensitive unless they are quoted, and must be defined. Parts and assemblies are read as if they
were one. Cards that generate or move nodes and elements, or
include other files, are rejected; all others (materials, steps) are skipped.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..mesh.nodes import numbered
from .contents import VTK_ORDER, CellBlock, MeshContents, numbering, parsed

_PLANE = re.compile(r"(CPS|CPE|CPEG|CAX|M3D|STRI|S|DC2D|DCAX|WARP2D|R3D)(3|4|6|8|9)(?!\d)")
_SOLID = re.compile(r"(C3D|DC3D|DCC3D)(4|8|10|20|27)(?!\d)")
_LINE = re.compile(r"(T2D|T3D|B2|B3|SAX|R2D|RAX|DC1D|W2D|W3D)\d*")
_SIDE = re.compile(r"(S([1-6]|POS|NEG))?", re.IGNORECASE)
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
_NO_SIDES = np.empty((0, 0), dtype=np.int64)
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
_COMMAS = re.compile(r',(?=(?:[^"]*"[^"]*")*[^"]*$)')
"""Commas outside of quoted labels."""
_FLAGS = ("GENERATE", "INTERNAL", "UNSORTED")
"""Options without a value."""
_FREE = -1
"""Side that stands for all sides of an element without a neighbour."""


class Member(NamedTuple):
    """Members of a set, and their line in the file.

    `value` is the name of another set, a range (first, last, step), or an array of numbers.
    """

    value: str | tuple[int, int, int] | np.ndarray
    line: int


class Card(NamedTuple):
    """Keyword with its options and line, and its data lines with theirs."""

    keyword: str
    line: int
    options: dict[str, str]
    lines: list[str]
    numbers: list[int]

    def rows(self) -> Iterator[tuple[list[str], int]]:
        """Words and line number of each data line."""
        return ((_words(line), n) for line, n in zip(self.lines, self.numbers, strict=True))


def read_abaqus(text: str, dim: int = 2) -> MeshContents:
    """Read the text of an input file with bodies of a dimension.

    Raises
    ------
    ValueError
        If it is malformed, has cards that would change the mesh, or names what it does not define.
    """
    deck = _Deck(dim)
    for card in _cards(text):
        keyword = card.keyword
        if keyword in _REFUSED:
            raise ValueError(f"*{keyword} {_REFUSED[keyword]}")
        if keyword == "INSTANCE":
            if card.lines:
                raise ValueError("*INSTANCE moves a part; write the nodes in global coordinates")
            deck.instances.add(_key(card.options.get("NAME", "")))
        if keyword in _READ:
            if card.options.keys() & {"INPUT", "FILE"}:
                raise ValueError(f"*{keyword} includes another file; a mesh must be in one file")
            getattr(deck, f"read_{keyword.lower()}")(card)
    return deck.result()


def _cards(text: str) -> Iterator[Card]:
    """All cards; options that end with a comma continue on the next line."""
    card, continued = Card("", 0, {}, [], []), False
    for number, line in enumerate(text.splitlines(), start=1):
        if line.startswith("**") or not line.strip():
            continue
        words = _words(line.rstrip().rstrip(","))
        if line.startswith("*"):
            yield card
            card = Card(words.pop(0)[1:].strip().upper(), number, {}, [], [])
        elif not (continued and ("=" in line or words[0].upper() in _FLAGS)):
            card.lines.append(line.strip().rstrip(","))
            card.numbers.append(number)
            continued = False
            continue
        pairs = [word.partition("=") for word in words]
        card.options.update({key.strip().upper(): value.strip() for key, _, value in pairs})
        continued = line.rstrip().endswith(",")
    yield card


class _Deck:
    """Parser state; numbers are those of the file, labels are spelled as at their first place."""

    def __init__(self, dim: int) -> None:
        self.dim = dim
        self.labels: dict[str, str] = {}
        self.instances: set[str] = set()
        self.tags: list[np.ndarray] = [np.empty(0, dtype=np.int64)]
        self.points: list[np.ndarray] = [np.empty((0, 3))]
        self.elements: defaultdict[str, list[tuple[np.ndarray, np.ndarray]]] = defaultdict(list)
        self.node_sets: defaultdict[str, list[Member]] = defaultdict(list)
        self.nodes_of: list[tuple[str, Member]] = []
        self.element_sets: defaultdict[str, list[Member]] = defaultdict(list)
        self.surfaces: dict[str, list[tuple[Member, int]]] = {}

    def read_node(self, card: Card) -> None:
        if card.options.get("SYSTEM", "R").upper() != "R":
            raise ValueError("*NODE, SYSTEM= is not Cartesian; write x, y and z")
        table = _table(card.lines)[:, :4]
        self.tags.append(_whole(table[:, 0]))
        self.points.append(np.pad(table[:, 1:], ((0, 0), (0, 4 - table.shape[1]))))
        if "NSET" in card.options:
            self.node_sets[self._name(card, "NSET")].append(Member(self.tags[-1], card.line))

    def read_element(self, card: Card) -> None:
        kind, lines = card.options.get("TYPE", "").upper(), card.lines
        words = len(lines[0].split(",")) if lines else 0
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
        if "ELSET" in card.options:
            self.element_sets[self._name(card, "ELSET")].append(Member(table[:, 0], card.line))

    def read_nset(self, card: Card) -> None:
        name = self._name(card, "NSET")
        self.node_sets[name] += self._members(card)
        if "ELSET" in card.options:
            self.nodes_of.append((name, Member(self._name(card, "ELSET"), card.line)))

    def read_elset(self, card: Card) -> None:
        self.element_sets[self._name(card, "ELSET")] += self._members(card)

    def read_surface(self, card: Card) -> None:
        name, kind = self._name(card, "NAME"), card.options.get("TYPE", "ELEMENT").upper()
        rows = [(self._member(words[0], n), [*words, ""][1], n) for words, n in card.rows()]
        if "COMBINE" in card.options:
            return
        if kind == "NODE":
            self.node_sets[name] += [of for of, _, _ in rows]
        elif kind == "ELEMENT" and all(_SIDE.fullmatch(side) for _, side, _ in rows):
            if name in self.surfaces:
                raise ValueError(f"line {card.line}: the surface {name!r} is defined twice")
            self.surfaces[name] = [(of, _side(side)) for of, side, _ in rows]

    def _name(self, card: Card, option: str) -> str:
        """Label that an option gives."""
        if not card.options.get(option):
            raise ValueError(f"line {card.line}: *{card.keyword} has no {option}=")
        return self._spelled(card.options[option])

    def _spelled(self, label: str) -> str:
        return self.labels.setdefault(_key(label), label.strip('"'))

    def _member(self, word: str, line: int) -> Member:
        """Number or name, in an assembly after the name of an instance and a point."""
        instance, point, inside = word.partition(".")
        own = inside if point and _key(instance) in self.instances else word
        return Member(np.array([int(own)]) if own.isdecimal() else self._spelled(own), line)

    def _members(self, card: Card) -> Iterator[Member]:
        """Members of a card: numbers, ranges, or names of other sets."""
        for row, line in card.rows():
            words = [word for word in row if word]
            if "GENERATE" in card.options:
                first, last, *step = (int(word) for word in words)
                yield Member((first, last, step[0] if step else 1), line)
            elif all(word.isdecimal() for word in words):
                yield Member(np.array([int(word) for word in words], dtype=np.int64), line)
            else:
                yield from (self._member(word, line) for word in words)

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

        def elements_in(members: list[Member], where: str) -> np.ndarray:
            return _resolved(members, self.element_sets, numbers, "element", where)

        sets = {n: elements_in(of, f"the set {n!r}") for n, of in self.element_sets.items()}
        blocks = []
        for kind, (of_kind, nodes) in merged.items():
            own = {n: np.flatnonzero(np.isin(of_kind, found)) for n, found in sets.items()}
            blocks.append(
                CellBlock(kind, positions(nodes), {n: at for n, at in own.items() if len(at)})
            )
        for name, sides in self.surfaces.items():
            for side in sorted({side for _, side in sides}):
                of_side = [member for member, at in sides if at == side]
                chosen = elements_in(of_side, f"the surface {name!r}")
                for kind, nodes in _facets(merged, chosen, side, self.dim):
                    if not len(nodes):
                        raise ValueError(
                            f"line {of_side[0].line}: the surface {name!r} has elements without "
                            f"{'a free side' if side == _FREE else f'the side {side}'}"
                        )
                    blocks.append(CellBlock(kind, positions(nodes), {name: np.arange(len(nodes))}))
        for name, of in self.nodes_of:
            chosen = elements_in([of], f"the set {name!r}")
            every = [nodes[np.isin(own, chosen)].ravel() for own, nodes in merged.values()]
            self.node_sets[name].append(Member(np.unique(np.concatenate(every)), of.line))
        known, node_sets = np.sort(tags), {}
        for name, of_set in self.node_sets.items():
            found = _resolved(of_set, self.node_sets, known, "node", f"the set {name!r}")
            node_sets[name] = np.sort(positions(found))
        return MeshContents(points, blocks, node_sets, any_case=True)

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
    elements: dict[str, tuple[np.ndarray, ...]], chosen: np.ndarray, side: int, dim: int
) -> Iterator[tuple[str, np.ndarray]]:
    """Type and nodes, at the corners, of a side of elements; no nodes if they have no such side.

    Side 0 is the element itself, which covers a body.
    """
    for kind, (numbers, nodes) in elements.items():
        cells, shape = nodes[np.isin(numbers, chosen)], kind.rstrip("0123456789")
        if not len(cells):
            continue
        covers = shape == "line" or (dim == 3 and shape in _SHELL_FACES)
        if covers:
            corners = _SHELL_FACES.get(shape, np.arange(cells.shape[1])[None])
            yield (kind if shape == "line" else shape), cells[: 0 if side > 0 else None, corners[0]]
        else:
            corners = _SIDES[shape]
            corners = corners if side == _FREE else corners[max(side - 1, 0) : side]
            facets = cells[:, corners].reshape(-1, corners.shape[1])
            yield _FACETS[corners.shape[1]], _free(elements, facets) if side == _FREE else facets


def _free(elements: dict[str, tuple[np.ndarray, ...]], facets: np.ndarray) -> np.ndarray:
    """Facets (n, n_corners) of one element only."""
    count = facets.shape[1]
    every = [
        nodes[:, corners].reshape(-1, count)
        for kind, (_, nodes) in elements.items()
        if (corners := _SIDES.get(kind.rstrip("0123456789"), _NO_SIDES)).shape[1] == count
    ]
    number, _ = numbered(np.concatenate([facets, *every]))
    times = np.bincount(number[len(facets) :])
    return facets[times[number[: len(facets)]] == 1]


def _key(label: str) -> str:
    """Label for comparisons: the case of letters counts only in quotation marks."""
    return label.strip('"') if label.startswith('"') else label.upper()


def _words(line: str) -> list[str]:
    parts = _COMMAS.split(line) if '"' in line else line.split(",")
    return [part.strip() for part in parts]


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
    if not label:
        return _FREE
    return int(label[1:]) if label[1:].isdecimal() else 0


def _resolved(
    members: list[Member],
    sets: dict[str, list[Member]],
    known: np.ndarray,
    kind: str,
    where: str,
) -> np.ndarray:
    """Numbers that members of a set or surface stand for, sorted.

    Numbers of a range that are not in the mesh are left out; the cost of a range is that of the
    numbers in the mesh, regardless of its length.

    Parameters
    ----------
    members : list of Member
    sets : dict of str to list of Member
        All sets.
    known : ndarray
        Sorted numbers in the mesh.
    kind, where : str
        ``"node"`` or ``"element"``, and whose members they are, for messages.

    Raises
    ------
    ValueError
        If a number or a set is not defined.
    """
    found: list[np.ndarray] = [np.empty(0, dtype=np.int64)]
    lines: list[np.ndarray] = [np.empty(0, dtype=np.int64)]
    waiting, seen = list(members), set[str]()
    while waiting:
        value, line = waiting.pop()
        if isinstance(value, str):
            if value not in sets:
                raise ValueError(f"line {line}: the {kind} set {value!r} of {where} is not defined")
            waiting += [] if value in seen else sets[value]
            seen.add(value)
            continue
        if isinstance(value, np.ndarray):
            chosen = value
        else:
            first, last, step = value
            if step < 1:
                raise ValueError(f"line {line}: {where} has a range with the step {step}")
            chosen = known[(known >= first) & (known <= last) & ((known - first) % step == 0)]
            if not len(chosen):
                raise ValueError(f"line {line}: {where} has a range without defined {kind}s")
        found.append(chosen)
        lines.append(np.full(len(chosen), line))
    numbers = np.concatenate(found)
    missing = ~np.isin(numbers, known)
    if missing.any():
        line, number = min(zip(np.concatenate(lines)[missing], numbers[missing], strict=True))
        raise ValueError(f"line {line}: {kind} {number} of {where} is not defined")
    return np.unique(numbers)

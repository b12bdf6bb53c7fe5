"""Meshes as lists that tests can spoil, and files of every format from them."""

from __future__ import annotations

import copy
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

NAMES = {
    "bodies": {"punch": "PUNCH", "plate": "PLATE"},
    "contact": ["PUNCH_FACE", "PLATE_FACE"],
    "held": "PUNCH_TOP",
    "fixed": "PLATE_BOTTOM",
}
TAGS = {
    **{"PUNCH": 1, "PLATE": 2, "PUNCH_FACE": 3, "PLATE_FACE": 4, "PUNCH_TOP": 5},
    **{"PLATE_BOTTOM": 6, "AXES": 7},
}
NUMBERED = NAMES | {
    "bodies": {"punch": "1", "plate": "2"},
    "surfaces": {name: str(tag) for name, tag in TAGS.items() if tag in (3, 4, 5, 6)},
}
"""For formats that know numbers instead of names."""


@dataclass
class Plain:
    """Nodes, and elements by the name that they have in the file."""

    points: list[list[float]] = field(default_factory=list)
    cells: list[tuple[str, list[int]]] = field(default_factory=list)
    lines: list[tuple[str, list[int]]] = field(default_factory=list)

    def of(self, name: str) -> list[int]:
        """Numbers of the cells of a body."""
        return [k for k, (body, _) in enumerate(self.cells) if body == name]

    def nodes(self, body: str) -> list[int]:
        return sorted({node for name, nodes in self.cells if name == body for node in nodes})

    def moved(self, body: str, x: float, y: float) -> Plain:
        """Copy with one body displaced."""
        result = copy.deepcopy(self)
        for node in self.nodes(body):
            px, py = self.points[node]
            result.points[node] = [px + x, py + y]
        return result


def blocks(columns=(4, 6), rows=(2, 2), half=False, round_face=0.0) -> Plain:
    """A punch of 40 x 20 on a plate of 60 x 20 (in metres times 1e-3) whose top is at y = 0.

    Half of them lies right of x = 0. With a round face the punch touches in the middle first.
    """
    mesh = Plain()
    spans = (((-20.0, 20.0), (0.0, 20.0)), ((-30.0, 30.0), (-20.0, 0.0)))
    for name, n, m, (x, y) in zip(("PUNCH", "PLATE"), columns, rows, spans, strict=True):
        first = len(mesh.points)
        across = np.linspace(0.0 if half else x[0], x[1], n + 1).tolist()
        for up in np.linspace(*y, m + 1).tolist():
            lift = round_face * (1 - up / 20.0) if name == "PUNCH" else 0.0
            mesh.points += [[1e-3 * px, 1e-3 * (up + lift * (px / 20.0) ** 2)] for px in across]
        for j in range(m):
            for i in range(n):
                a = first + j * (n + 1) + i
                mesh.cells.append((name, [a, a + 1, a + n + 2, a + n + 1]))
        low, high = ("FACE", "TOP") if name == "PUNCH" else ("BOTTOM", "FACE")
        for side, j in ((low, 0), (high, m)):
            start = first + j * (n + 1)
            mesh.lines += [(f"{name}_{side}", [start + i, start + i + 1]) for i in range(n)]
        if half:
            axis = [first + j * (n + 1) for j in range(m + 1)]
            mesh.lines += [("AXES", [a, b]) for a, b in pairwise(axis)]
    return mesh


_GMSH = {("line", 2): 1, ("line", 3): 8, ("cell", 3): 2, ("cell", 4): 3, ("cell", 9): 10}


def msh(mesh: Plain) -> str:
    """Text of a gmsh file, format 2.2."""
    names = [f'{1 if tag > 2 else 2} {tag} "{name}"' for name, tag in TAGS.items()]
    nodes = [f"{k} {float(x)!r} {float(y)!r} 0" for k, (x, y) in enumerate(mesh.points, 1)]
    elements = [
        f"{_GMSH[kind, len(of)]} 2 {TAGS[name]} {TAGS[name]} {' '.join(str(n + 1) for n in of)}"
        for kind, group in (("line", mesh.lines), ("cell", mesh.cells))
        for name, of in group
    ]
    numbered = [f"{k} {element}" for k, element in enumerate(elements, 1)]
    parts = {"MeshFormat": ["2.2 0 8"]} | {
        name: [str(len(rows)), *rows]
        for name, rows in (("PhysicalNames", names), ("Nodes", nodes), ("Elements", numbered))
    }
    return "".join(
        f"${name}\n" + "\n".join(rows) + f"\n$End{name}\n" for name, rows in parts.items()
    )


def inp(mesh: Plain) -> str:
    """Text of an Abaqus file."""
    rows = [
        "*NODE",
        *(f"{k}, {float(x)!r}, {float(y)!r}" for k, (x, y) in enumerate(mesh.points, 1)),
    ]
    number = 0
    for kind, group in (("T2D2", mesh.lines), ("CPE4", mesh.cells)):
        for wanted in TAGS:
            of = [nodes for name, nodes in group if name == wanted]
            rows += [f"*ELEMENT, TYPE={kind}, ELSET={wanted}"] if of else []
            for nodes in of:
                number += 1
                rows.append(", ".join(map(str, [number, *(n + 1 for n in nodes)])))
    return "\n".join([*rows, ""])


def meshio_file(mesh: Plain, path) -> None:
    """Write .vtu, .xdmf or .med."""
    import meshio

    cells = [("quad", [of for _, of in mesh.cells]), ("line", [of for _, of in mesh.lines])]
    tags = [np.array([TAGS[name] for name, _ in group]) for group in (mesh.cells, mesh.lines)]
    points = np.array(mesh.points)
    if path.suffix == ".med":
        result = meshio.Mesh(points, cells, cell_data={"cell_tags": [-t for t in tags]})
        result.cell_tags = {-tag: [name] for name, tag in TAGS.items()}
        result.point_tags = {}
        meshio.write(path, result)
        return
    flat = np.pad(points, ((0, 0), (0, 1)))
    result = meshio.Mesh(flat, cells, cell_data={"tag": tags})
    keywords = {"data_format": "XML"} if path.suffix == ".xdmf" else {}
    meshio.write(path, result, **keywords)

"""Labels of faces in STEP files, which gmsh does not read.

They are the names of ``ADVANCED_FACE``. Solids and faces of the text are those of OpenCASCADE in
the same order; that this holds for a file is tested by the corners of all faces, whose distances
from each other depend neither on the unit nor on the position of a part in its assembly.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

_TYPES = (
    *("ADVANCED_FACE", "FACE_BOUND", "FACE_OUTER_BOUND", "EDGE_LOOP", "VERTEX_LOOP"),
    *("ORIENTED_EDGE", "EDGE_CURVE", "VERTEX_POINT", "CARTESIAN_POINT"),
    *("CLOSED_SHELL", "ORIENTED_CLOSED_SHELL", "MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS"),
)
_ENTITY = re.compile(rf"#(\d+)\s*=\s*({'|'.join(_TYPES)})\s*\(((?:[^';]|'(?:[^']|'')*+')*+);")
_NAME = re.compile(r"\s*'((?:[^']|'')*+)'")
_LABELLED = re.compile(r"(?:ADVANCED_FACE|SOLID_BREP|WITH_VOIDS)\s*\(\s*'(?!NONE')[^']")
_REFERENCE = re.compile(r"#(\d+)")
_NONE = ("", "NONE")
_ALIKE = 1e-5
"""Largest difference of sums of distances, relative to the whole, of faces that are the same."""


@dataclass(frozen=True)
class StepSolid:
    """Solid of a STEP file: its name, and labels and corners of its faces.

    Attributes
    ----------
    name : str
        Empty without one.
    labels : tuple of str
    corners : tuple of ndarray, shape (n, 3)
        In the unit of the file and the coordinates of the part.
    """

    name: str
    labels: tuple[str, ...]
    corners: tuple[np.ndarray, ...]


def labelled_solids(text: str) -> list[StepSolid]:
    """Solids of a STEP file; none if neither solids nor faces have labels."""
    if _LABELLED.search(text) is None:
        return []
    entities = {int(n): (kind, rest) for n, kind, rest in _ENTITY.findall(text)}
    solids = [
        number
        for number, (kind, _) in entities.items()
        if kind in ("MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS")
    ]
    return [_solid(entities, number) for number in solids]


_Entities = dict[int, tuple[str, str]]


def _solid(entities: _Entities, number: int) -> StepSolid:
    shells = _below(entities, number)
    inner = [s for shell in shells for s in (_below(entities, shell) or [])]
    faces = [f for f in inner if entities[f][0] == "ADVANCED_FACE"]
    oriented = [s for s in inner if entities[s][0] == "CLOSED_SHELL"]  # of voids
    faces += [f for shell in oriented for f in _below(entities, shell)]
    return StepSolid(
        _label(entities, number),
        tuple(_label(entities, face) for face in faces),
        tuple(_corners(entities, face) for face in faces),
    )


def _below(entities: _Entities, number: int) -> list[int]:
    """Entities that an entity refers to."""
    found = map(int, _REFERENCE.findall(_NAME.sub("", entities[number][1], count=1)))
    return [other for other in found if other in entities]


def _label(entities: _Entities, number: int) -> str:
    found = _NAME.match(entities[number][1])
    name = found[1].replace("''", "'").strip() if found else ""
    return "" if name in _NONE else name


def _corners(entities: _Entities, face: int) -> np.ndarray:
    """Vertices of a face, shape (n, 3)."""
    level, points = [face], dict[int, None]()
    while level:
        found = [other for number in level for other in _below(entities, number)]
        points |= dict.fromkeys(n for n in found if entities[n][0] == "CARTESIAN_POINT")
        level = [n for n in found if entities[n][0] not in ("CARTESIAN_POINT", "ADVANCED_FACE")]
    places = [_NAME.sub("", entities[n][1], count=1) for n in points]
    numbers = [re.findall(r"[-+.\dEe]+", place) for place in places]
    return np.array([[float(x) for x in row[:3]] for row in numbers]).reshape(-1, 3)


def matched(solids: list[StepSolid], found: list[tuple[np.ndarray, ...]]) -> list[StepSolid | None]:
    """Solid of the text for each solid of OpenCASCADE; None where none has the same faces.

    Solids that are alike follow each other as in the text; a part may occur several times.

    Parameters
    ----------
    solids : list of StepSolid
    found : list of tuple of ndarray, shape (n, 3)
        Corners of the faces of each solid, in their order.
    """
    result: list[StepSolid | None] = []
    used: dict[int, int] = {}
    for corners in found:
        alike = [k for k, solid in enumerate(solids) if _same(solid.corners, corners)]
        chosen = min(alike, key=lambda k: used.get(k, 0), default=None)
        if chosen is not None:
            used[chosen] = used.get(chosen, 0) + 1
        result.append(None if chosen is None else solids[chosen])
    return result


def _same(one: tuple[np.ndarray, ...], other: tuple[np.ndarray, ...]) -> bool:
    """Test for faces with the same distances of their corners, in the same order."""
    if [len(x) for x in one] != [len(x) for x in other]:
        return False
    a, b = (np.array([_spread(x) for x in corners]) for corners in (one, other))
    scale = [max(x.sum(), np.finfo(float).tiny) for x in (a, b)]
    return bool(np.all(np.abs(a / scale[0] - b / scale[1]) < _ALIKE))


def _spread(points: np.ndarray) -> float:
    """Sum of all distances of some points from each other."""
    return float(np.linalg.norm(points[:, None] - points, axis=2).sum())

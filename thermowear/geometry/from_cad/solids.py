"""Solids and faces of CAD files in a gmsh model, in millimetres: labels, and chosen faces.

They are the names of ``ADVANCED_FACE``. Solids and faces of the text are those of OpenCASCADE in
the same order; that this holds for a file is tested by the corners of all faces, whose distances
from each other depend neither on the unit nor on the position of a part in its assembly.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from .request import BodyRequest, CadError, FaceChoice, SurfaceRequest

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


UNIT = 1e-3
"""Length in which OpenCASCADE computes, as its tolerances are absolute [m]."""
_INNER_DISTANCE = 1e-9
"""Distance of a point from a solid that contains it [mm]."""
_ELEMENTS = 15
"""Number of elements along the diagonal of a body, unless the case has a size."""
_SHOWN = 12
"""Largest number of labels or faces in a message."""


@dataclass(frozen=True, eq=False)
class CadFace:
    """Face of a solid: its tag in gmsh, the name of its body, its label, area [mm²] and centre."""

    tag: int
    body: str
    label: str
    area: float
    centre: np.ndarray
    box: np.ndarray

    def __str__(self) -> str:
        label = f" {self.label!r}" if self.label else ""
        return f"face{label} of {self.body!r} of {self.area:.4g} mm² about {in_mm(self.centre)}"


@dataclass(frozen=True)
class CadSolid:
    """Solid of a file: its tag in gmsh, its labels, and the faces of its boundary with theirs."""

    tag: int
    names: tuple[str, ...]
    faces: tuple[tuple[int, str], ...]


@dataclass(frozen=True, eq=False)
class CadBody:
    """Body: its solids, and their faces."""

    request: BodyRequest
    solids: tuple[CadSolid, ...]
    faces: tuple[CadFace, ...]
    box: np.ndarray

    @property
    def name(self) -> str:
        return self.request.name

    @cached_property
    def size(self) -> float:
        """Diagonal of its bounding box [mm]."""
        return float(np.linalg.norm(self.box[1] - self.box[0]))

    @cached_property
    def element_sizes(self) -> tuple[float, float, float]:
        """Largest element size, and those on the contact face and at its edge [mm]."""
        given = self.request
        largest = self.size / _ELEMENTS if given.size is None else given.size / UNIT
        inside = largest / 2 if given.contact_size is None else given.contact_size / UNIT
        return largest, min(inside, largest), given.grading * min(inside, largest)

    def contains(self, gmsh, point: np.ndarray) -> bool:
        return any(gmsh.model.isInside(3, solid.tag, list(point)) for solid in self.solids)


def read_bodies(gmsh, requests: Sequence[BodyRequest]) -> dict[str, CadBody]:
    """Read the files of all bodies into the current model.

    Raises
    ------
    CadError
        If a file cannot be read, or its solids are not those that the bodies name.
    """
    files: dict[str, list[CadSolid]] = {}
    for request in requests:
        if request.path not in files:
            files[request.path] = _read(gmsh, request)
    known = set(gmsh.model.occ.getEntities(0))
    chosen = {r.name: _chosen(gmsh, r, files[r.path]) for r in requests}
    points = [point for point in gmsh.model.occ.getEntities(0) if point not in known]
    _check_once(requests, chosen)
    wanted = {solid.tag for solids in chosen.values() for solid in solids}
    rest = [(3, s.tag) for solids in files.values() for s in solids if s.tag not in wanted]
    gmsh.model.occ.remove(rest, recursive=True)
    gmsh.model.occ.remove(points)
    gmsh.model.occ.synchronize()
    return {request.name: _body(gmsh, request, chosen[request.name]) for request in requests}


def _read(gmsh, request: BodyRequest) -> list[CadSolid]:
    """Solids of a file."""
    path = Path(request.path)
    is_step = path.suffix.lower() in (".step", ".stp")
    gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
    gmsh.option.setNumber("Geometry.OCCScaling", 1.0 if is_step else (request.unit or UNIT) / UNIT)
    try:
        found = gmsh.model.occ.importShapes(str(path), True, "step" if is_step else "brep")
        gmsh.model.occ.synchronize()
    except Exception as trouble:  # gmsh raises nothing more specific
        raise CadError(f"{request.key}: {path} cannot be read: {trouble}") from None
    tags = [tag for dim, tag in found if dim == 3]
    if not tags:
        raise CadError(f"{request.key}: {path} has no solids")
    corners = {tag: _faces_of(gmsh, tag) for tag in tags}
    text = path.read_text("latin-1") if is_step else ""
    of_text = matched(labelled_solids(text), [tuple(x for _, x in corners[t]) for t in tags])
    return [
        CadSolid(
            tag,
            _names(gmsh, tag, "" if same is None else same.name),
            tuple(
                (face, "" if same is None else same.labels[k])
                for k, (face, _) in enumerate(corners[tag])
            ),
        )
        for tag, same in zip(tags, of_text, strict=True)
    ]


def _faces_of(gmsh, solid: int) -> list[tuple[int, np.ndarray]]:
    """Faces of a solid in their order, and their corners, shape (n, 3) [mm]."""
    model = gmsh.model
    faces = sorted(tag for _, tag in model.getBoundary([(3, solid)], oriented=False))
    result = []
    for face in faces:
        ends = model.getBoundary([(2, face)], combined=False, oriented=False, recursive=True)
        places = [model.getValue(0, tag, []) for _, tag in dict.fromkeys(ends)]
        result.append((face, np.array(places).reshape(-1, 3)))
    return result


def _names(gmsh, tag: int, name: str) -> tuple[str, ...]:
    """Labels of a solid: its path in the assembly, the last part of it, and its own name."""
    path = gmsh.model.getEntityName(3, tag).removeprefix("Shapes/")
    every = (path, path.rpartition("/")[2], name)
    return tuple(dict.fromkeys(filter(None, every)))


def _chosen(gmsh, request: BodyRequest, solids: list[CadSolid]) -> list[CadSolid]:
    """Solids of a body among those of its file."""
    if not request.solids:
        return solids
    result: list[CadSolid] = []
    for wanted in request.solids:
        by_name = isinstance(wanted, str)
        found = [s for s in solids if (wanted in s.names if by_name else _inside(gmsh, s, wanted))]
        if not found:
            labels = dict.fromkeys(s.names[-1] for s in solids if s.names)
            known = f"; labels: {listed(labels)}" if labels else ""
            what = f"no solid labelled {wanted!r}" if by_name else "no solid around the point"
            raise CadError(
                f"{request.solids_key}: {request.path} has {what}; "
                f"it has {_count(len(solids), 'solid')}{known}"
            )
        if not by_name and len(found) > 1:
            raise CadError(
                f"{request.solids_key}: the point lies on {len(found)} solids; name one inside one"
            )
        result += found
    return list(dict.fromkeys(result))


def _inside(gmsh, solid: CadSolid, point: Any) -> bool:
    place = np.array(point) / UNIT
    return distance(gmsh, place, (3, solid.tag)) <= _INNER_DISTANCE


def _check_once(requests: Sequence[BodyRequest], chosen: dict[str, list[CadSolid]]) -> None:
    """Reject solids of two bodies."""
    owner: dict[int, str] = {}
    for request in requests:
        for solid in chosen[request.name]:
            if solid.tag in owner:
                label = f" {solid.names[-1]!r}" if solid.names else ""
                raise CadError(
                    f"{request.solids_key}: the solid{label} of {request.path} is "
                    f"{owner[solid.tag]!r} already; name the solids of each body"
                )
            owner[solid.tag] = request.name


def _body(gmsh, request: BodyRequest, solids: list[CadSolid]) -> CadBody:
    _check_apart(gmsh, request, solids)
    occ = gmsh.model.occ
    faces = tuple(
        CadFace(
            tag,
            request.name,
            label,
            occ.getMass(2, tag),
            np.array(occ.getCenterOfMass(2, tag)),
            np.array(occ.getBoundingBox(2, tag)).reshape(2, 3),
        )
        for solid in solids
        for tag, label in solid.faces
    )
    boxes = np.array([face.box for face in faces])
    box = np.array([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])
    return CadBody(request, tuple(solids), faces, box)


def _check_apart(gmsh, request: BodyRequest, solids: list[CadSolid]) -> None:
    """Reject solids of one body that touch: their meshes would not be joined."""
    for i, one in enumerate(solids):
        for other in solids[:i]:
            if gmsh.model.occ.getDistance(3, one.tag, 3, other.tag)[0] <= 0.0:
                names = " and ".join(
                    repr(s.names[-1]) if s.names else "one without label" for s in (other, one)
                )
                raise CadError(
                    f"{request.solids_key}: the solids {names} of {request.name!r} touch; unite "
                    "them in the CAD file, or make each a body, and glue them: tie = true"
                )


def distance(gmsh, place: Iterable[float], entity: tuple[int, int]) -> float:
    """Distance of a point from a solid or a face, which ends at its edges [mm].

    The point stays in the CAD kernel, as its removal would take far longer; it does not get into
    the mesh as long as the model is not synchronised.
    """
    occ = gmsh.model.occ
    tag = occ.addPoint(*map(float, place))
    return float(occ.getDistance(0, tag, *entity)[0])


def parameters(gmsh, face: CadFace, count: int) -> np.ndarray:
    """Parameters of points of the surface of a face, in rows and columns, shape (count², 2).

    The face may cover a part of its surface only.
    """
    low, high = gmsh.model.getParametrizationBounds(2, face.tag)
    share = (np.arange(count) + 0.5) / count
    grid = np.meshgrid(*(a + share * (b - a) for a, b in zip(low, high, strict=True)))
    return np.stack(grid, axis=-1).reshape(-1, 2)


def in_mm(place: np.ndarray) -> str:
    """Coordinates [mm] as text."""
    return f"({', '.join(f'{x:.5g}' for x in np.round(place, 6) + 0.0)}) mm"


def listed(words: Iterable[object]) -> str:
    """First ones of some words or faces, for a message."""
    every = [str(word) for word in words]
    more = f", and {len(every) - _SHOWN} more" if len(every) > _SHOWN else ""
    return ", ".join(every[:_SHOWN]) + more


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


_NEAR = 0.01
"""Largest distance of a point from its face, relative to the size of the body."""
_SAME = 1e-4
"""Distance relative to the size of a body below which places coincide."""
_ALONG = 1e-4
"""Largest sine of the angle between the normals of a face and its plane."""
_ACROSS = 4
"""Points along each parameter of a face at which it is compared with a plane."""


def chosen_faces(
    gmsh, surface: SurfaceRequest, bodies: dict[str, CadBody]
) -> dict[str, list[CadFace]]:
    """Faces of a named surface by body.

    Raises
    ------
    CadError
        If a choice finds no face, or several where it needs one; with those that there are.
    """
    found: dict[int, CadFace] = {}
    for choice in surface.choices:
        names = [name for name in (surface.body, choice.body) if name is not None]
        unknown = [name for name in names if name not in bodies]
        if unknown:
            raise CadError(f"{surface.key}.body: unknown body; must be one of: {', '.join(bodies)}")
        among = [bodies[name] for name in bodies if set(names) <= {name}]
        try:
            found |= {face.tag: face for face in _faces(gmsh, surface.key, choice, among)}
        except CadError as error:
            reason = f"; {surface.reason}" if surface.reason else ""
            raise CadError(f"{error}{reason}") from None
    result: dict[str, list[CadFace]] = {}
    for face in found.values():
        result.setdefault(face.body, []).append(face)
    return result


def _faces(gmsh, key: str, choice: FaceChoice, among: list[CadBody]) -> Sequence[CadFace]:
    if not among:
        raise CadError(f"{key}.body: this surface belongs to another body")
    if choice.label is not None:
        return _labelled(key, choice.label, among)
    if choice.point is not None:
        return [_nearest(gmsh, key, np.array(choice.point) / UNIT, among)]
    assert choice.plane is not None
    normal, offset = choice.plane
    return _in_plane(gmsh, key, np.array(normal), offset / UNIT, among)


def _labelled(key: str, label: str, among: list[CadBody]) -> list[CadFace]:
    every = [face for body in among for face in body.faces]
    found = [face for face in every if face.label == label]
    if not found:
        labels = sorted({face.label for face in every} - {""})
        have = f"labels: {listed(labels)}" if labels else "none of them has a label"
        raise CadError(
            f"{key}: no face labelled {label!r}; {_counted(among)}; {have}; a face is also named "
            'by { point = ["0 mm", "0 mm", "5 mm"] } or { plane = "z", at = "5 mm" }'
        )
    return found


def _nearest(gmsh, key: str, place: np.ndarray, among: list[CadBody]) -> CadFace:
    """Face that a point lies on."""
    size = max(body.size for body in among)
    every = [face for body in among for face in body.faces]
    boxes = np.array([face.box for face in every])
    beyond = np.maximum(np.maximum(boxes[:, 0] - place, place - boxes[:, 1]), 0.0)
    least = np.linalg.norm(beyond, axis=1)
    measured: list[tuple[float, CadFace]] = []
    for k in np.argsort(least, kind="stable"):
        if len(measured) > 1 and least[k] > measured[1][0]:
            break
        measured.append((distance(gmsh, place, (2, every[k].tag)), every[k]))
        measured.sort(key=lambda pair: pair[0])
    (near, face), *others = measured
    where = in_mm(place)
    if near > _NEAR * size:
        raise CadError(
            f"{key}: no face near the point {where}; the nearest one is the {face}, {near:.4g} mm "
            f"away; {_counted(among)}"
        )
    equal = [other for gap, other in others if gap <= near + _SAME * size]
    if equal:
        raise CadError(
            f"{key}: {1 + len(equal)} faces are equally near the point {where}: "
            f"{listed([face, *equal])}; name a point inside one of them"
            + (", or its body" if any(other.body != face.body for other in equal) else "")
        )
    return face


def _in_plane(
    gmsh, key: str, normal: np.ndarray, offset: float, among: list[CadBody]
) -> list[CadFace]:
    """Plane faces that lie in a plane."""
    size = max(body.size for body in among)
    heights = {
        face: height
        for body in among
        for face in body.faces
        if (height := _height(gmsh, face, normal, _SAME * size)) is not None
    }
    found = [face for face, height in heights.items() if abs(height - offset) <= _SAME * size]
    if not found:
        others = sorted({f"{height:.6g}" for height in heights.values()}, key=float)
        have = f"at {listed(others)} mm" if others else "nowhere"
        raise CadError(
            f"{key}: no face in the plane at {offset:.6g} mm; {_counted(among)}, parallel to this "
            f"plane {have}"
        )
    return found


def _height(gmsh, face: CadFace, normal: np.ndarray, tolerance: float) -> float | None:
    """Position of a plane face along a normal [mm]; None if it is not normal to it."""
    places = parameters(gmsh, face, _ACROSS).ravel()
    normals = gmsh.model.getNormal(face.tag, places).reshape(-1, 3)
    if np.linalg.norm(np.cross(normals, normal), axis=1).max() > _ALONG:
        return None
    heights = gmsh.model.getValue(2, face.tag, places).reshape(-1, 3) @ normal
    return float(heights.mean()) if np.ptp(heights) <= tolerance else None


def _counted(among: list[CadBody]) -> str:
    """Number of faces of bodies, for messages."""
    return " and ".join(f"{body.name!r} has {len(body.faces)} faces" for body in among)

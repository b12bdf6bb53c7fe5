"""Solids and faces of CAD files in a gmsh model, in millimetres."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from .request import BodyRequest, CadError
from .step_text import labelled_solids, matched

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

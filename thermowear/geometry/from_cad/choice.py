"""Faces of CAD bodies by their labels, by a point on them, or by a plane."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .request import CadError, FaceChoice, SurfaceRequest
from .solids import UNIT, CadBody, CadFace, distance, in_mm, listed, parameters

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

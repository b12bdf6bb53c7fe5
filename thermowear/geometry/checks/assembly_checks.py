"""Checks of the mesh of several bodies that was read from files.

Its surfaces, supports and pieces, and the relative position of the faces of each contact, which are
compared along the mean normal of the first one.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ...case.assembly.holders import pressed
from ...case.assembly.schema import AssemblyCase
from ...case.assembly.tables import AssemblyHolderTable
from ...case.tables.materials import SQUEEZED, check_pressure, softest
from ...errors import CaseError, note
from ...laws.motions import NOTHING_PRESSED
from ..mesh.mixed import AnyMesh, block_of, block_with
from .mesh_checks import (
    check_one_curve,
    check_pieces,
    check_shared_edges,
    depth,
    length,
    note_polygons,
    note_pressure,
    note_size,
    points_of,
    whole_bodies,
)
from .pair_checks import MUCH, facing_pieces, pieces, section_gap
from .solid_pairs import area_vector, distances, facing_triangles, projected_area
from .solid_surfaces import (
    PLANES,
    check_plane,
    check_shared_facets,
    check_solid_face,
    check_solid_pieces,
)

_TOUCHING = 1e-9
"""Overlap, by the height of a body, below which faces just touch."""
_CLOSED = 0.05
"""Mean normal below which a face encloses the other body, and has no side."""


@dataclass(frozen=True)
class _Opposite:
    """Faces of a contact compared along the mean normal of the first one.

    Smallest distance, negative where the bodies overlap [m], and its position as text; lesser area
    of both [m²]; size along the normal [m] and name of the thinner body.
    """

    gap: float
    where: str
    area: float
    height: float
    body: str


def check_assembly(mesh: AnyMesh, case: AssemblyCase) -> None:
    """Check the mesh of a case of several bodies.

    Raises
    ------
    CaseError
        If surfaces share facets, a contact face branches, a piece of a body is not held, a support
        does not lie in its plane, or the faces of a contact do not fit each other.
    """
    mesh = whole_bodies(mesh, case.geometry)
    if not case.geometry.sized:  # CAD files have a unit of their own
        note_size(mesh)
    for block in mesh.blocks:
        (check_shared_facets if case.model == "3d" else check_shared_edges)(block)
    for path, face in _faces(case):
        _check_face(mesh, case, path, face)
    for body in case.geometry.bodies:
        _check_body(mesh, case, body)
    area, overlaps = 0.0, pressed(case)
    for name in case.contacts:
        faces = _compared(mesh, case, name)
        if not case.contacts[name].tie:
            _note_polygons(mesh, case, name, faces)
        if faces is None:  # no bound of the load
            area, overlaps = np.inf, True
            continue
        overlaps = overlaps or faces.gap < -_TOUCHING * faces.height
        _check_distance(case, name, faces)
        area += faces.area
    if not overlaps:
        raise CaseError(f"holders: {NOTHING_PRESSED}")
    _check_loads(mesh, case, area)
    for name in case.holders:
        _check_direction(mesh, case, name)


def check_drawn(mesh: AnyMesh, case: AssemblyCase) -> None:
    """Check the loads of a section that was drawn from its sizes.

    Raises
    ------
    CaseError
        If they do not leave strains small.
    """
    faces = [contact.between or () for contact in case.contacts.values()]
    _check_loads(mesh, case, sum(min(_section_area(mesh, case, f) for f in pair) for pair in faces))


def _faces(case: AssemblyCase) -> Iterator[tuple[str, str]]:
    """All contact faces, with the paths of their keys."""
    for name, contact in case.contacts.items():
        for face in contact.between or ():
            yield f"contacts.{name}.between", face


def _check_face(mesh: AnyMesh, case: AssemblyCase, path: str, face: str) -> None:
    block = block_with(mesh, face)
    if case.model == "3d":
        index = case.geometry.bodies.index(case.geometry.body_of(face))
        check_solid_face(block, face, index, path)
    else:
        check_one_curve(block, face, path)


def _check_body(mesh: AnyMesh, case: AssemblyCase, body: str) -> None:
    """Check the supports of a body, and that each of its pieces is held or glued."""
    table, geometry = case.bodies[body], case.geometry
    for key, axis in PLANES.items():
        for surface in getattr(table, key):
            check_plane(mesh, points_of(mesh, body), f"bodies.{body}.{key}", surface, axis)
    held = [surface for holder in case.holders.values() for surface in holder.surface]
    glued = [s for contact in case.contacts.values() if contact.tie for s in contact.between or ()]
    own = [s for s in (*held, *table.fixed, *glued) if geometry.body_of(s) == body]
    own += [*table.symmetry, *table.rollers, *table.mid_plane]
    if own:
        check = check_solid_pieces if case.model == "3d" else check_pieces
        check(block_of(mesh, body), body, own)


def _compared(mesh: AnyMesh, case: AssemblyCase, name: str) -> _Opposite | None:
    """Compare the faces of a contact; None where one encloses the other."""
    path, faces = f"contacts.{name}.between", case.contacts[name].between
    assert faces is not None  # the case has been checked
    normal = _normal(mesh, case, faces[0])
    if normal is None:
        return None
    first, second = (case.geometry.body_of(face) for face in faces)
    heights = {body: float(np.ptp(points_of(mesh, body) @ normal)) for body in (first, second)}
    body = min(heights, key=heights.__getitem__)
    facing = facing_triangles if case.model == "3d" else facing_pieces
    turn = _downwards(normal)
    down, up = facing(mesh, faces, turn)
    if not len(up):
        raise CaseError(
            f"{path}: {faces[1]!r} does not face {faces[0]!r}; the outward normals of faces that "
            "touch point against each other"
        )
    if case.model == "3d":
        area = min(projected_area(mesh, face, turn) for face in faces)
        found = distances(down, up, area, path, turn)
        return _Opposite(found.gap, f" {found.where}", area, heights[body], body)
    gap, _ = section_gap(down, up, path)
    area = min(_section_area(mesh, case, face) for face in faces)
    return _Opposite(gap, "", area, heights[body], body)


def _normal(mesh: AnyMesh, case: AssemblyCase, face: str) -> np.ndarray | None:
    """Mean outward unit normal of a face, shape (gdim,); None if it is closed."""
    if case.model == "3d":
        vector, area = area_vector(mesh, face)
    else:
        x, y = _along(mesh, face).T
        vector = np.array([y.sum(), -x.sum()])
        area = float(np.hypot(x, y).sum())
    size = float(np.linalg.norm(vector))
    return None if size < _CLOSED * area else vector / size


def _downwards(normal: np.ndarray) -> np.ndarray:
    """Rotation of a unit normal to -y in a section, or to -z in space, shape (gdim, gdim)."""
    if len(normal) == 2:
        x, y = normal
        return np.array([[-y, x], [-x, -y]])
    return Rotation.align_vectors([[0.0, 0.0, -1.0]], [normal])[0].as_matrix()


def _along(mesh: AnyMesh, face: str) -> np.ndarray:
    """Segments of a face of a section, from end to end, shape (n, 2) [m]."""
    ends = pieces(block_with(mesh, face), face)
    return ends[:, 1] - ends[:, 0]


def _section_area(mesh: AnyMesh, case: AssemblyCase, face: str) -> float:
    """Area that a face of a section stands for [m²]."""
    lengths = np.linalg.norm(_along(mesh, face), axis=1)
    if case.model != "axisymmetric":
        return float(lengths.sum()) * (case.geometry.thickness_factor or 0.0)
    radii = pieces(block_with(mesh, face), face)[..., 0].mean(axis=1)
    return float(2 * np.pi * radii @ lengths)


def _check_distance(case: AssemblyCase, name: str, faces: _Opposite) -> None:
    """Check that bodies neither overlap nor lie apart, and that glued faces touch."""
    path, overlap = f"contacts.{name}.between", -faces.gap
    of_body = f"of {faces.body!r}, which measures {length(faces.height)} across"
    if overlap > SQUEEZED * faces.height:
        raise CaseError(
            f"{path}: the bodies overlap by {length(overlap)}{faces.where}, "
            f"{overlap / faces.height:.0%} {of_body}; move the faces to initial contact"
        )
    if faces.gap > faces.height:
        raise CaseError(
            f"{path}: the bodies lie {length(faces.gap)} apart{faces.where}, more than the height "
            f"{of_body}; move the faces to initial contact"
        )
    if case.contacts[name].tie and abs(overlap) > MUCH * faces.height:
        raise CaseError(
            f"{path}: the glued faces lie {length(abs(overlap))} "
            f"{'over' if overlap > 0 else 'from'} each other{faces.where}; let them touch"
        )
    if overlap > MUCH * faces.height:
        note(
            f"{path}: the bodies overlap by {length(overlap)} before loading{faces.where}, "
            f"{overlap / faces.height:.1%} {of_body}"
        )


def _note_polygons(
    mesh: AnyMesh, case: AssemblyCase, name: str, opposite: _Opposite | None
) -> None:
    """Note flat facets that stand for curved faces, compared with the largest loads of holders."""
    faces, closed = case.contacts[name].between, 0.0
    assert faces is not None  # the case has been checked
    if opposite is not None:
        modulus = softest(case)[1]
        loads = [_loads(holder) for holder in case.holders.values()] or [(0.0, 0.0)]
        forces, approaches = zip(*loads, strict=True)
        thickness = case.geometry.thickness_factor
        closed = max(approaches) + depth(max(forces), opposite.area, modulus, thickness)
        closed = closed or -opposite.gap
    note_polygons(mesh, faces, closed, "geometry.curved = [{}]")


def _loads(holder: AssemblyHolderTable) -> tuple[float, float]:
    """Largest force [N] and approach [m] of a holder."""
    history = holder.history
    courses = (None, None) if history is None else (history.force, history.approach)
    return max(courses[0] or (holder.force or 0.0,)), max(courses[1] or (holder.approach or 0.0,))


def _check_loads(mesh: AnyMesh, case: AssemblyCase, area: float) -> None:
    """Check that forces and approaches are small, as wrong units are not.

    Parameters
    ----------
    mesh : TaggedMesh or MixedMesh
    case : AssemblyCase
    area : float
        Of all contacts, which bear a force together at the most [m²].
    """
    for name, holder in case.holders.items():
        force, approach = _loads(holder)
        if area > 0.0:
            note_pressure(f"holders.{name}.force", force / area)
            check_pressure(f"holders.{name}.force", force / area, " on all contacts", case)
        size = float(np.ptp(mesh.points, axis=0).max())
        if approach > SQUEEZED * size:
            unit = "geometry.length_unit" if case.geometry.from_file else "the units"
            raise CaseError(
                f"holders.{name}.approach: {length(approach)} is {approach / size:.0%} of the size "
                f"of the bodies (check {unit})"
            )


def _check_direction(mesh: AnyMesh, case: AssemblyCase, name: str) -> None:
    """Note a force along the default direction that points away from all contacts of its body."""
    holder = case.holders[name]
    forced = holder.force is not None or (holder.history is not None and holder.history.force)
    if holder.direction is not None or not forced or "z" not in holder.free:
        return
    surface = holder.surface[0]
    direction = np.array(case.geometry.press_direction(surface))
    body = case.geometry.body_of(surface)
    faces = [face for table in case.sliding.values() for face in table.between or ()]
    own = [face for face in faces if case.geometry.body_of(face) in case.glued[body]]
    normals = [normal for face in own if (normal := _normal(mesh, case, face)) is not None]
    if (
        own
        and len(normals) == len(own)
        and all(normal @ direction < -_CLOSED for normal in normals)
    ):
        axis = "xyz"[int(np.argmax(np.abs(direction)))]
        opposite = [float(x) for x in -direction + 0.0]
        note(
            f"holders.{name}: presses {body!r} along -{axis} by default, away from its contacts; "
            f"towards them with direction = {opposite}"
        )

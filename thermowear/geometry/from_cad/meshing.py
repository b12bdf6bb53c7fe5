"""Quadratic tetrahedra of CAD bodies by gmsh: sizes, and curved cells."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..mesh.tagged import jacobians
from .request import CadError, Zone
from .solids import UNIT, CadBody, CadFace, in_mm

GROWTH = 0.35
"""Increase of the element size per distance from the contact."""
MOST_TETRAHEDRA = 1_000_000
"""Largest number of tetrahedra of all bodies."""
_PER_CUBE = 8.0
"""Number of tetrahedra in a cube of their size."""
_PER_TURN = 12
"""Least number of elements round a circle."""
_SMALLEST = 0.3
"""Smallest element size relative to that at the edges of the contact."""
_PER_WIDTH = 1.5
"""Largest element size at a face relative to its width."""
_PER_HALF_WIDTH = 5.0
"""Number of elements across half of a zone that is to be resolved."""
_MOST_IN_ZONE = 30_000
"""Largest number of tetrahedra of a body because of such a zone."""
_SPACING = 0.7
"""Distance of the points from which distances are measured, relative to the size there."""


@dataclass(frozen=True)
class Refinement:
    """Faces of a contact towards which the meshes of its two bodies become finer.

    Attributes
    ----------
    faces : tuple of CadFace
        Those of the smaller side.
    bodies : sequence of CadBody
    zones : sequence of Zone
        Small zones that are to be resolved.
    """

    faces: tuple[CadFace, ...]
    bodies: Sequence[CadBody]
    zones: Sequence[Zone] = ()


def refinement(
    faces: tuple[Sequence[CadFace], Sequence[CadFace]],
    bodies: Sequence[CadBody],
    zones: Sequence[Zone] = (),
) -> Refinement:
    """Refinement of a contact, at the side with the lesser area."""
    areas = [sum(face.area for face in of_body) for of_body in faces]
    return Refinement(tuple(faces[int(np.argmin(areas))]), bodies, zones)


def set_sizes(gmsh, bodies: Sequence[CadBody], contacts: Sequence[Refinement]) -> None:
    """Set the field of element sizes.

    Raises
    ------
    CadError
        If there were too many elements.
    """
    fields, limits = gmsh.model.mesh.field, []
    least, curves = [np.inf], [_edges(gmsh, contact) for contact in contacts]
    _check_number(gmsh, bodies, contacts, curves)
    for contact, edges in zip(contacts, curves, strict=True):
        faces = [face.tag for face in contact.faces]
        for side, body in enumerate(contact.bodies):
            tags = [solid.tag for solid in body.solids]
            size, inside, edge = body.element_sizes
            for zone in contact.zones:
                near = _zone_size(zone) / UNIT
                if body.request.contact_size is None and near < edge:
                    field = fields.add("MathEval")
                    fields.setString(field, "F", _about(zone, side, near))
                    limits.append(_within(fields, field, tags, _boundary(gmsh, tags)))
                    least.append(near)
            own = [
                _towards(fields, "SurfacesList", faces, inside, size, _extent(contact.faces)),
                _towards(fields, "CurvesList", edges, edge, size, _longest(gmsh, edges)),
            ]
            limits += [_within(fields, field, tags, _boundary(gmsh, tags)) for field in own]
            least.append(edge)
    for body in bodies:
        limits += _at_narrow_faces(gmsh, body)
        limits.append(fields.add("Constant"))
        fields.setNumber(limits[-1], "VIn", body.element_sizes[0])
        fields.setNumbers(limits[-1], "VolumesList", [solid.tag for solid in body.solids])
        least.append(body.element_sizes[0])
    smallest = fields.add("Min")
    fields.setNumbers(smallest, "FieldsList", limits)
    fields.setAsBackgroundMesh(smallest)
    settings = {
        "MeshSizeMin": _SMALLEST * min(least),
        "MeshSizeMax": max(body.element_sizes[0] for body in bodies),
        "MeshSizeFromPoints": 0,
        "MeshSizeExtendFromBoundary": 0,
        "MeshSizeFromCurvature": _PER_TURN,
        "Algorithm3D": 1,
        "Optimize": 1,
    }
    for name, value in settings.items():
        gmsh.option.setNumber(f"Mesh.{name}", value)


def _at_narrow_faces(gmsh, body: CadBody) -> list[int]:
    """Fields that make elements smaller at faces narrower than they would be.

    Elements that are much longer than a face is wide have bad cells behind them. Faces of similar
    widths have a field in common.
    """
    fields, tags = gmsh.model.mesh.field, [solid.tag for solid in body.solids]
    size, groups = body.element_sizes[0], dict[int, list[CadFace]]()
    for face in body.faces:
        near = _PER_WIDTH * width(gmsh, face)
        if near < size:
            groups.setdefault(math.floor(2 * math.log2(near / size)), []).append(face)
    result = []
    for step, faces in groups.items():
        near = size * 2 ** (step / 2)
        of_faces = [face.tag for face in faces]
        field = _towards(fields, "SurfacesList", of_faces, near, size, _extent(faces))
        result.append(_within(fields, field, tags, _boundary(gmsh, tags)))
    return result


def width(gmsh, face: CadFace) -> float:
    """Width of a long face, from its area and the length of its edges [mm]."""
    edges = gmsh.model.getBoundary([(2, face.tag)], combined=False, oriented=False)
    around = sum(gmsh.model.occ.getMass(1, tag) for _, tag in edges)
    return 2 * face.area / around if around else np.inf


def _towards(fields, key: str, entities: list[int], near: float, far: float, extent: float) -> int:
    """Field that grows with the distance from faces or curves [mm]."""
    away = fields.add("Distance")
    fields.setNumbers(away, key, entities)
    fields.setNumber(away, "Sampling", max(20, math.ceil(extent / (_SPACING * near))))
    result = fields.add("Threshold")
    settings = {
        "InField": away,
        "SizeMin": near,
        "SizeMax": far,
        "DistMin": near / 2,
        "DistMax": near / 2 + max(far - near, 1e-9 * far) / GROWTH,
    }
    for name, value in settings.items():
        fields.setNumber(result, name, value)
    return result


def _zone_size(zone: Zone) -> float:
    """Element size in a zone: several across it, unless that were too many [m]."""
    size = zone.width / _PER_HALF_WIDTH
    while _tetrahedra(zone, size) > _MOST_IN_ZONE:
        size *= 1.1
    return size


def _tetrahedra(zone: Zone, size: float) -> float:
    """Estimate of their number in one body, in a zone and where they grow around it."""
    straight, radius = max(zone.length - zone.width, 0.0), zone.width
    inside = math.pi * radius**2 * straight + 2 / 3 * math.pi * radius**3
    away = np.geomspace(1.0, 1e3, 200)
    area = 2 * math.pi * (radius * away) ** 2 + 2 * math.pi * radius * away * straight
    around = area / (size + GROWTH * radius * (away - 1.0)) ** 3
    return _PER_CUBE * float(inside / size**3 + np.trapezoid(around, radius * away))


def _about(zone: Zone, side: int, near: float) -> str:
    """Size as gmsh's ``MathEval``: it grows with the distance from a zone [mm]."""
    x, y, z = (
        f"({c}-({value / UNIT!r}))" for c, value in zip("xyz", zone.centres[side], strict=True)
    )
    u, v, w = (f"({value!r})" for value in zone.along)
    along = f"({x}*{u}+{y}*{v}+{z}*{w})"
    straight = max(zone.length - zone.width, 0.0) / UNIT
    past = f"(0.5*(Fabs({along})-{straight!r}+Fabs(Fabs({along})-{straight!r})))"
    across = f"({x}*{x}+{y}*{y}+{z}*{z}-{along}*{along})"
    beyond = f"(Sqrt(Fabs({across}+{past}*{past}))-{zone.width / UNIT!r})"
    return f"{near!r}+{GROWTH / 2}*({beyond}+Fabs({beyond}))"


def _within(fields, field: int, solids: list[int], faces: list[int]) -> int:
    """Field of one body alone."""
    result = fields.add("Restrict")
    fields.setNumber(result, "InField", field)
    fields.setNumbers(result, "VolumesList", solids)
    fields.setNumbers(result, "SurfacesList", faces)
    return result


def _boundary(gmsh, solids: list[int]) -> list[int]:
    pairs = gmsh.model.getBoundary([(3, tag) for tag in solids], oriented=False)
    return [tag for _, tag in pairs]


def _edges(gmsh, contact: Refinement) -> list[int]:
    """Curves round the faces of a contact, those between two of them left out."""
    faces = [(2, face.tag) for face in contact.faces]
    return [tag for _, tag in gmsh.model.getBoundary(faces, combined=True, oriented=False)]


def _extent(faces: Sequence[CadFace]) -> float:
    return max(float(np.linalg.norm(face.box[1] - face.box[0])) for face in faces)


def _longest(gmsh, curves: list[int]) -> float:
    return max((gmsh.model.occ.getMass(1, tag) for tag in curves), default=0.0)


def _check_number(
    gmsh, bodies: Sequence[CadBody], contacts: Sequence[Refinement], curves: list[list[int]]
) -> None:
    """Reject sizes that lead to too many elements, estimated from volumes, areas and lengths."""
    occ, count = gmsh.model.occ, 0.0
    for body in bodies:
        volume = sum(occ.getMass(3, solid.tag) for solid in body.solids)
        count += volume / body.element_sizes[0] ** 3
    for contact, edges in zip(contacts, curves, strict=True):
        area = sum(face.area for face in contact.faces)
        length = sum(occ.getMass(1, tag) for tag in edges)
        for body in contact.bodies:
            _, inside, edge = body.element_sizes
            count += area / (2 * GROWTH * inside**2)
            count += length * math.pi / 4 * (1 / edge - 1 / inside) / GROWTH**2
    if _PER_CUBE * count > MOST_TETRAHEDRA:
        raise CadError(
            f"mesh.size: the sizes lead to about {_PER_CUBE * count:.2g} tetrahedra; at most "
            f"{MOST_TETRAHEDRA:.2g} can be made: increase mesh.size, mesh.contact_size or "
            "mesh.grading"
        )


_TETRAHEDRON, _TRIANGLE = 11, 9
"""Quadratic elements of gmsh."""
_ATTEMPTS = ((6, 0.3, 1.0), (5, 0.6, 1.0), (6, 0.3, 0.9), (6, 0.3, 0.8), (5, 0.6, 0.7))
"""Algorithms of gmsh on faces (frontal, Delaunay), quality that it aims at for cells, and factor of
their sizes: tried until there are no poor cells."""
_POOR, _LEAST = 0.05, 1e-3
"""Scaled Jacobian of poor cells, and the least that is accepted."""
_PLACES = 4
"""Points along each side of a cell at which its Jacobian is evaluated."""


def make_mesh(gmsh, bodies: Sequence[CadBody]) -> None:
    """Mesh all bodies in the sizes that have been set.

    Raises
    ------
    CadError
        If gmsh fails, or cells are tangled.
    """
    mesh = gmsh.model.mesh
    try:
        if _best_mesh(gmsh, bodies) < _POOR:
            mesh.optimize("HighOrderElastic")
        if _least(gmsh, bodies) < _LEAST:
            mesh.optimize("HighOrder")  # ends the process where it fails
    except CadError:
        raise
    except Exception as trouble:  # gmsh raises nothing more specific
        reason = str(trouble).strip() or f"it gave no reason; {_narrowest(gmsh, bodies)}"
        raise CadError(f"mesh.size: gmsh could not mesh the bodies: {reason}") from None
    for body in bodies:
        found = _quality(gmsh, body)
        if found.min() < _LEAST:
            where = _places(gmsh, body)[int(found.argmin())].mean(axis=0)
            raise CadError(
                f"mesh.size: {np.count_nonzero(found < _LEAST)} of {len(found)} curved cells of "
                f"{body.name!r} are tangled (smallest scaled Jacobian {found.min():.2g}), one at "
                f"{in_mm(where)}; use smaller elements"
            )


def _narrowest(gmsh, bodies: Sequence[CadBody]) -> str:
    """Text on the narrowest face of all bodies, which often cannot be meshed."""
    faces = [(width(gmsh, face), body.name, face) for body in bodies for face in body.faces]
    size, name, face = min(faces, key=lambda of: of[0])
    return (
        f"the narrowest face, {size:.3g} mm wide, is one of {name!r} near "
        f"{in_mm(np.mean(face.box, axis=0))}: leave it out in the CAD program, or use a smaller "
        "mesh.size"
    )


def _best_mesh(gmsh, bodies: Sequence[CadBody]) -> float:
    """Mesh the bodies in the ways of `_ATTEMPTS`; the smallest scaled Jacobian of the best one."""
    found: dict[tuple[int, float, float], float] = {}
    for attempt in _ATTEMPTS:
        found[attempt] = _generated(gmsh, bodies, *attempt)
        if found[attempt] >= _POOR:
            return found[attempt]
    best = max(found, key=found.__getitem__)
    return _generated(gmsh, bodies, *best)


def _generated(
    gmsh, bodies: Sequence[CadBody], algorithm: int, quality: float, factor: float
) -> float:
    """Mesh the bodies with quadratic cells; their smallest scaled Jacobian."""
    gmsh.option.setNumber("Mesh.Algorithm", algorithm)
    gmsh.option.setNumber("Mesh.OptimizeThreshold", quality)
    gmsh.option.setNumber("Mesh.MeshSizeFactor", factor)
    gmsh.model.mesh.clear()
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(2)
    return _least(gmsh, bodies)


def _least(gmsh, bodies: Sequence[CadBody]) -> float:
    """Smallest scaled Jacobian of all cells."""
    return float(min(_quality(gmsh, body).min() for body in bodies))


def _quality(gmsh, body: CadBody) -> np.ndarray:
    """Smallest scaled Jacobian of each cell of a body, shape (n,)."""
    places = _places(gmsh, body)
    if not len(places):
        raise CadError(f"mesh.size: gmsh could not mesh {body.name!r} with tetrahedra")
    least, most, mean = jacobians("tetrahedron", 2, places, _PLACES)
    return np.nan_to_num(np.where(mean < 0, -most, least), nan=-1.0)


def _places(gmsh, body: CadBody) -> np.ndarray:
    """Nodes of the cells of a body, shape (n, 10, 3) [mm]."""
    found = [gmsh.model.mesh.getElementsByType(_TETRAHEDRON, s.tag)[1] for s in body.solids]
    cells = np.concatenate(found).astype(np.int64).reshape(-1, 10)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    return coordinates.reshape(-1, 3)[_rows(tags)[cells]]


def _rows(tags: np.ndarray) -> np.ndarray:
    """Indices of nodes by their tags."""
    row = np.zeros(int(tags.max(initial=0)) + 1, dtype=np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    return row


def mesh_arrays(
    gmsh, bodies: Sequence[CadBody], surfaces: Mapping[str, Mapping[str, Sequence[CadFace]]]
) -> dict[str, np.ndarray]:
    """Nodes [m] and elements of the mesh.

    Parameters
    ----------
    gmsh : module
    bodies : sequence of CadBody
    surfaces : mapping
        Faces by name of the surface and body.

    Returns
    -------
    dict of str to ndarray
        ``points``; ``cells_B`` of body B and ``solid_B_S`` with the indices of those of its solid
        S; ``facets_B`` and ``surface_B_K`` of the K-th surface.
    """
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    row = _rows(tags)
    arrays = {"points": UNIT * coordinates.reshape(-1, 3)}
    for b, body in enumerate(bodies):
        arrays[f"cells_{b}"], of_solid = _elements(
            gmsh, _TETRAHEDRON, row, [[solid.tag] for solid in body.solids]
        )
        arrays |= {f"solid_{b}_{s}": found for s, found in enumerate(of_solid)}
        own = [surfaces[name].get(body.name, ()) for name in surfaces]
        arrays[f"facets_{b}"], of_surface = _elements(
            gmsh, _TRIANGLE, row, [[face.tag for face in faces] for faces in own]
        )
        arrays |= {f"surface_{b}_{k}": found for k, found in enumerate(of_surface) if len(found)}
    return arrays


def _elements(
    gmsh, kind: int, row: np.ndarray, groups: list[list[int]]
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Nodes of the elements of some entities, and the indices of those of each group."""
    count = 6 if kind == _TRIANGLE else 10
    found, members, start = [np.empty((0, count), dtype=np.int64)], [], 0
    for tags in groups:
        nodes = [gmsh.model.mesh.getElementsByType(kind, tag)[1] for tag in tags]
        of_group = np.concatenate([np.empty(0), *nodes]).astype(np.int64).reshape(-1, count)
        found.append(row[of_group])
        members.append(np.arange(start, start + len(of_group)))
        start += len(of_group)
    return np.concatenate(found), members

"""Geometry update: mesh motion to the worn faces and transfer of the state."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...balances import relative, require
from ...bulk.mesh_motion import extended
from ...bulk.transfer import transferred
from ...contact.search.face import Surface
from ...contact.search.refinement import Rule
from ...contact.wear.worn_face import WornFace, nodes_of
from ...errors import CaseError, ComputationError
from ...geometry.mesh.tagged import TaggedMesh, scaled_jacobians
from ...geometry.moving.moved import nodes_at
from ...geometry.moving.new_face import NewFace
from ...laws.motions import combined
from ...parallel import on_root
from ...serialise import serialisable
from ..interface.interface_problem import InterfaceProblem, interface_problem
from ..interface.sdirk import InterfaceState
from ..system.building import build
from ..system.setup_cache import SetupCache
from ..system.system import System
from ..system.worn_geometry import WornGeometry, along
from .moving_faces import MovingFaces, gap_of_initial_shape, movable_body
from .remesh import FLOOR, carrying_error, improved, on_new_faces

serialisable(WornGeometry)
serialisable(TaggedMesh)
serialisable(NewFace)
serialisable(Rule)

_TOLERANCE = 1e-10
"""Relative tolerance of the volume removed by the mesh motion."""
_ITERATIONS = 20
_FADED = 0.1
"""Smallest reference pressure of a change, as a fraction of the largest so far."""


def updated(
    problem: InterfaceProblem,
    faces: MovingFaces,
    depth: np.ndarray,
    state: InterfaceState,
    time: float,
) -> tuple[InterfaceProblem, InterfaceState, float]:
    """Move the meshes of a problem by depths (2, n) kept in the gap [m]. Every rank calls.

    Returns
    -------
    problem : InterfaceProblem
    state : InterfaceState
    change : float
        Change of pressure and temperatures by the update, relative to their means.

    Raises
    ------
    ComputationError
        If cells would become too thin or too distorted, or the faces cannot be paired.
    """
    system = problem.system
    with system.phases("move meshes"):
        worn, renewed = _moved(system, faces, faces.followed(depth), state)
    try:
        following = build(system.model, system.comm, system.phases, system.zone, SetupCache(), worn)
    except CaseError as fault:  # blames the input; here the bodies are computed
        raise ComputationError(
            f"wear: at {time:.6g} s the worn faces do not fit each other any more ({fault})"
        ) from None
    rows, corrected = _carried_wear(system, following, state.worn)
    error = max(corrected, carrying_error(worn, following.pairing)) if renewed else 0.0
    worn = replace(worn, carrying_error=max(worn.carrying_error, error))
    after, rise = interface_problem(following), None
    if state.stored is not None:
        with system.phases("carry temperatures over"):
            rise, error = _carried_rise(system, following, state.stored.rise)
        largest = max(state.stored.largest, 1e-300)
        worn = replace(worn, heat_error=max(worn.heat_error, error / largest))
    with system.phases("contact"):
        found = after.take_over(problem, state, rows, rise, time)
    change = _change(following, state, found)
    worn = replace(worn, change=max(worn.change, change))
    after.system = replace(following, worn=worn)  # with the errors of this update
    return after, found, change


def _change(after: System, state: InterfaceState, found: InterfaceState) -> float:
    """Largest relative change of pressure and temperature rise by an update.

    Area means; reference pressures are at least `_FADED` times the largest pressure so far.
    """
    fields = [(state.pressure, found.pressure, _FADED * state.largest)]
    if state.faces is not None and found.faces is not None:
        rises = zip(state.faces.rise, found.faces.rise, strict=True)
        fields += [(old, new, 0.0) for old, new in rises]
    assert after.worn is not None
    changes = [0.0]
    for old, new, least in fields:
        expected = after.worn.carried(old, after.pairing)
        scale = float(after.weights @ np.maximum(np.abs(expected), least))
        if scale > 0.0:
            changes.append(float(after.weights @ np.abs(new - expected)) / scale)
    return max(changes)


def _carried_wear(before: System, after: System, worn: np.ndarray) -> tuple[np.ndarray, float]:
    """Volume-preserving transfer of worn depths (n_wearing, n) to the moved mesh [m].

    Also returns the relative volume correction that this needed.
    """
    assert after.worn is not None
    bodies = list(after.laws)
    in_mesh = after.worn.depth[bodies]
    # the small rest in the gap matters most: carry it separately from the part in the mesh
    left = after.worn.carried(worn - in_mesh, after.pairing)
    rows = after.worn.carried(in_mesh, after.pairing) + left
    lost = np.zeros(2) if before.worn is None else before.worn.lost
    error = 0.0
    for row, body, depth in zip(rows, bodies, worn, strict=True):
        had = (depth - before.moved[body]) @ before.weights + lost[body]
        has = (row - after.moved[body]) @ after.weights + after.worn.lost[body]
        if had > 0.0:
            row *= 1.0 + (had - has) / (row @ after.weights)
            error = max(error, abs(had - has) / had)
    return rows, error


def _moved(
    system: System, moving: MovingFaces, depth: np.ndarray, state: InterfaceState
) -> tuple[WornGeometry, bool]:
    """Geometry with the meshes moved by depths (2, n), and True if a body has been remeshed."""
    before, faces = moving.geometry, moving.faces
    offsets = {index: face.offsets(depth[index]) for index, face in faces.items()}
    mesh, lost = _followed(system, before, faces, offsets, depth @ system.weights)
    mesh, quality, renewed = on_root(
        system.comm, lambda: _remeshed(system, before, mesh, list(faces))
    )
    if not quality >= FLOOR:  # NaN for degenerate cells
        raise ComputationError(
            f"geometry update: cells of the worn bodies become too slanted (scaled Jacobian "
            f"{quality:.2g}, at least {FLOOR:g}); use fewer or more even elements along the "
            'contact (mesh.elements, mesh.grading), or wear.update = "never"'
        )
    taken = np.zeros_like(depth)
    for index, face in faces.items():
        taken[index] = face.depths(offsets[index])
    motion = combined(system.holder.motions, state.contact.motion)
    expected = np.array([taken[index] @ system.weights for index in faces])
    total = before.lost + lost
    missing = float(np.abs(lost[list(faces)] - expected).max())
    error = max(before.volume_error, relative(missing, float(np.abs(total).max())))
    require(geometry_volume_error=error)
    worn = replace(
        before,
        mesh=mesh,
        pieces=_kept_points(system, state, renewed),
        renewed={},
        at=along(system.pairing),
        depth=system.moved + taken,
        missing_shape=_missing_shape(system, before, state),
        holder=(motion.translation, motion.rotation),
        lost=total,
        updates=before.updates + 1,
        quality=min(before.quality, quality),
        volume_error=error,
    )
    return (on_new_faces(worn, system, renewed), True) if renewed else (worn, False)


def _missing_shape(system: System, before: WornGeometry, state: InterfaceState) -> np.ndarray:
    """Gap of the initial shape minus that of the unworn faces at the points, shape (n,) [m].

    The first update replaces gaps along the normals of the unworn faces, which deviate from the
    paths of the nodes of curved faces, by gaps between the actual faces. The difference is left out
    of the gap where wear has closed it; ahead of each edge of the wear only its deviation from the
    value at the edge counts.
    """
    missing_shape, pairing = before.carried(before.missing_shape, system.pairing), system.pairing
    reached = np.any(state.worn > 0.0, axis=0)
    if before.updates > 0 or isinstance(pairing.sides[0].face, Surface) or not reached.any():
        return missing_shape
    in_shape, x = gap_of_initial_shape(pairing), pairing.position
    return in_shape + np.interp(x, x[reached], (missing_shape - in_shape)[reached])


def _kept_points(system: System, state: InterfaceState, renewed: dict[int, NewFace]) -> Rule | None:
    """Contact points to keep on the facets of body 1; None in a section.

    Pointwise contact keeps them in a section, too: beside the edge of the wear no interpolation of
    the gap is accurate enough for contact at other points.
    """
    on_surface = isinstance(system.pairing.sides[0].face, Surface)
    pointwise = state.pointwise is not None and not renewed
    return system.pairing.pieces if on_surface or pointwise else None


def _followed(
    system: System,
    worn: WornGeometry,
    faces: dict[int, WornFace],
    offsets: dict[int, np.ndarray],
    volumes: np.ndarray,
) -> tuple[TaggedMesh, np.ndarray]:
    """Moved mesh, and volumes lost (2,). Every rank calls.

    Displacements of the faces are scaled slightly so that the meshes lose the worn volumes: the
    volume of a curved layer is not exactly its area times its depth.
    """

    def outlined() -> tuple[np.ndarray, np.ndarray]:
        lost, moved = np.zeros(2), np.zeros_like(worn.mesh.points)
        for index, face in faces.items():
            body, part = movable_body(system, worn.mesh, index), 1.0
            for _ in range(_ITERATIONS):
                outline = body.outlined(part * face.displacement(offsets[index]))
                lost[index] = body.lost(outline, system.elastic.kinematics.area_factor)
                if abs(lost[index] - volumes[index]) <= _TOLERANCE * abs(volumes[index]):
                    break
                part *= volumes[index] / lost[index]
            moved += outline
        return moved, lost

    moved, lost = on_root(system.comm, outlined)
    return replace(worn.mesh, points=worn.mesh.points + extended(system.bodies, moved)), lost


def _remeshed(
    system: System, worn: WornGeometry, mesh: TaggedMesh, bodies: list[int]
) -> tuple[TaggedMesh, float, dict[int, NewFace]]:
    """Mesh with distorted bodies of a section remeshed, its quality, and the new faces.

    The quality is the smallest scaled Jacobian.
    """
    renewed: dict[int, NewFace] = {}
    moved = mesh
    for index in bodies:
        parts, face = system.model.bodies[index].parts, system.pairing.sides[index].face
        if isinstance(face, Surface):
            continue
        places = moved.points[nodes_at(worn.mesh, parts, nodes_of(face))]
        nodes = nodes_at(mesh, parts, places)  # remeshing of another body renumbers them
        wanted = worn.sizes[index], system.elastic.kinematics.area_factor, worn.best[index]
        mesh, new = improved(mesh, parts, nodes, *wanted)
        renewed |= {} if new is None else {index: new}
    return mesh, float(scaled_jacobians(mesh).min()), renewed


def _carried_rise(before: System, after: System, rise: np.ndarray) -> tuple[np.ndarray, float]:
    """Temperature rise of the bodies transferred to the moved mesh [K], and its error."""
    assert before.thermal is not None
    assert after.thermal is not None
    return transferred(
        rise,
        before.thermal.conduction.spaces,
        after.thermal.conduction.spaces,
        before.bodies,
        after.bodies,
    )

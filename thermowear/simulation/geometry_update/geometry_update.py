"""Geometry update: mesh motion to the worn faces and transfer of the state."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...balances import relative, require
from ...bulk.mesh_motion import extended
from ...contact.search.refinement import Rule
from ...errors import CaseError, ComputationError
from ...geometry.mesh.mixed import AnyMesh, MixedMesh, block_of, placed, rows_of
from ...geometry.mesh.tagged import TaggedMesh
from ...geometry.moving.new_face import NewFace
from ...parallel import on_root
from ...serialise import serialisable
from ..interface.interface_problem import InterfaceProblem, interface_problem
from ..interface.sdirk import InterfaceState, advance_with_error
from ..points.worn_geometry import WornContact, WornGeometry, along
from ..system.building import build
from ..system.setup_cache import SetupCache
from ..system.system import System
from .carrying import (
    carried_growth,
    carried_rise,
    carried_wear,
    change_by_update,
    with_carried_fluxes,
    with_volumes,
)
from .moving_faces import (
    FaceKey,
    MovingFaces,
    gap_of_initial_shape,
    movable_body,
    parts_behind,
    worst_cell,
)
from .remesh import (
    FLOOR,
    Kept,
    Renewed,
    carrying_error,
    on_kept_faces,
    on_new_faces,
    redivided,
    refilled,
)

serialisable(WornGeometry)
serialisable(WornContact)
serialisable(TaggedMesh)
serialisable(MixedMesh)
serialisable(NewFace)
serialisable(Rule)

_TOLERANCE = 1e-10
"""Relative tolerance of the volume removed by the mesh motion."""
_ITERATIONS = 20
_SLENDER = 0.5
"""Smallest acceptable scaled Jacobian, as a fraction of that of the first mesh if it is slender."""


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
    rows, corrected = carried_wear(system, following, state.worn)
    error = max(corrected, carrying_error(worn, following.contacts)) if renewed else 0.0
    worn = replace(worn, carrying_error=max(worn.carrying_error, error))
    after, rise = interface_problem(following), None
    if state.stored is not None:
        with system.phases("carry temperatures over"):
            rise, error = carried_rise(system, following, state.stored.rise)
        largest = max(state.stored.largest, 1e-300)
        worn = replace(worn, heat_error=max(worn.heat_error, error / largest))
    with system.phases("contact"):
        found = after.take_over(problem, state, rows, rise, time)
    found = with_carried_fluxes(following, state, found)
    change = change_by_update(following, state, found)
    worn = replace(worn, change=max(worn.change, change))
    after.system = replace(following, worn=worn)  # with the errors of this update
    return after, found, change


def settled(
    former: InterfaceProblem,
    problem: InterfaceProblem,
    before: InterfaceState,
    last: InterfaceState,
    after: InterfaceState,
    time: float,
    step: float,
    tolerance: float,
) -> InterfaceState:
    """State after a final update that has not disturbed the pressure. Every rank calls.

    A disturbance is worn off by repeating the last step on the new meshes, with the same volumes;
    not for transient temperatures, which are known at the end of the step only.

    Parameters
    ----------
    former, problem : InterfaceProblem
        Problems on the former and on the new meshes.
    before, last, after : InterfaceState
        States before and after the last step, and after the update.
    time, step : float
        Start and size of this step [s].
    tolerance : float
        Largest disturbance, relative to the largest pressure.
    """
    worn, contacts = problem.system.worn, problem.system.contacts
    assert worn is not None
    expected = worn.carried(last.pressure, contacts)
    disturbed = float(np.abs(after.pressure - expected).max())
    if after.stored is not None or disturbed <= tolerance * float(expected.max()):
        return after
    grown = carried_growth(former.system, problem.system, last.worn - before.worn)
    start = replace(after, worn=after.worn - grown, removed=before.removed)
    state = advance_with_error(problem, start, time, step).state
    again = with_volumes(problem.system, grown, problem.system, state.worn - start.worn)
    return replace(state, worn=start.worn + again, removed=after.removed)


def _moved(
    system: System, moving: MovingFaces, depth: np.ndarray, state: InterfaceState
) -> tuple[WornGeometry, bool]:
    """Geometry with the meshes moved by depths (2, n), and True if a body has been remeshed."""
    before, weights = moving.geometry, system.weights
    offsets = {key: face.offsets(depth[moving.rows[key]]) for key, face in moving.faces.items()}
    volumes = {key: depth[own] @ weights[own[1]] for key, own in moving.rows.items()}
    mesh, lost = _followed(system, before, moving, offsets, volumes)
    mesh, quality, renewed, kept = on_root(
        system.comm, lambda: _remeshed(system, before, mesh, moving)
    )
    least = _least_quality(system, before)
    if not quality >= least:  # NaN for degenerate cells
        raise ComputationError(
            f"geometry update: cells of the worn bodies become too slanted (scaled Jacobian "
            f"{quality:.2g}, at least {least:.2g}); use fewer or more even elements along the "
            "contact and the sides beside it (mesh.elements, mesh.grading, or the mesh file), or "
            'wear.update = "never"'
        )
    taken, missing = np.zeros_like(depth), 0.0
    for key, face in moving.faces.items():
        side, own = moving.rows[key]
        taken[side, own] = face.depths(offsets[key])
        missing = max(missing, abs(float(lost[key] - taken[side, own] @ weights[own])))
    total = before.lost + lost
    error = max(before.volume_error, relative(missing, float(np.abs(total).max())))
    require(geometry_volume_error=error)
    shape = _missing_shape(system, before, state)
    pieces = _kept_points(system, state, renewed)
    contacts = [
        replace(
            contact,
            pieces=None if pieces is None else pieces[index],
            renewed={},
            at=along(pairing),
            depth=(system.moved + taken)[:, own],
            missing_shape=shape[own],
            lost=total[index],
        )
        for index, (contact, (pairing, own)) in enumerate(
            zip(before.contacts, system.contacts, strict=True)
        )
    ]
    worn = replace(
        before,
        mesh=mesh,
        contacts=tuple(contacts),
        motions=_motions(system, state),
        updates=before.updates + 1,
        quality=min(before.quality, quality),
        volume_error=error,
    )
    if kept:
        worn = on_kept_faces(worn, system, kept)
    return on_new_faces(worn, system, renewed) if renewed else worn, bool(renewed or kept)


def _motions(system: System, state: InterfaceState) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
    """Translation and rotation of each body by its holder [m, rad]."""
    found = [(np.zeros(3), np.zeros(3))] * len(system.model.bodies)
    motions = system.motions(state.contact.motion)
    for holder, motion in zip(system.model.holders, motions, strict=True):
        for body in holder.bodies:
            found[body] = motion.translation, motion.rotation
    return tuple(found)


def _least_quality(system: System, worn: WornGeometry) -> float:
    """Smallest acceptable scaled Jacobian; less for slender cells in space, never remeshed."""
    return min(FLOOR, _SLENDER * float(worn.best.min())) if system.contacts.in_space else FLOOR


def _missing_shape(system: System, before: WornGeometry, state: InterfaceState) -> np.ndarray:
    """Gap of the initial shape minus that of the unworn faces at the points, shape (n,) [m].

    The first update replaces gaps along the normals of the unworn faces, which deviate from the
    paths of the nodes of curved faces, by gaps between the actual faces. The difference is left out
    of the gap where wear has closed it; ahead of each edge of the wear only its deviation from the
    value at the edge counts.
    """
    found = []
    for contact, (pairing, own) in zip(before.contacts, system.contacts, strict=True):
        missing = contact.carried(contact.missing_shape, pairing)
        reached = np.any(state.worn[:, own] > 0.0, axis=0)
        if not contact.is_moved and not system.contacts.in_space and reached.any():
            in_shape, x = gap_of_initial_shape(pairing), pairing.carrying.position
            missing = in_shape + np.interp(x, x[reached], (missing - in_shape)[reached])
        found.append(missing)
    return np.concatenate(found)


def _kept_points(system: System, state: InterfaceState, renewed: Renewed) -> list[Rule] | None:
    """Contact points to keep on the carrying facets; None in a remeshed section."""
    if renewed and not system.contacts.in_space:
        return None
    return [pairing.pieces for pairing in system.contacts.each]


def _followed(
    system: System,
    worn: WornGeometry,
    moving: MovingFaces,
    offsets: dict[FaceKey, np.ndarray],
    volumes: dict[FaceKey, float],
) -> tuple[AnyMesh, np.ndarray]:
    """Moved mesh, and volumes lost at the faces (n_interfaces, 2). Every rank calls.

    One face after the other. Displacements are scaled slightly so that the meshes lose the worn
    volumes: the volume of a curved layer is not exactly its area times its depth.
    """

    def outlined() -> tuple[np.ndarray, np.ndarray]:
        lost, moved = np.zeros((len(worn.contacts), 2)), np.zeros_like(worn.mesh.points)
        for key, face in moving.faces.items():
            mesh, part = placed(worn.mesh, worn.mesh.points + moved), 1.0
            body = movable_body(system, mesh, key)
            own = rows_of(mesh, block_of(mesh, *parts_behind(system, key)))
            for _ in range(_ITERATIONS):
                outline = body.outlined(part * face.displacement(offsets[key]))
                lost[key] = body.lost(outline, system.elastic.kinematics.area_factor)
                if abs(lost[key] - volumes[key]) <= _TOLERANCE * abs(volumes[key]):
                    break
                part *= volumes[key] / lost[key]
            moved[own] += outline
        return moved, lost

    moved, lost = on_root(system.comm, outlined)
    return placed(worn.mesh, worn.mesh.points + extended(system.bodies, moved)), lost


def _remeshed(
    system: System, worn: WornGeometry, mesh: AnyMesh, moving: MovingFaces
) -> tuple[AnyMesh, float, Renewed, Kept]:
    """Mesh with distorted bodies remeshed, its quality, and the contact faces of these bodies.

    The quality is the smallest scaled Jacobian.
    """
    renewed: Renewed = {}
    kept: Kept = {}
    if system.contacts.in_space:
        mesh, kept = refilled(system, worn, mesh, moving)
    else:
        mesh, renewed = redivided(system, worn, mesh, moving)
    return mesh, worst_cell(mesh), renewed, kept

"""An update of the geometry: meshes moved to their worn faces, and everything carried over."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..bulk.kinematics import section_model
from ..bulk.transfer import transferred
from ..contact.worn_face import WornFace
from ..errors import ComputationError
from ..geometry.shapes import scaled_jacobians
from ..laws.motions import combined
from ..parallel import on_root
from .interface_problem import InterfaceProblem
from .kept_wear import KeptWear, movable_body
from .parts import Parts
from .preparation import interface_problem
from .system import System, build
from .wear_step import WornContact
from .worn_geometry import WornGeometry, along, carried

_FLOOR = 0.1
"""Scaled Jacobian below which cells are no good any more."""
_SETTLED = 1e-10
"""Of a volume."""
_PASSES = 20


@dataclass(frozen=True)
class Updated:
    """What goes on after an update.

    Attributes
    ----------
    system : System
    problem : InterfaceProblem
    state : WornContact
    change : float
        Of pressure and temperatures by the update, relative to their means.
    """

    system: System
    problem: InterfaceProblem
    state: WornContact
    change: float


def updated(
    system: System, problem: InterfaceProblem, kept: KeptWear, state: WornContact, time: float
) -> Updated:
    """Move the meshes of a system by the wear that it keeps in the gap. Every rank calls.

    Raises
    ------
    ComputationError
        If cells would become too thin or too slanted.
    """
    with system.phases("move meshes"):
        worn = _moved(system, kept, state)
    following = build(system.case, system.comm, system.phases, system.inputs.zone, Parts(), worn)
    rows = carried(state.worn, along(system.pairing), along(following.pairing))
    after = interface_problem(following)
    rise = None
    if state.stored is not None:
        with system.phases("carry temperatures over"):
            rise, error = _carried_rise(system, following, state.stored.rise)
        largest = max(state.stored.largest, 1e-300)
        worn = replace(worn, heat_error=max(worn.heat_error, error / largest))
    with system.phases("contact"):
        found = after.take_over(problem, state, rows, rise, time)
    change = _change(system, following, state, found)
    worn = replace(worn, change=max(worn.change, change))
    return Updated(replace(following, worn=worn), after, found, change)


def _change(before: System, after: System, state: WornContact, found: WornContact) -> float:
    """How much an update has changed the pressure and, relative to their rise, temperatures.

    In the mean over the area.
    """
    fields = [(state.pressure, found.pressure)]
    if state.faces is not None and found.faces is not None:
        fields += zip(state.faces.rise, found.faces.rise, strict=True)
    places = along(before.pairing), along(after.pairing)
    changes = [0.0]
    for old, new in fields:
        expected = carried(old, *places)
        scale = float(after.weights @ np.abs(expected))
        if scale > 0.0:
            changes.append(float(after.weights @ np.abs(new - expected)) / scale)
    return max(changes)


def _moved(system: System, kept: KeptWear, state: WornContact) -> WornGeometry:
    """Where the nodes go."""
    before, faces, depth = kept.geometry, kept.faces, kept.depth(state.worn)
    amounts = {index: face.amounts(depth[index]) for index, face in faces.items()}
    points, lost, quality = on_root(
        system.comm,
        lambda: _points(system, before.points, faces, amounts, depth @ system.weights),
    )
    if not quality >= _FLOOR:  # not a number where cells have vanished
        raise ComputationError(
            f"geometry update: cells of the worn bodies become too slanted (scaled Jacobian "
            f"{quality:.2g}, at least {_FLOOR:g}); use fewer or more even elements along the "
            'contact (mesh.elements, mesh.grading), or wear.update = "never"'
        )
    taken = np.zeros_like(depth)
    for index, face in faces.items():
        taken[index] = face.depths(amounts[index])
    motion = combined(system.holder.motions, state.contact.motion)
    due = np.array([taken[index] @ system.weights for index in faces])
    errors = np.abs(lost[list(faces)] - due) / np.abs(due).max()
    return replace(
        before,
        points=points,
        at=along(system.pairing),
        depth=system.moved + taken,
        lacking=before.carried(before.lacking, system.pairing),
        holder=(motion.translation, motion.rotation),
        lost=before.lost + lost,
        updates=before.updates + 1,
        quality=min(before.quality, quality),
        volume_error=max(before.volume_error, float(errors.max())),
    )


def _points(
    system: System,
    points: np.ndarray,
    faces: dict[int, WornFace],
    amounts: dict[int, np.ndarray],
    volumes: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, float]:
    """Nodes of the mesh after its faces have moved, volumes lost (2,), and its worst cell.

    Faces go a little further or less far than the depth worn off them, so that the meshes lose
    the worn volumes: that of a curved layer is not quite its area times its depth.
    """
    case = system.case
    mesh = replace(case.tagged_mesh(system.inputs.zone), points=points)
    factor = section_model(
        case.model, case.geometry.thickness_factor, case.geometry.sector
    ).area_factor
    lost = np.zeros(2)
    for index, face in faces.items():
        body, part = movable_body(system, mesh, index), 1.0
        for _ in range(_PASSES):
            outlined = body.outlined(part * face.displacement(amounts[index]))
            lost[index] = body.lost(outlined, factor)
            if abs(lost[index] - volumes[index]) <= _SETTLED * abs(volumes[index]):
                break
            part *= volumes[index] / lost[index]
        mesh = replace(mesh, points=body.followed(outlined))
    return mesh.points, lost, float(scaled_jacobians(mesh).min())


def _carried_rise(before: System, after: System, rise: np.ndarray) -> tuple[np.ndarray, float]:
    """The temperatures of the bodies at the nodes of the moved mesh [K], and their error."""
    assert before.thermal is not None
    assert after.thermal is not None
    geometry = before.case.geometry
    return transferred(
        rise,
        before.thermal.conduction.space,
        after.thermal.conduction.space,
        before.bodies,
        after.bodies,
        [geometry.parts_of(body) for body in geometry.bodies],
    )

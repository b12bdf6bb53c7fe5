"""Static analyses: contact of the unworn faces, steady state, and the design of a face."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from ...contact.faces.face import Face, Surface
from ...errors import ComputationError
from ...geometry.cad.design import Design
from ...results import Result
from ...results.short_names import by_name
from ..interface.body_state import body_state
from ..interface.interface_problem import InterfaceProblem, interface_problem
from ..interface.steady import steady_state
from ..results.recording import Snapshot, along_load, record, snapshot_at
from ..results.summary import conclude
from ..runtime.observer import Observer
from ..system.system import System

_VELOCITIES = {
    "z": "rigid_wear_velocity_m_per_s",
    "x": "rigid_wear_velocity_x_m_per_s",
    "y": "rigid_wear_velocity_y_m_per_s",
    "rotation": "rigid_wear_rotation_rad_per_s",
    "rotation-x": "rigid_wear_rotation_x_rad_per_s",
    "rotation-y": "rigid_wear_rotation_y_rad_per_s",
}


def initial(system: System, observer: Observer) -> tuple[Snapshot, Result]:
    """Contact of the unworn faces."""
    return unworn(interface_problem(system, observer.note))


def unworn(problem: InterfaceProblem) -> tuple[Snapshot, Result]:
    """Contact of the unworn faces, from a given interface problem."""
    phases = problem.system.phases
    with phases("contact"):
        found = problem.unworn()
    with phases("bodies"):
        return conclude(snapshot_at(problem, found, 0.0), {"steps": 0})


def steady(system: System, observer: Observer) -> tuple[Snapshot, Result]:
    """Steady state of wear, with faces worn to conformity."""
    with system.phases("steady principle"):
        found = steady_state(system)
    with system.phases("bodies"):
        contact = found.contact
        state = body_state(system, contact)
    wear = found.wear
    pressing = contact.pressure > 0
    _require_positions(system, pressing)
    opening = state.opening + system.softness * contact.pressure
    position = found.position(system, opening)
    height = system.holder.modes @ position - opening
    shape = np.full(len(height), np.nan)  # unknown where wear has unloaded the contact
    for own in system.contacts.ranges:
        shape[own] = np.fmax.reduce(np.where(pressing, height, np.nan)[own]) - height[own]
    gap, at_rest = np.where(pressing, 0.0, np.nan), system.at_rest
    shape[at_rest] = 0.0
    gap[at_rest] = (system.contacts.gap - system.holder.imposed - height)[at_rest]
    end = record(
        system,
        contact,
        system.motions(system.holder.amplitudes(position)),
        state,
        gap=gap,
        shape=shape,
        worn=np.zeros((2, len(shape))),
    )
    extra = {
        "steps": 0,
        **wear_velocity(system, wear.velocity),
        "wear_dissipation_W": wear.dissipation,
    }
    return conclude(replace(end, wear_velocity=wear.velocity), extra)


def _require_positions(system: System, pressing: np.ndarray) -> None:
    """Reject holders whose free motions close the gap at no point that presses (n,).

    Raises
    ------
    ComputationError
    """
    idle = ~np.any(system.holder.modes[pressing] != 0.0, axis=0)
    if idle.any():
        names = np.array([f"{h.name} ({name})" for h in system.model.holders for name in h.free])
        raise ComputationError(
            f"no steady position of the holders {', '.join(names[system.holder.free][idle])}: "
            "their contacts carry nothing; give them a force, or fix them (free = [])"
        )


def wear_velocity(system: System, velocity: np.ndarray | None) -> dict[str, Any]:
    """Rigid-body wear velocities of the free modes of the holders, by summary key [m/s, rad/s]."""
    found: dict[str, Any] = {}
    amounts = np.zeros(len(system.holder.rigid_modes))  # those of given motions
    if velocity is not None:
        amounts[system.holder.free] = velocity
    for holder, modes in zip(system.model.holders, system.modes_of_holders, strict=True):
        own: dict[str, float | None] = {_VELOCITIES["z"]: None}
        found[holder.name] = own
        if velocity is not None:
            pairs = zip(holder.free, amounts[modes], strict=True)
            own |= {_VELOCITIES[name]: float(value) for name, value in pairs}
    return by_name("holders", found)


_SAME = 1e-9  # relative to the size of the face: closer points coincide


def steady_design(system: System, number: int, side: int) -> Design:
    """Unloaded, unheated shape of a face that carries the steady pressure from the start.

    Only the gap counts: one face takes the whole shape, worn or not, the other one keeps its drawn
    shape. Least material removal: ``W = R d - B u - g0``, nowhere negative, where ``R d`` are
    motions of the holders, common to all contacts.

    Parameters
    ----------
    system : System
    number : int
        Number of the interface.
    side : int
        Face of the interface that takes the shape: 0 or 1.

    Raises
    ------
    ComputationError
        If there is no steady state.
    """
    found = steady_state(system)
    state = body_state(system, found.contact)
    state.require_balance()
    pressure, gap = found.contact.pressure, system.contacts.gap
    open_by = state.opening + system.softness * pressure + gap
    position = found.position(system, open_by)
    depth = np.maximum(system.holder.modes @ position - open_by, 0.0)
    own, pairing = system.contacts.ranges[number], system.contacts.each[number]
    if not np.any(pressure[own] > 0):
        table = system.model.interfaces[number].table
        raise ComputationError(f"{table}: carries nothing in the steady state, so no shape follows")
    depth, height, along = depth[own], gap[own] + depth[own], along_load(system)[own]
    at = pairing.sides[side]
    height_along = height / along
    design = Design(
        body=side + 1,
        points=at.points,
        s=at.position,
        normals=at.face.normals(at.facet, at.t),
        shape=height.max() - height,
        shape_along_press=np.nanmax(height_along) - height_along,
        depth=depth,
    )
    return (
        _from_end_to_end(design, at.face) if isinstance(at.face, Face) else _single(design, at.face)
    )


def _single(design: Design, face: Surface) -> Design:
    """Design with one of the coincident points at a border of materials."""
    pairs = cKDTree(design.points).query_pairs(_SAME * face.extent, output_type="ndarray")
    rows = np.setdiff1d(np.arange(len(design.points)), pairs[:, 1])
    columns = "points", "s", "normals", "shape", "shape_along_press", "depth"
    return replace(design, **{name: getattr(design, name)[rows] for name in columns})


def _from_end_to_end(design: Design, face: Face) -> Design:
    """Design ordered along the whole plane face, constant beyond the edges of the contact."""
    same = _SAME * face.extent
    order = face.nodes.shape[1] - 1
    facet, t = np.divmod(np.arange(len(face.nodes) * order + 1), order)
    facet[-1], t[-1] = facet[-1] - 1, order
    nodes = face.position(facet, t / order)
    beyond = (nodes < design.s.min() - same) | (nodes > design.s.max() + same)
    facet, t, nodes = facet[beyond], t[beyond] / order, nodes[beyond]
    edge = np.where(nodes < design.s.min(), design.s.argmin(), design.s.argmax())
    s = np.concatenate([design.s, nodes])
    rows = np.argsort(s, kind="stable")
    rows = rows[np.diff(s[rows], prepend=-np.inf) > same]
    whole = np.concatenate([np.arange(len(design.s)), edge])[rows]
    return Design(
        body=design.body,
        points=np.concatenate([design.points, face.points(facet, t)])[rows],
        s=s[rows],
        normals=np.concatenate([design.normals, face.normals(facet, t)])[rows],
        shape=design.shape[whole],
        shape_along_press=design.shape_along_press[whole],
        depth=design.depth[whole],
    )

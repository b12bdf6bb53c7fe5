"""Design of a contact face: its steady worn shape."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from ...contact.faces.face import Face, Surface
from ...errors import ComputationError
from ...geometry.cad.design import Design
from ..interface.body_state import body_state
from ..interface.steady import steady_state
from ..results.recording import along_load
from ..system.system import System

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

"""Design of a contact face: its steady worn shape."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from ...contact.search.face import Face, Surface
from ...geometry.cad.design import Design
from ...laws.principle.least_worn import least_worn
from ..interface.body_state import body_state
from ..interface.steady import steady_state
from ..results.recording import along_load
from ..system.system import System

_SAME = 1e-9  # relative to the size of the face: closer points coincide


def steady_design(system: System, body: int) -> Design:
    """Unloaded, unheated shape of a face that carries the steady pressure from the start.

    Only the gap counts: one face takes the whole shape, worn or not, the other one keeps its drawn
    shape. Least material removal: ``W = R d - B u - g0``, nowhere negative, where ``R d`` is a
    motion of the holder.

    Parameters
    ----------
    system : System
    body : int
        Body whose face takes the shape: 1 or 2.

    Raises
    ------
    ComputationError
        If there is no steady state.
    """
    found = steady_state(system)
    state, pairing = body_state(system, found.contact), system.pairing
    state.require_balance()
    pressure = found.wear.pressure
    open_by = state.opening + system.softness * pressure + pairing.gap
    modes = system.holder.modes
    position = least_worn(modes, open_by, system.weights, pressure > 0)
    depth = np.maximum(modes @ position - open_by, 0.0)
    side = pairing.sides[body - 1]
    points, normals = side.face.points(side.facet, side.t), pairing.normals
    s = pairing.position
    if body == 2:
        normals = side.face.normals(side.facet, side.t)
        s = side.position
    height = pairing.gap + depth
    height_along = height / along_load(system)
    design = Design(
        body=body,
        points=points,
        s=s,
        normals=normals,
        shape=height.max() - height,
        shape_along_press=np.nanmax(height_along) - height_along,
        depth=depth,
    )
    face = side.face
    return _from_end_to_end(design, face) if isinstance(face, Face) else _single(design, face)


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

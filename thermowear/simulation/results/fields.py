"""Sampling of the fields of the bodies on a fine grid in every cell, gathered on rank 0."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
import ufl
from dolfinx import fem
from numpy.lib.stride_tricks import sliding_window_view

from ...bulk.field import as_function
from ...bulk.heat.varying import straining_rise
from ...compat import evaluate
from ...laws.motions import RigidMotion
from ...results import BodyFields
from ..system.system import System
from .recording import Snapshot

_INSET = 1e-6  # keeps samples off the axis, where u_r / r is 0/0


def sample(snapshot: Snapshot) -> BodyFields | None:
    """Sample displacement (holder's motion included), temperature and von Mises stress.

    Body 1 is drawn at its position of the last mesh motion to the worn face: a body shortened by
    wear stays in contact with the other one.

    Every rank calls; ranks other than 0 return None. Cells are in the order of the mesh file.
    """
    system, state, motion = snapshot.system, snapshot.bodies, snapshot.motion
    mesh, elastic = system.bodies.mesh, system.elastic
    n = max(system.model.discretisation.degree, 2)
    grid, pieces = _GRIDS[mesh.topology.cell_name()](n)
    centre = grid.mean(axis=0)
    inside = centre + (grid - centre) * (1 - _INSET)
    cells = np.arange(mesh.topology.index_map(mesh.topology.dim).size_local, dtype=np.int32)
    u = as_function(elastic.space, with_holder(system, state.displacement, motion), "u")
    du = as_function(elastic.space, state.displacement, "u")
    rise, straining, heated, thermal = None, None, state.temperatures, system.thermal
    if heated is not None and thermal is not None:
        space = thermal.conduction.space
        rise = as_function(space, heated.rise, "rise")
        straining = straining_rise(space, heated.rise, system.bodies, thermal.expansions)
    σ = elastic.stress(du, straining)
    wanted = [u, _von_mises(σ)] + ([] if rise is None else [rise])
    values = [evaluate(fem.Expression(ufl.SpatialCoordinate(mesh), grid), mesh, cells)]
    values += [evaluate(fem.Expression(w, inside), mesh, cells) for w in wanted]
    body = np.zeros(len(cells), dtype=np.int64)
    tags = system.bodies.cell_tags
    local = tags.indices < len(cells)
    body[tags.indices[local]] = _body_of_tag(system)[tags.values[local]]
    original = mesh.topology.original_cell_index[: len(cells)]
    parts = mesh.comm.gather((original, body, *values), root=0)
    if parts is None:
        return None
    order = np.argsort(np.concatenate([part[0] for part in parts]))
    body, points, displacement, mises, *temperature = (
        np.concatenate([part[k] for part in parts])[order] for k in range(1, len(parts[0]))
    )
    if system.worn is not None:
        placed = RigidMotion(*system.worn.holder, np.zeros(3)).at(points[body == 1])
        points[body == 1] += placed
        displacement[body == 1] -= placed
    absolute = None if thermal is None else temperature[0][..., 0] + thermal.ambient
    return BodyFields(points, pieces, body, displacement, absolute, mises[..., 0])


def _body_of_tag(system: System) -> np.ndarray:
    """Number of the body (from 1) by cell tag, including the tags of its zones; 0 for tag 0."""
    bodies = enumerate(system.model.bodies, start=1)
    numbers = {part: number for number, body in bodies for part in body.parts}
    return np.array([0, *(numbers[part] for part in system.bodies.names)])


def with_holder(system: System, displacement: np.ndarray, motion: RigidMotion) -> np.ndarray:
    """Add the rigid motion of the holder to the nodes of body 1."""
    upper = system.elastic.owned_by(*system.model.bodies[0].parts)
    nodes = system.elastic.nodes()
    moved = displacement.reshape(nodes.shape).copy()
    moved[upper] += motion.at(nodes[upper])
    return moved.ravel()


def _von_mises(σ):
    s = σ - ufl.tr(σ) / 3 * ufl.Identity(3)
    return ufl.sqrt(1.5 * ufl.inner(s, s))


def _grid(n: int, dim: int) -> tuple[np.ndarray, np.ndarray]:
    """Points of an (n + 1)ᵈ grid on the unit cell, and the corners of its small cells."""
    axes = np.meshgrid(*[np.linspace(0.0, 1.0, n + 1)] * dim, indexing="ij")
    points = np.column_stack([axis.ravel() for axis in axes[::-1]])
    numbers = np.arange(len(points)).reshape(axes[0].shape)
    return points, sliding_window_view(numbers, (2,) * dim).reshape(-1, 2**dim)


def _box(n: int, dim: int) -> tuple[np.ndarray, np.ndarray]:
    """Points of a grid on a reference cell, and its small cells in the order of VTK."""
    points, corners = _grid(n, dim)
    return points, corners[:, [0, 1, 3, 2, 4, 5, 7, 6][: 2**dim]]


def _triangle(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Points of a regular grid on the reference triangle, and its small triangles."""
    points, corners = _grid(n, 2)
    inside = points.sum(axis=1) < 1 + 0.5 / n
    halves = np.vstack([corners[:, [0, 1, 2]], corners[:, [1, 3, 2]]])
    return points[inside], (np.cumsum(inside) - 1)[halves[inside[halves].all(axis=1)]]


_GRIDS: dict[str, Callable[[int], tuple[np.ndarray, np.ndarray]]] = {
    "quadrilateral": partial(_box, dim=2),
    "triangle": _triangle,
    "hexahedron": partial(_box, dim=3),
}

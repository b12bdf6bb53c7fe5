"""Records of interface and bodies at a contact state for the results.

Fields of the bodies are sampled on a fine grid in every cell and gathered on rank 0.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import permutations

import numpy as np
import ufl
from dolfinx import fem
from numpy.lib.stride_tricks import sliding_window_view

from ...bulk.field import as_function
from ...bulk.heat.varying import straining_rise
from ...compat import evaluate
from ...contact.wear.implicit_step import WearRates
from ...laws.motions import RigidMotion, combined
from ...results import BodyFields, FrictionInterface, InterfaceFields, Profile, WornTrack
from ..interface.body_state import BodyState, ContactState, body_state
from ..interface.interface_problem import InterfaceProblem
from ..interface.sdirk import InterfaceState
from ..system.system import System

_INSET = 1e-6  # keeps samples off the axis, where u_r / r is 0/0
_LEAST_COSINE = 0.05
"""Least cosine between face normal and load direction for a shape along the load direction."""


@dataclass(frozen=True)
class Snapshot:
    """Contact, bodies and interface on one rank, in one state of an analysis.

    Attributes
    ----------
    system : System
        System in this state, whose meshes may have been moved.
    contact : ContactState
    motion : RigidMotion
        Rigid motion of the holder.
    bodies : BodyState
    interface : InterfaceFields
    friction : FrictionInterface or None
        Stick-slip state of a fretting analysis.
    track : WornTrack or None
        Worn track of a reciprocating analysis.
    """

    system: System
    contact: ContactState
    motion: RigidMotion
    bodies: BodyState
    interface: InterfaceFields
    friction: FrictionInterface | None = None
    track: WornTrack | None = None


def snapshot(
    system: System,
    contact: ContactState,
    motion: RigidMotion,
    worn: np.ndarray,
    rates: np.ndarray | None = None,
) -> Snapshot:
    """Solve the bodies and record the interface. Every rank calls.

    Parameters
    ----------
    system : System
    contact : ContactState
    motion : RigidMotion
        Motion of the holder.
    worn : ndarray, shape (2, n)
        Wear depth of each body [m].
    rates : ndarray, shape (2, n), optional
        Wear rates, see `record` [m/s].
    """
    bodies = body_state(system, contact)
    open_by = system.pairing.gap + worn.sum(axis=0)
    moved = motion.at(system.pairing.on_body_1)
    gap = (
        open_by
        + system.softness * contact.pressure
        + bodies.opening
        - np.einsum("ni,ni->n", system.pairing.normals, moved)
    )
    shape = open_by.max() - open_by
    return record(system, contact, motion, bodies, gap, shape, worn, rates)


def snapshot_at(problem: InterfaceProblem, state: InterfaceState, time: float) -> Snapshot:
    """Contact and bodies in a state of an interface problem at a time [s]; every rank calls."""
    system, contact = problem.system, problem.contact_state(state, time)
    motion = combined(system.holder.motions, state.contact.motion)
    return snapshot(system, contact, motion, state.by_body(system.laws))


def record(
    system: System,
    contact: ContactState,
    motion: RigidMotion,
    bodies: BodyState,
    gap: np.ndarray,
    shape: np.ndarray,
    worn: np.ndarray,
    rates: np.ndarray | None = None,
) -> Snapshot:
    """Record the interface of solved bodies from arrays of shape (n,) and `worn` of shape (2, n).

    Wear rates of shape (2, n) are by default those of the pressure at the sliding speed.
    """
    pressure = contact.pressure
    points = system.pairing.on_body_1
    nothing = np.full(len(pressure), np.nan)
    rates = _local_rates(system, contact) if rates is None else rates
    temperatures: tuple[np.ndarray, np.ndarray] = (nothing, nothing)
    fluxes = temperatures
    if bodies.temperatures is not None and system.thermal is not None:
        T1, T2 = bodies.temperatures.faces.rise
        temperatures = (T1 + system.thermal.ambient, T2 + system.thermal.ambient)
        fluxes = bodies.temperatures.faces.flux
    interface = InterfaceFields(
        x=points[:, 0],
        y=points[:, 1],
        z=points[:, 2] if points.shape[1] == 3 else np.zeros(len(pressure)),
        s=system.pairing.position,
        weight=system.weights,
        pressure=pressure,
        gap=gap,
        shape=shape,
        wear_1=worn[0],
        wear_2=worn[1],
        wear_rate_1=rates[0],
        wear_rate_2=rates[1],
        temperature_1=temperatures[0],
        temperature_2=temperatures[1],
        heat_flux_1=fluxes[0],
        heat_flux_2=fluxes[1],
    )
    return Snapshot(system, contact, motion, bodies, interface)


def _local_rates(system: System, contact: ContactState) -> np.ndarray:
    at, rates = contact.conditions, np.zeros((2, len(contact.pressure)))
    laws, spreads = list(system.laws.values()), list(system.spreads.values())
    rates[list(system.laws)] = WearRates(laws, spreads, at.wear, at.states)(contact.pressure)
    return rates


def profile(end: Snapshot) -> Profile:
    """Worn shape of an interface, along its normals and along the load direction."""
    system, interface = end.system, end.interface
    normals = np.zeros((len(interface.s), 3))
    normals[:, : len(system.load_direction)] = system.pairing.normals
    along = along_load(system)
    open_by = system.pairing.gap + interface.wear_1 + interface.wear_2
    open_by = (interface.shape.max() - interface.shape + open_by.min()) / along
    rate = interface.wear_rate_1 + interface.wear_rate_2
    return Profile(
        x=interface.x,
        y=interface.y,
        z=interface.z,
        s=interface.s,
        normal_x=normals[:, 0],
        normal_y=normals[:, 1],
        normal_z=normals[:, 2],
        shape=interface.shape,
        shape_along_press=np.nanmax(open_by) - open_by,
        wear_rate=rate,
        wear_rate_along_press=rate / along,
    )


def along_load(system: System) -> np.ndarray:
    """Cosines between normals and load direction, shape (n,); NaN where the face is too steep."""
    along = system.pairing.normals @ system.load_direction
    return np.where(along > _LEAST_COSINE, along, np.nan)


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
    absolute = None
    if temperature and thermal is not None:
        absolute = temperature[0][..., 0] + thermal.ambient
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


def _tetrahedron(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Points of a regular grid on the reference tetrahedron, and its small tetrahedra.

    Boxes are divided along their diagonals (Kuhn), as is the tetrahedron ``x >= y >= z`` of them.
    """
    points, _ = _grid(n, 3)
    inside = np.all(np.diff(points, axis=1) <= 0.5 / n, axis=1)
    numbers = np.arange(len(points)).reshape((n + 1,) * 3).transpose()  # by x, y, z
    cells, boxes = [], np.moveaxis(np.indices((n,) * 3), 0, -1).reshape(-1, 1, 3)
    for axes in permutations(np.eye(3, dtype=int)):
        corners = np.cumsum([np.zeros(3, dtype=int), *axes], axis=0)
        cells.append(numbers[tuple(np.moveaxis(boxes + corners, -1, 0))])
    small = np.concatenate(cells)
    small = (np.cumsum(inside) - 1)[small[inside[small].all(axis=1)]]
    x, y, z = points[inside].T
    points = np.column_stack([x - y, y - z, z])
    edges = points[small[:, 1:]] - points[small[:, :1]]
    inverted = np.flatnonzero(np.linalg.det(edges) < 0)
    small[inverted, 1:3] = small[inverted, 2:0:-1]
    return points, small


_GRIDS: dict[str, Callable[[int], tuple[np.ndarray, np.ndarray]]] = {
    "quadrilateral": partial(_box, dim=2),
    "triangle": _triangle,
    "hexahedron": partial(_box, dim=3),
    "tetrahedron": _tetrahedron,
}

"""Records of interface and bodies at a contact state for the results.

Fields of the bodies are sampled on a fine grid in every cell and gathered on rank 0.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import permutations

import numpy as np
import ufl
from numpy.lib.stride_tricks import sliding_window_view

from ...bulk.bodies import Bodies, BodyMesh
from ...bulk.compiled import compiled_expression
from ...bulk.heat.varying import straining_rises
from ...compat import coordinate_element, evaluate, geometry_dofmap
from ...contact.full.full_system import resolved_pressure
from ...contact.wear.implicit_step import WearRates
from ...lagrange import equispaced, tabulated
from ...laws.motions import RigidMotion, spatial
from ...laws.principle.steady import least_worn
from ...results import (
    AnyFields,
    BodyFields,
    FrictionInterface,
    InterfaceFields,
    MixedFields,
    Profile,
    WornTrack,
)
from ..interface.body_state import BodyState, ContactState, body_state
from ..interface.interface_problem import InterfaceProblem
from ..interface.sdirk import InterfaceState
from ..system.rigid_modes import fluid_pressure
from ..system.system import System
from .coatings import coating_left

_SMOOTH, _DRAWN_CELLS = 6, 325_000
"""Number of parts of the side of a curved cell that looks smooth; parts of all cells up to which
cells are divided more finely than their fields need."""


def divisions(bodies: Bodies, least: int) -> int:
    """Number of parts of each side of a cell: more in space where few curved cells look angular."""
    meshes = [body.mesh for body in bodies.each]
    if bodies.dim < 3 or all(coordinate_element(mesh).degree == 1 for mesh in meshes):
        return least
    cells = sum(mesh.topology.index_map(3).size_global for mesh in meshes)
    fine = int((_DRAWN_CELLS / max(cells, 1)) ** (1 / 3))
    return max(least, min(fine, _SMOOTH))


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
    inside: np.ndarray = np.all(np.diff(points, axis=1) <= 0.5 / n, axis=1)
    numbers = np.arange(len(points)).reshape((n + 1,) * 3).transpose()  # by x, y, z
    cells = []
    for axes in permutations(np.eye(3, dtype=int)):
        corners = np.cumsum(np.array([np.zeros(3, dtype=int), *axes]), axis=0)
        boxes = np.moveaxis(np.indices((n,) * 3), 0, -1).reshape(-1, 1, 3) + corners
        cells.append(numbers[tuple(np.moveaxis(boxes, -1, 0))])
    small = np.concatenate(cells)
    small = (np.cumsum(inside) - 1)[small[inside[small].all(axis=1)]]
    x, y, z = points[inside].T
    points = np.column_stack([x - y, y - z, z])
    edges = points[small[:, 1:]] - points[small[:, :1]]
    reversed_ = np.linalg.det(edges) < 0
    small[reversed_, 1:3] = small[reversed_, 2:0:-1]
    return points, small


GRIDS: dict[str, Callable[[int], tuple[np.ndarray, np.ndarray]]] = {
    "quadrilateral": partial(_box, dim=2),
    "triangle": _triangle,
    "hexahedron": partial(_box, dim=3),
    "tetrahedron": _tetrahedron,
}


_INSET = 1e-6  # keeps samples off the axis, where u_r / r is 0/0
_LEAST_COSINE = 0.05
"""Least cosine between face normal and load direction for a shape along the load direction."""


@dataclass(frozen=True)
class Samples:
    """Fields on a grid in each owned cell of a body.

    Attributes
    ----------
    points : ndarray, shape (n_cells, n_points, gdim)
        Coordinates [m].
    stretch : ndarray, shape (n_cells, n_points)
        Volume per volume of the reference cell, in a section area [m³ or m²].
    pieces : ndarray of int
        Points of the small cells of the grid.
    fields : list of ndarray, shape (n_cells, n_points, components)
    """

    points: np.ndarray
    stretch: np.ndarray
    pieces: np.ndarray
    fields: list[np.ndarray]


@dataclass(frozen=True)
class Snapshot:
    """Contact, bodies and interface on one rank, in one state of an analysis.

    Attributes
    ----------
    system : System
        System in this state, whose meshes may have been moved.
    contact : ContactState
    motions : tuple of RigidMotion
        Rigid motion of each holder.
    bodies : BodyState
    interface : InterfaceFields
    friction : FrictionInterface or None
        Stick-slip state of a fretting analysis.
    track : WornTrack or None
        Worn track of a reciprocating analysis.
    removed : ndarray or None, shape (n_wearing, n_interfaces)
        Volumes worn off by the rates in time, see `InterfaceState` [m³].
    wear_velocity : ndarray or None, shape (k,)
        Rigid-body wear velocity of the free modes of the holders in a steady state [m/s, rad/s].
    """

    system: System
    contact: ContactState
    motions: tuple[RigidMotion, ...]
    bodies: BodyState
    interface: InterfaceFields
    friction: FrictionInterface | None = None
    track: WornTrack | None = None
    removed: np.ndarray | None = None
    wear_velocity: np.ndarray | None = None

    @property
    def displacement(self) -> np.ndarray:
        """Nodal displacement with the motions of the holders, shape (n_owned,) [m]."""
        system = self.system
        nodes = system.elastic.nodes()
        moved = self.bodies.displacement.reshape(nodes.shape).copy()
        for holder, motion in zip(system.model.holders, self.motions, strict=True):
            parts = [part for body in holder.bodies for part in system.model.bodies[body].parts]
            own = system.elastic.owned_by(*parts)
            moved[own] += motion.at(nodes[own])
        return moved.ravel()


def snapshot(
    system: System,
    contact: ContactState,
    motions: tuple[RigidMotion, ...],
    worn: np.ndarray,
    rates: np.ndarray | None = None,
) -> Snapshot:
    """Solve the bodies and record the interfaces. Every rank calls.

    Parameters
    ----------
    system : System
    contact : ContactState
    motions : tuple of RigidMotion
        Motion of each holder.
    worn : ndarray, shape (2, n)
        Wear depth of the first and of the second face of the interfaces [m].
    rates : ndarray, shape (2, n), optional
        Wear rates, see `record` [m/s].
    """
    bodies = body_state(system, contact)
    open_by = system.contacts.gap + worn.sum(axis=0)
    gap = open_by + system.softness * contact.pressure + bodies.opening - system.closed_by(motions)
    shape = _shape(system, open_by, contact.pressure > 0.0)
    return record(system, contact, motions, bodies, gap, shape, worn, rates)


def _shape(system: System, open_by: np.ndarray, pressing: np.ndarray) -> np.ndarray:
    """Height of the unloaded faces above their lowest points, shape (n,) [m].

    As in the steady state, the free motions of the holders are those at which the faces conform
    with the least wear: a drum worn to one side has the shape of one that was made for it.

    Parameters
    ----------
    system : System
    open_by : ndarray, shape (n,)
        Gap of the unloaded worn faces where they were drawn [m].
    pressing : ndarray of bool, shape (n,)
    """
    modes = system.holder.modes
    count = modes.shape[1] if pressing.any() else 0
    if count and np.linalg.matrix_rank(modes[pressing]) == count:
        open_by = open_by + modes @ least_worn(modes, -open_by, system.weights, pressing)
    return np.concatenate([open_by[own].max() - open_by[own] for own in system.contacts.ranges])


def snapshot_at(problem: InterfaceProblem, state: InterfaceState, time: float) -> Snapshot:
    """Contact and bodies in a state of an interface problem at a time [s]; every rank calls."""
    system, contact = problem.system, problem.contact_state(state, time)
    motions = system.motions(state.contact.motion)
    found = snapshot(system, contact, motions, state.by_body(system.laws))
    return replace(found, removed=state.removed)


def record(
    system: System,
    contact: ContactState,
    motions: tuple[RigidMotion, ...],
    bodies: BodyState,
    gap: np.ndarray,
    shape: np.ndarray,
    worn: np.ndarray,
    rates: np.ndarray | None = None,
) -> Snapshot:
    """Record the interfaces of solved bodies from arrays of shape (n,) and `worn` of shape (2, n).

    Wear rates of shape (2, n) are by default those of the pressure at the sliding speed.
    """
    pressure = contact.pressure
    if contact.shear is None:  # stick-slip bounds it by the pressure at each point
        pressure = comparable_pressure(system, pressure, worn)
    points = system.contacts.on_body_1
    nothing = np.full(len(pressure), np.nan)
    rates = _local_rates(system, contact) if rates is None else rates
    temperatures: tuple[np.ndarray, np.ndarray] = (nothing, nothing)
    fluxes = temperatures
    if bodies.temperatures is not None and system.thermal is not None:
        T1, T2 = bodies.temperatures.faces.rise
        temperatures = (T1 + system.thermal.ambient, T2 + system.thermal.ambient)
        fluxes = bodies.temperatures.faces.flux
    left = coating_left(system, worn)
    interface = InterfaceFields(
        x=points[:, 0],
        y=points[:, 1],
        z=points[:, 2] if points.shape[1] == 3 else np.zeros(len(pressure)),
        s=system.contacts.position,
        weight=system.weights,
        pressure=pressure,
        gap=gap,
        shape=shape,
        wear_1=worn[0],
        wear_2=worn[1],
        wear_rate_1=rates[0],
        wear_rate_2=rates[1],
        coating_left_1=left[0],
        coating_left_2=left[1],
        fluid_pressure=_fluid(system),
        temperature_1=temperatures[0],
        temperature_2=temperatures[1],
        heat_flux_1=fluxes[0],
        heat_flux_2=fluxes[1],
    )
    return Snapshot(system, contact, motions, bodies, interface)


def comparable_pressure(system: System, pressure: np.ndarray, worn: np.ndarray) -> np.ndarray:
    """Pressure of unworn contact in the pressure space, by whatever method, shape (n,) [Pa].

    With wear, which follows the pressure at each point, that of the method itself; likewise with a
    given penalty, whose penetration is the pressure over it.

    Parameters
    ----------
    system : System
    pressure : ndarray, shape (n,)
        That of the method [Pa].
    worn : ndarray, shape (..., n)
        Wear depths [m].
    """
    method = system.model.method
    own = method not in ("penalty", "nitsche") or system.model.interface.method.penalty is not None
    if own or worn.any() or not pressure.any():
        return pressure
    directions = system.traction_direction[:, ~system.cancelled(system.model.interface)]
    return resolved_pressure(system.basis, system.weights, pressure, directions)


def _fluid(system: System) -> np.ndarray:
    """Pressure of the fluid at the points, shape (n,); NaN in contacts without one [Pa]."""
    found = fluid_pressure(system.model, system.contacts)
    wet = [one.fluid_pressure is not None for one in system.model.interfaces]
    inside = system.contacts.per_point(wet) > 0
    return np.where(inside, np.nan if found is None else found, np.nan)


def _local_rates(system: System, contact: ContactState) -> np.ndarray:
    at, rates = contact.conditions, np.zeros((2, len(contact.pressure)))
    laws, spreads = list(system.laws.values()), list(system.spreads.values())
    rates[list(system.laws)] = WearRates(laws, spreads, at.wear, at.states)(contact.pressure)
    return rates


def profile(end: Snapshot) -> Profile:
    """Worn shapes of the interfaces, along their normals and along the load direction."""
    system, interface = end.system, end.interface
    normals = spatial(system.contacts.normals)
    along, shape = along_load(system), np.empty(len(interface.s))
    for own in system.contacts.ranges:
        height = interface.shape[own].max() - interface.shape[own] + system.contacts.gap[own].min()
        height = height / along[own]
        shape[own] = np.fmax.reduce(height) - height
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
        shape_along_press=shape,
        wear_rate=rate,
        wear_rate_along_press=rate / along,
    )


def along_load(system: System) -> np.ndarray:
    """Cosines between normals and load direction, shape (n,); NaN where the face is too steep."""
    along = np.einsum("ni,ni->n", system.contacts.normals, system.load_directions)
    return np.where(along > _LEAST_COSINE, along, np.nan)


def sample(snapshot: Snapshot) -> list[Samples]:
    """Sample displacement (holders' motion included), von Mises stress and temperature.

    Of the owned cells of each body. Every rank calls.
    """
    system, heated = snapshot.system, snapshot.bodies.temperatures
    elastic, thermal = system.elastic, system.thermal
    u = elastic.spaces.functions(snapshot.displacement, "u")
    wanted = [list(pair) for pair in zip(u, _von_mises(snapshot), strict=True)]
    if heated is not None and thermal is not None:
        rises = thermal.conduction.spaces.functions(heated.rise, "rise")
        wanted = [[*fields, rise] for fields, rise in zip(wanted, rises, strict=True)]
    n = divisions(system.bodies, max(system.model.discretisation.degree, 2))
    each = zip(system.bodies.each, wanted, strict=True)
    return [sampled(body.mesh, *GRIDS[body.cell_type](n), fields) for body, fields in each]


def fields_of(system: System, samples: Sequence[Samples]) -> AnyFields | None:
    """Fields of the bodies from their samples on rank 0; None on others. Every rank calls.

    Bodies are drawn at their positions of the last mesh motion to the worn faces: a body shortened
    by wear stays in contact with the others.
    """
    found = gathered(system, samples)
    if found is None:
        return None
    blocks = [_fields(system, *columns) for columns in found]
    return blocks[0] if len(blocks) == 1 else MixedFields(tuple(blocks))


def _von_mises(snapshot: Snapshot) -> list:
    """Expression of the von Mises stress of each body [Pa]; every rank calls."""
    system, state = snapshot.system, snapshot.bodies
    elastic, thermal, heated = system.elastic, system.thermal, state.temperatures
    du = elastic.spaces.functions(state.displacement, "u")
    if heated is None or thermal is None:
        return [_equivalent(body.stress(d)) for body, d in zip(elastic.each, du, strict=True)]
    spaces = thermal.conduction.spaces
    straining = straining_rises(spaces, heated.rise, system.bodies, thermal.expansions)
    hot = zip(elastic.each, du, straining, strict=True)
    return [_equivalent(body.stress(d, T)) for body, d, T in hot]


def _fields(
    system: System,
    pieces: np.ndarray,
    body: np.ndarray,
    points: np.ndarray,
    displacement: np.ndarray,
    mises: np.ndarray,
    rise: np.ndarray | None = None,
) -> BodyFields:
    """Fields in the cells of one type, from samples of shape (n_cells, n_points, components)."""
    placements = () if system.worn is None else system.worn.placements
    for number, placement in enumerate(placements, start=1):
        own = body == number
        placed = placement.at(points[own])
        points[own] += placed
        displacement[own] -= placed
    absolute = None
    if rise is not None and system.thermal is not None:
        absolute = rise[..., 0] + system.thermal.ambient
    return BodyFields(points, pieces, body, displacement, absolute, mises[..., 0])


def sampled(mesh, grid: np.ndarray, pieces: np.ndarray, fields: list) -> Samples:
    """Sample fields on a grid in each owned cell, which divides it into pieces."""
    cells = np.arange(mesh.topology.index_map(mesh.topology.dim).size_local, dtype=np.int32)
    placed, *stretched = tabulated(
        equispaced(mesh.topology.cell_name(), coordinate_element(mesh).degree), grid, 1
    )
    nodes = mesh.geometry.x[geometry_dofmap(mesh)[cells], : mesh.geometry.dim]
    jacobian = np.tensordot(nodes, stretched, (1, 2)).transpose(0, 3, 1, 2)
    centre = grid.mean(axis=0)
    inside = centre + (grid - centre) * (1 - _INSET)
    expressions = [compiled_expression(field, inside, mesh.comm) for field in fields]
    return Samples(
        placed @ nodes,
        np.abs(np.linalg.det(jacobian)),
        pieces,
        [evaluate(expression, mesh, cells) for expression in expressions],
    )


def gathered(system: System, samples: Sequence[Samples]) -> list[tuple[np.ndarray, ...]] | None:
    """Pieces, bodies, points and fields of the cells of each type, in the order of the mesh file.

    On rank 0; None on others. Every rank calls.
    """
    each = list(zip(system.bodies.each, samples, strict=True))
    found = system.bodies.in_file_order(
        [(_body_of_cells(system, body), one.points, *one.fields) for body, one in each]
    )
    if found is None:
        return None
    pieces = {body.block: one.pieces for body, one in each}
    return [(pieces[block], *columns) for block, columns in zip(sorted(pieces), found, strict=True)]


def _body_of_cells(system: System, body: BodyMesh) -> np.ndarray:
    """Number of the body (from 1) that each owned cell belongs to."""
    bodies = enumerate(system.model.bodies, start=1)
    numbers = {part: number for number, each in bodies for part in each.parts}
    of_parts = np.array([numbers[part] for part in body.names])
    return of_parts[body.parts_of_cells(np.arange(body.n_cells))]


def _equivalent(σ):
    s = σ - ufl.tr(σ) / 3 * ufl.Identity(3)
    return ufl.sqrt(1.5 * ufl.inner(s, s))

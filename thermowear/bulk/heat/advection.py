"""Advection of heat by a moving body, in a frame in which its geometry is at rest.

The shape of the body must be the same in the frame at all times: that of a body of revolution that
turns about its axis, or of a bar that moves along itself, whose ends let material in and out. Each
facet is then a line in the coordinates across the motion (radius and height, or y and z). Meshes
approximate walls that are curved across the motion: as far as neighbouring facets differ in slope,
facets may be inclined to the motion.

The velocity is the curl of a stream function with the nodes of the mesh: it is tangent to curved
faces whose nodes lie on the path of the body, and divergence-free, so that no heat is lost or
generated there at any speed. Where facets are inclined to the path, as those of straight-sided
fillets are, a gradient in the temperature space makes the velocity tangent (Helmholtz's
decomposition): the heat of any temperature of that space is then conserved to rounding.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from petsc4py import PETSc

import dolfinx
import numpy as np
import scipy.sparse as sp
import ufl
from dolfinx import default_scalar_type, fem

from ...compat import evaluate, exterior_facet_domain
from ...errors import CaseError
from ...parallel import sum_over_ranks
from ..bodies import Bodies, BodyMesh
from ..compiled import assembled_matrix, compiled_expression, nodal_loads
from ..kinematics import Kinematics, section_measure
from ..solvers.choice import SolverChoice, linear_solver
from ..solvers.direct import eliminate, multiply
from ..spaces import Spaces, as_function, geometry_space, owned, reference_element

_ROUNDING_OF_RADIUS = 1e-6
"""Rounding of places at the ends of the contact, relative to the body."""


@dataclass(frozen=True)
class Passage:
    """Rigid-body motion of a body through the frame.

    Attributes
    ----------
    parts : tuple of str
        Names of the body and its zones.
    center : tuple of float or None
        Centre of rotation; None for motion along x [m].
    speed : float
        Velocity along x [m/s], or anticlockwise angular velocity [rad/s].
    spread : bool
        True in the limit of high speed, with uniform temperature along each path.
    contact : tuple of float
        Range of x of its contacts, beyond which a body that moves along x ends, by default no
        points [m].
    """

    parts: tuple[str, ...]
    center: tuple[float, float] | None
    speed: float
    spread: bool
    contact: tuple[float, float] = (np.inf, -np.inf)

    def across(self, points: np.ndarray) -> np.ndarray:
        """Coordinates across the motion, and zero: radius or y, and z; shape (..., 3) [m]."""
        result = np.zeros_like(points)
        x, y, result[..., 1] = np.moveaxis(points, -1, 0)
        radius = None if self.center is None else np.hypot(x - self.center[0], y - self.center[1])
        result[..., 0] = y if radius is None else radius
        return result

    def directions(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Unit vectors of these coordinates at points (n, 3)."""
        first, second = np.zeros_like(points), np.zeros_like(points)
        second[:, 2] = 1.0
        if self.center is None:
            first[:, 1] = 1.0
        else:
            first[:, :2] = points[:, :2] - np.array(self.center)
            first /= np.maximum(np.linalg.norm(first, axis=1, keepdims=True), 1e-300)
        return first, second

    def is_end(self, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """Test where outer facets, by midpoints and outward normals (n, 3), are ends of a bar."""
        if self.center is not None:
            return np.zeros(len(points), dtype=bool)
        (low, high), x, slope = self.contact, points[:, 0], normals[:, 0]
        rounding = _ROUNDING_OF_RADIUS * max(np.ptp(x), 0.0)
        return ((x >= high - rounding) & (slope > 0)) | ((x <= low + rounding) & (slope < 0))

    def stream(self, mesh) -> fem.Function:
        """Stream function ψ with ``v = (∂ψ/∂y, -∂ψ/∂x)``, at unit speed."""
        ψ = fem.Function(geometry_space(mesh))
        ψ.interpolate(self._stream)
        return ψ

    def _stream(self, x: np.ndarray) -> np.ndarray:
        if self.center is None:
            return x[1]
        return -((x[0] - self.center[0]) ** 2 + (x[1] - self.center[1]) ** 2) / 2


_ROUNDING = 1e-3
"""Inclination to the motion that positions of nodes explain."""
_TURN, _MOST = 0.7, 0.6
"""Inclination by the difference in slope of neighbours, measured on coarse spheres, rings and
fillets (at most 0.5 of it), and the largest: walls across the motion have facets of nearly 1."""
_CORNERS = {"triangle": (3, 2), "tetrahedron": (4, 3), "quadrilateral": (4, 2)}
_CORNERS["hexahedron"] = (8, 4)
"""Corners of a cell, and of each of its facets."""
_SMOOTH = 0.2
"""Least cosine of the angle between neighbours on a curved wall, which others meet at edges."""


@dataclass(frozen=True)
class Facets:
    """Facets at which a body, or one of its materials, ends.

    Attributes
    ----------
    corners : ndarray, shape (n, k, 3) [m]
    inside : ndarray, shape (n, 3)
        Midpoints of the corners of a cell of each [m].
    surface : ndarray of int, shape (n,)
        Tag of its surface, 0 without one; -1 between two materials.
    """

    corners: np.ndarray
    inside: np.ndarray
    surface: np.ndarray

    @property
    def middle(self) -> np.ndarray:
        """Midpoints of the corners, shape (n, 3) [m]."""
        return self.corners.mean(axis=1)

    @property
    def normals(self) -> np.ndarray:
        """Outward unit normals, shape (n, 3)."""
        normals = _areas(self.corners)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        inward = np.sum(normals * (self.middle - self.inside), axis=1) < 0
        return np.where(inward[:, None], -normals, normals)


def require_swept(
    bodies: Bodies, passage: Passage, kinds: Mapping[str, int], mirrors: Sequence[str] = ()
) -> None:
    """Require a passing body to keep its shape in the frame. Every rank calls.

    Parameters
    ----------
    bodies : Bodies
    passage : Passage
    kinds : mapping of str to int
        Parts of the body with their kind of thermal material.
    mirrors : sequence of str
        Surfaces on planes of symmetry: paths go on in the mirror image, in the limit of high speed.

    Raises
    ------
    CaseError
    """
    for body in bodies.each:
        if not set(passage.parts) & set(body.parts):
            continue
        facets = _gathered(body, kinds)
        inclined, allowed = _inclination(facets.corners, passage)
        mirror = np.isin(facets.surface, [body.surfaces.index(name) + 1 for name in mirrors])
        end = passage.is_end(facets.middle, facets.normals) & (facets.surface >= 0)
        passed = end | mirror if passage.spread else end & ~mirror
        wrong = np.flatnonzero((inclined > allowed) & ~passed)
        if len(wrong):
            worst = wrong[np.argmax(inclined[wrong])]
            tags = np.unique(facets.surface[wrong][facets.surface[wrong] > 0])
            raise CaseError(_message(passage, facets, worst, [body.surfaces[t - 1] for t in tags]))


def lets_through(body: BodyMesh, passage: Passage) -> bool:
    """Test for walls across the motion, which no error of the mesh explains. Every rank calls."""
    facets = _gathered(body, {})
    inclined, _ = _inclination(facets.corners, passage)
    return bool(np.any((inclined > _MOST) & ~passage.is_end(facets.middle, facets.normals)))


def _message(passage: Passage, facets: Facets, worst: int, surfaces: list[str]) -> str:
    """Fault of walls that carry heat out, by the surfaces concerned or the worst place."""
    place = facets.corners[worst].mean(axis=0)
    where = ", ".join(map(repr, surfaces)) or ", ".join(
        f"{axis} = {value:.4g} m" for axis, value in zip("xyz", place, strict=True)
    )
    kind = "a border of materials" if facets.surface[worst] < 0 else "a wall"
    shape = "along its motion" if passage.center is None else "round about its axis"
    return (
        f"heat.advection: {passage.parts[0]!r} has {kind} at {where} that is not {shape} and would "
        "carry heat away, so that there are no steady temperatures in the frame of the contact; "
        'use a body without it, or heat.advection = "none"'
    )


def outer_facets(body: BodyMesh) -> tuple[np.ndarray, Facets]:
    """Outer facets of a body that this rank owns: their local indices, and their places."""
    mesh = body.mesh
    mesh.topology.create_connectivity(mesh.topology.dim - 1, mesh.topology.dim)
    outer = dolfinx.mesh.exterior_facet_indices(mesh.topology)
    known, tags = body.facet_tags.indices, np.zeros(len(outer), dtype=np.int64)
    tagged = np.isin(outer, known)
    tags[tagged] = body.facet_tags.values[np.searchsorted(known, outer[tagged])]
    return outer, _at(body, outer, tags)


def _at(body: BodyMesh, facets: np.ndarray, surface: np.ndarray) -> Facets:
    """Places of local facets with the tags of their surfaces."""
    mesh, tdim = body.mesh, body.mesh.topology.dim
    of_cell, of_facet = _CORNERS[body.cell_type]
    if not len(facets):
        return Facets(np.empty((0, of_facet, 3)), np.empty((0, 3)), surface)
    cells = mesh.topology.connectivity(tdim - 1, tdim)
    first = np.array([cells.links(facet)[0] for facet in facets], dtype=np.int32)
    at = dolfinx.mesh.entities_to_geometry(mesh, tdim - 1, facets)
    of = dolfinx.mesh.entities_to_geometry(mesh, tdim, first)
    x = mesh.geometry.x
    return Facets(x[at[:, :of_facet]], x[of[:, :of_cell]].mean(axis=1), surface)


def _gathered(body: BodyMesh, kinds: Mapping[str, int]) -> Facets:
    """Outer facets of a body and those between its materials, of all ranks."""
    _, outer = outer_facets(body)
    inner = _between(body, kinds) if len(set(kinds.values())) > 1 else np.empty(0, dtype=np.int32)
    border = _at(body, inner, np.full(len(inner), -1))
    own = [(f.corners, f.inside, f.surface) for f in (outer, border)]
    every = [part for parts in body.mesh.comm.allgather(own) for part in parts]
    return Facets(*(np.concatenate(part) for part in zip(*every, strict=True)))


def _between(body: BodyMesh, kinds: Mapping[str, int]) -> np.ndarray:
    """Local indices of the owned facets between cells of different kinds of parts."""
    tdim = body.mesh.topology.dim
    cells = body.mesh.topology.connectivity(tdim - 1, tdim)
    count = body.mesh.topology.index_map(tdim - 1).size_local
    starts = cells.offsets[: count + 1]
    inner = np.flatnonzero(np.diff(starts) == 2)
    pairs = np.stack([cells.array[starts[inner]], cells.array[starts[inner] + 1]], axis=1)
    kind = np.array([kinds.get(name, -1) for name in body.names])
    of = kind[body.parts_of_cells(pairs.ravel())].reshape(-1, 2)
    return inner[of[:, 0] != of[:, 1]].astype(np.int32)


def _inclination(corners: np.ndarray, passage: Passage) -> tuple[np.ndarray, np.ndarray]:
    """Sine of the inclination of facets to the motion, and the largest allowed one, (n,) each."""
    areas = _areas(corners)
    sizes = np.linalg.norm(areas, axis=1)
    inclined = np.linalg.norm(_areas(passage.across(corners)), axis=1) / sizes
    normals, sides = areas / sizes[:, None], passage.directions(corners.mean(axis=1))
    slopes = np.stack([np.sum(normals * side, axis=1) for side in sides], axis=1)
    slopes /= np.maximum(np.linalg.norm(slopes, axis=1), 0.5)[:, None]
    extent = np.ptp(corners.reshape(-1, 3), axis=0).max()
    _, node = np.unique(np.round(corners.reshape(-1, 3) / extent, 9), axis=0, return_inverse=True)
    facet = np.repeat(np.arange(len(corners)), corners.shape[1])
    at = sp.csr_matrix((np.ones(len(facet)), (facet, node.ravel())))
    one, other = (at @ at.T).nonzero()
    cosine = np.sum(normals[one] * normals[other], axis=1)
    turned = np.linalg.norm(slopes[one] - np.sign(cosine)[:, None] * slopes[other], axis=1)
    turn = np.zeros(len(corners))
    np.maximum.at(turn, one, np.where(np.abs(cosine) > _SMOOTH, turned, 0.0))
    return inclined, _ROUNDING + np.minimum(_TURN * turn, _MOST)


def _areas(corners: np.ndarray) -> np.ndarray:
    """Area vectors (n, 3) of edges in the plane, triangles or quadrilaterals by their corners."""
    if corners.shape[1] == 2:
        along = corners[:, 1] - corners[:, 0]
        return np.stack([along[:, 1], -along[:, 0], np.zeros(len(along))], axis=1)
    first, last = ((0, 1), (0, 2)) if corners.shape[1] == 3 else ((0, 3), (1, 2))
    return np.cross(*(corners[:, b] - corners[:, a] for a, b in (first, last))) / 2


_TANGENTIAL = 1e-10
"""Largest flow through walls that rounding explains, relative to that along them."""
_MAX_RESOLVED_PECLET = 1.0
"""Largest cell Péclet number at which no stabilisation is needed."""


@dataclass(frozen=True)
class Flow:
    """Flow of heat with a moving body, as UFL expressions.

    Attributes
    ----------
    kinematics : Kinematics
    capacity : dolfinx.fem.Function
        Volumetric heat capacity [J/(m³ K)].
    velocity : UFL expression
        [m/s]
    delay : UFL expression
        Time by which stabilising test functions look upwind [s].
    """

    kinematics: Kinematics
    capacity: fem.Function
    velocity: ufl.core.expr.Expr
    delay: ufl.core.expr.Expr

    def carried(self, T, δT, measure: ufl.Measure):
        """Form of the heat carried inside the body [W K]."""
        along = self.capacity * ufl.dot(self.velocity, ufl.grad(T))
        return self._integral(along * δT, measure)

    def upwind_diffusion(self, T, δT, measure: ufl.Measure):
        """Form of the diffusion along the flow by the stabilising test functions [W K]."""
        along = self.capacity * ufl.dot(self.velocity, ufl.grad(T))
        return self._integral(along * self.delay * ufl.dot(self.velocity, ufl.grad(δT)), measure)

    def _integral(self, density, measure: ufl.Measure):
        return self.kinematics.integral(self.capacity.function_space.mesh, density, measure)


@dataclass(frozen=True)
class Advection:
    """Advection terms of a moving body.

    Attributes
    ----------
    carried : petsc4py.PETSc.Mat
        Matrix of the advected heat [W/K]. Entering material is at ambient temperature.
    outflow : ndarray, shape (n_owned,)
        Heat that leaves through the ends of the body per nodal rise [W/K].
    peclet : float
        Largest cell Péclet number ``|v| h/(2 κ degree)``.
    paths : path_solver.ClosedPaths or None
        Closed paths of a body in space with rows of cells, for an iterative solver.
    flows : tuple of Flow or None
        Flow of each body; None of those at rest.
    """

    carried: PETSc.Mat
    outflow: np.ndarray
    peclet: float
    paths: Any = field(default=None, kw_only=True)
    flows: tuple[Flow | None, ...] = field(default=(), kw_only=True)

    @property
    def stabilised(self) -> bool:
        """True if some cells exceed the Péclet number that needs no stabilisation."""
        return self.peclet > _MAX_RESOLVED_PECLET


@dataclass(frozen=True)
class BodyAdvection(Advection):
    """Advection terms of the moving body alone.

    Attributes
    ----------
    upwind : UFL expression
        Addition to the test function by stabilisation (SUPG).
    flow : Flow
    """

    upwind: ufl.core.expr.Expr
    flow: Flow


def advection(
    body: BodyMesh,
    kinematics: Kinematics,
    space: fem.FunctionSpace,
    passage: Passage,
    conductivities: dict[str, float],
    capacities: dict[str, float],
    choice: SolverChoice,
) -> BodyAdvection:
    """Assemble the advection in a passing body. Every rank calls.

    At high cell Péclet numbers, upwind test functions (SUPG, Brooks and Hughes, Comput. Methods
    Appl. Mech. Eng. 32 (1982) 199) prevent oscillations of the temperature. From degree 2 on they
    are consistent, so that the order of convergence is kept; degree 1 has no second derivatives.

    Parameters
    ----------
    body : BodyMesh
        The moving body.
    kinematics : Kinematics
    space : dolfinx.fem.FunctionSpace
        Temperature space.
    passage : Passage
    conductivities, capacities : dict of str to float
        By part [W/(m K)] and [J/(m³ K)], at least for the moving parts of the body.
    choice : SolverChoice
    """
    mesh, degree = body.mesh, space.ufl_element().degree
    T, δT = ufl.TrialFunction(space), ufl.TestFunction(space)
    own = set(passage.parts) & set(body.parts)
    moving = {part: (conductivities[part], capacities[part]) for part in own}
    k = body.per_part({part: k for part, (k, _) in moving.items()})
    ρc = body.per_part({part: ρc for part, (_, ρc) in moving.items()})
    ends = _ends(body, passage, degree)
    everywhere = ufl.Measure("ds", domain=mesh, metadata={"quadrature_degree": 2 * degree + 2})
    v, leaks = _velocity(mesh, passage), lets_through(body, passage)
    through = ufl.dot(v, ufl.FacetNormal(mesh))
    if not leaks:
        v, through = _tangential(kinematics, space, v, ρc, everywhere, ends, choice)
    crossing = _transit_time(mesh, v)
    number = ufl.dot(v, v) * crossing / (2 * degree)  # times the diffusivity
    number *= body.per_part({part: ρc / k for part, (k, ρc) in moving.items()})
    peclet = _largest(body, passage, number)

    upwind = 0 * δT
    flow = ρc * ufl.dot(v, ufl.grad(T))
    delay = crossing / (2 * degree) * ufl.min_value(1, number / 3)
    if peclet > _MAX_RESOLVED_PECLET:  # the stabilisation vanishes with the cell Péclet number
        upwind = delay * ufl.dot(v, ufl.grad(δT))
        flow = flow * δT + (flow - k * ufl.div(ufl.grad(T))) * upwind
    else:
        flow = flow * δT
    carried = kinematics.integral(mesh, flow, section_measure(mesh, degree))
    # what leaks through walls across the motion is no outflow, so that the heat balance shows it
    outflow, out = np.zeros(owned(space)), ufl.max_value(through, 0)
    if leaks or ends is not None:
        open_ = everywhere if leaks else ends
        carried -= kinematics.integral(mesh, ρc * ufl.min_value(through, 0) * T * δT, open_)
    if ends is not None:
        outflow = nodal_loads(space, lambda δT: kinematics.integral(mesh, ρc * out * δT, ends))
    own_flow = Flow(kinematics, ρc, v, delay)
    return BodyAdvection(assembled_matrix(carried), outflow, peclet, upwind, own_flow)


def _ends(body: BodyMesh, passage: Passage, degree: int) -> ufl.Measure | None:
    """Measure of the ends through which material passes; None without any. Every rank calls."""
    facets, places = outer_facets(body)
    facets = facets[passage.is_end(places.middle, places.normals)]
    if not any(body.mesh.comm.allgather(len(facets))):
        return None
    entities = exterior_facet_domain(body.mesh, facets)
    data = {"quadrature_degree": 2 * degree + 2}
    return ufl.Measure("ds", domain=body.mesh, subdomain_data=[(1, entities)], metadata=data)(1)


def _tangential(
    kinematics: Kinematics,
    space: fem.FunctionSpace,
    v,
    ρc: fem.Function,
    everywhere: ufl.Measure,
    ends: ufl.Measure | None,
    choice: SolverChoice,
):
    """Velocity without flow through walls, and that through the ends, outward [m/s].

    With ``∫ ρc grad φ·grad q = ∫ ρc v·grad q`` for all q of the temperature space, less the flow
    through the ends, ``v - grad φ`` carries no heat out elsewhere. Every rank calls.
    """
    mesh, comm, degree = space.mesh, space.mesh.comm, space.ufl_element().degree
    dx, n, q = section_measure(mesh, degree), ufl.FacetNormal(mesh), ufl.TestFunction(space)
    through = ufl.dot(v, n)

    def loads(density, measure=dx) -> np.ndarray:
        return nodal_loads(space, lambda q: kinematics.integral(mesh, density(q), measure))

    flow = loads(lambda q: ρc * ufl.dot(v, ufl.grad(q)))
    size = loads(lambda q: ρc * ufl.sqrt(ufl.dot(v, v)) * q, everywhere)
    if ends is not None:
        flow -= loads(lambda q: ρc * through * q, ends)
    if _largest_of(comm, flow) <= _TANGENTIAL * _largest_of(comm, size):
        return v, through
    if ends is not None:  # as much material leaves as comes in
        passing = loads(lambda q: ρc * abs(through) * q, ends)
        excess, whole = sum_over_ranks(comm, np.array([flow.sum(), passing.sum()]))
        flow -= excess / whole * passing
        through += fem.Constant(mesh, default_scalar_type(excess / whole)) * abs(through)
    φ = ufl.TrialFunction(space)
    matrix = assembled_matrix(
        kinematics.integral(mesh, ρc * ufl.inner(ufl.grad(φ), ufl.grad(q)), dx)
    )
    fixed = np.zeros(len(flow), dtype=bool)
    fixed[:1] = sum(comm.allgather(len(flow))[: comm.rank]) == 0  # a constant does not matter
    held = matrix.copy()
    eliminate(held, fixed)
    solver, potential = linear_solver(choice, held, Spaces((space,)), fixed), np.zeros(len(flow))
    for _ in range(2):
        potential += solver.solve(np.where(fixed, 0.0, flow - multiply(matrix, potential)))
    return v - ufl.grad(as_function(space, potential, "potential")), through


def _largest_of(comm, values: np.ndarray) -> float:
    """Largest magnitude on all ranks."""
    return max(comm.allgather(float(np.abs(values).max(initial=0.0))))


def _velocity(mesh, passage: Passage):
    """Velocity of the passing body as a UFL vector [m/s]."""
    ψ = passage.stream(mesh)
    ψ.x.array[:] *= passage.speed
    v = [ψ.dx(1), -ψ.dx(0)]
    return ufl.as_vector(v + [0.0 * ψ] * (mesh.geometry.dim - 2))


def _transit_time(mesh, v):
    """Transit time through a cell [s], from the velocity in the reference cell."""
    speed = ufl.dot(ufl.inv(ufl.Jacobian(mesh)), v)
    return 1 / ufl.sqrt(ufl.max_value(ufl.dot(speed, speed), 1e-30))


def _largest(body: BodyMesh, passage: Passage, number) -> float:
    """Largest value of an expression at the midpoints of the moving cells."""
    mesh, cells = body.mesh, body.cells(*passage.parts)
    middle = reference_element(mesh, 1).points.mean(axis=0, keepdims=True)
    expression = compiled_expression(number, middle, mesh.comm)
    values = evaluate(expression, mesh, cells) if len(cells) else np.zeros(1)
    return max(mesh.comm.allgather(float(values.max())))

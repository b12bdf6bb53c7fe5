"""Advection of heat by a moving body, in a frame in which its geometry is at rest.

The velocity is the curl of a stream function with the nodes of the mesh: it is tangent to curved
faces whose nodes lie on the path of the body, and divergence-free, so that no heat is lost or
generated there at any speed. Where facets are inclined to the path, as those of straight-sided
fillets are, a gradient in the temperature space makes the velocity tangent (Helmholtz's
decomposition): the heat of any temperature of that space is then conserved to rounding.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from petsc4py import PETSc

import numpy as np
import ufl
from dolfinx import default_scalar_type, fem

from ...compat import evaluate, exterior_facet_domain
from ...parallel import sum_over_ranks
from ..body_mesh import BodyMesh
from ..compiled import assembled_matrix, compiled_expression, nodal_loads
from ..direct_solver import eliminate, multiply
from ..field import as_function, owned, reference_element
from ..kinematics import Kinematics, section_measure
from ..solver_choice import SolverChoice, linear_solver
from ..spaces import Spaces
from .passage import Passage
from .walls import lets_through, outer_facets

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

    def carried(self, T, δT, degree: int):
        """Form of the heat carried inside the body [W K]."""
        along = self.capacity * ufl.dot(self.velocity, ufl.grad(T))
        return self._integral(along * δT, degree)

    def upwind_diffusion(self, T, δT, degree: int):
        """Form of the diffusion along the flow by the stabilising test functions [W K]."""
        along = self.capacity * ufl.dot(self.velocity, ufl.grad(T))
        return self._integral(along * self.delay * ufl.dot(self.velocity, ufl.grad(δT)), degree)

    def _integral(self, density, degree: int):
        mesh = self.capacity.function_space.mesh
        return self.kinematics.integral(mesh, density, section_measure(mesh, degree))


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

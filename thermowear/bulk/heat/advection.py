"""Advection of heat by a moving body, in a frame in which its geometry is at rest.

The velocity is the curl of a stream function with the nodes of the mesh: it is tangent to curved
faces whose nodes lie on the path of the body, and divergence-free, so that no heat is lost or
generated there at any speed.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from petsc4py import PETSc

import numpy as np
import ufl
from dolfinx import fem
from dolfinx.mesh import exterior_facet_indices

from ...compat import evaluate, exterior_facet_domain
from ..body_mesh import BodyMesh
from ..compiled import assembled_matrix, compiled_expression
from ..field import geometry_space, reference_element
from ..kinematics import Kinematics, section_measure

_MAX_RESOLVED_PECLET = 1.0
"""Largest cell Péclet number at which no stabilisation is needed."""


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
    """

    parts: tuple[str, ...]
    center: tuple[float, float] | None
    speed: float
    spread: bool

    def stream(self, mesh) -> fem.Function:
        """Stream function ψ with ``v = (∂ψ/∂y, -∂ψ/∂x)``, at unit speed."""
        ψ = fem.Function(geometry_space(mesh))
        ψ.interpolate(self._stream)
        return ψ

    def _stream(self, x: np.ndarray) -> np.ndarray:
        if self.center is None:
            return x[1]
        return -((x[0] - self.center[0]) ** 2 + (x[1] - self.center[1]) ** 2) / 2


@dataclass(frozen=True)
class Advection:
    """Advection terms of a moving body.

    Attributes
    ----------
    carried : petsc4py.PETSc.Mat
        Matrix of the advected heat: its row sums times the rise give the heat that leaves with the
        body [W/K]. Entering material is at ambient temperature.
    peclet : float
        Largest cell Péclet number ``|v| h/(2 κ degree)``.
    paths : path_solver.ClosedPaths or None
        Closed paths of a body in space with rows of cells, for an iterative solver.
    """

    carried: PETSc.Mat
    peclet: float
    paths: Any = field(default=None, kw_only=True)

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
    """

    upwind: ufl.core.expr.Expr


def advection(
    body: BodyMesh,
    kinematics: Kinematics,
    space: fem.FunctionSpace,
    passage: Passage,
    conductivities: dict[str, float],
    capacities: dict[str, float],
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
    """
    mesh, degree = body.mesh, space.ufl_element().degree
    T, δT = ufl.TrialFunction(space), ufl.TestFunction(space)
    own = _moving(body, passage)
    moving = {part: (conductivities[part], capacities[part]) for part in own}
    k = body.per_part({part: k for part, (k, _) in moving.items()})
    ρc = body.per_part({part: ρc for part, (_, ρc) in moving.items()})
    v = _velocity(mesh, passage)
    number, delay = _upwinding(body, passage, moving, degree)
    peclet = _largest(body, passage, number)

    upwind = 0 * δT
    carried = carrying(body, kinematics, passage, capacities, degree)(T, δT)
    if peclet > _MAX_RESOLVED_PECLET:  # the stabilisation vanishes with the cell Péclet number
        upwind = delay * ufl.dot(v, ufl.grad(δT))
        flow = ρc * ufl.dot(v, ufl.grad(T)) - k * ufl.div(ufl.grad(T))
        carried += kinematics.integral(mesh, flow * upwind, section_measure(mesh, degree))
    return BodyAdvection(assembled_matrix(carried), peclet, upwind)


def carrying(
    body: BodyMesh,
    kinematics: Kinematics,
    passage: Passage,
    capacities: dict[str, float],
    degree: int,
):
    """Bilinear form of the heat carried by a body, as a function of T and δT [W K].

    Zero in a body at rest. Material that enters is at ambient temperature.
    """
    mesh = body.mesh
    ρc = body.per_part({part: capacities[part] for part in _moving(body, passage)})
    v = _velocity(mesh, passage)
    into = ufl.max_value(-ufl.dot(v, ufl.FacetNormal(mesh)), 0)
    dx = section_measure(mesh, degree)
    mesh.topology.create_connectivity(mesh.topology.dim - 1, mesh.topology.dim)
    boundary = exterior_facet_domain(mesh, exterior_facet_indices(mesh.topology))
    ds = ufl.Measure(
        "ds",
        domain=mesh,
        subdomain_data=[(1, boundary)],
        metadata={"quadrature_degree": 2 * degree + 2},
    )(1)
    return lambda T, δT: (
        kinematics.integral(mesh, ρc * ufl.dot(v, ufl.grad(T)) * δT, dx)
        + kinematics.integral(mesh, ρc * into * T * δT, ds)
    )


def streamline_diffusion(
    body: BodyMesh,
    kinematics: Kinematics,
    passage: Passage,
    conductivities: dict[str, float],
    capacities: dict[str, float],
    degree: int,
):
    """Bilinear form of the diffusion along the motion by upwind test functions, see `advection`."""
    mesh, own = body.mesh, _moving(body, passage)
    ρc, v = body.per_part({part: capacities[part] for part in own}), _velocity(mesh, passage)
    moving = {part: (conductivities[part], capacities[part]) for part in own}
    _, delay = _upwinding(body, passage, moving, degree)
    dx = section_measure(mesh, degree)
    return lambda T, δT: kinematics.integral(
        mesh, delay * ρc * ufl.dot(v, ufl.grad(T)) * ufl.dot(v, ufl.grad(δT)), dx
    )


def _moving(body: BodyMesh, passage: Passage) -> set[str]:
    """Parts of a body that move."""
    return set(passage.parts) & set(body.parts)


def _upwinding(
    body: BodyMesh, passage: Passage, moving: dict[str, tuple[float, float]], degree: int
):
    """Cell Péclet number, and the delay of the upwind test functions [s]."""
    v = _velocity(body.mesh, passage)
    crossing = _transit_time(body.mesh, v)
    number = ufl.dot(v, v) * crossing / (2 * degree)  # times the diffusivity
    number *= body.per_part({part: ρc / k for part, (k, ρc) in moving.items()})
    return number, crossing / (2 * degree) * ufl.min_value(1, number / 3)


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

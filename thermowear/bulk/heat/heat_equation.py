"""Assembly of the heat equation: conduction, cooling, storage and advection."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from petsc4py import PETSc

import numpy as np
import ufl
from dolfinx import default_scalar_type, fem

from ..bodies import Bodies, BodyMesh
from ..compiled import assembled_matrix
from ..joints import NO_JOINTS, Joints
from ..kinematics import Kinematics, section_measure
from ..solvers.choice import SolverChoice
from ..spaces import Spaces, block_diagonal, owned
from .advection import Advection, BodyAdvection, Passage, advection
from .conduction import Conduction, conduction_solver
from .paths import EvenPaths, closed_paths


@dataclass(frozen=True)
class ThermalMaterial:
    """Conductivity [W/(m K)] and optional volumetric heat capacity [J/(m³ K)]."""

    conductivity: float
    capacity: float | None = None

    def times(self, factor: float) -> ThermalMaterial:
        """Material with conductivity and heat capacity scaled by a factor."""
        capacity = None if self.capacity is None else factor * self.capacity
        return ThermalMaterial(factor * self.conductivity, capacity)


def conduction(
    bodies: Bodies,
    kinematics: Kinematics,
    spaces: Spaces,
    materials: dict[str, ThermalMaterial],
    cooling: dict[str, float],
    given: dict[str, float],
    bath: PETSc.Mat,
    passage: Passage | None = None,
    choice: SolverChoice | None = None,
    joints: Joints = NO_JOINTS,
) -> Conduction:
    """Assemble the heat conduction problem and set up its solver. Every rank calls.

    Parameters
    ----------
    bodies : Bodies
    kinematics : Kinematics
    spaces : Spaces
        Scalar spaces of the temperature rise.
    materials : dict of str to ThermalMaterial
        Materials by part.
    cooling : dict of str to float
        Heat transfer coefficients by surface [W/(m² K)].
    given : dict of str to float
        Prescribed rise over ambient by surface [K].
    bath : petsc4py.PETSc.Mat
        Heat transfer from the contact faces to a heat bath at ambient temperature, added to the
        factorised matrix only. It keeps the matrix of an otherwise insulated body regular; the
        interface problem subtracts it again.
    passage : Passage, optional
        Motion of a body through the frame.
    choice : SolverChoice, optional
        Direct by default.
    joints : Joints, optional
        Joints of glued bodies, see `contact.ties`.
    """
    spaces, choice = joints.joining(spaces), choice or SolverChoice()
    spread = passage is not None and passage.spread
    even = EvenPaths(bodies, spaces, passage) if passage is not None and spread else None
    blocks = [
        _assembled(body, kinematics, space, materials, cooling, None if spread else passage, choice)
        for body, space in zip(bodies.each, spaces.each, strict=True)
    ]
    conductivity = block_diagonal([block.conductivity for block in blocks])
    cooled = block_diagonal([block.cooling for block in blocks])
    capacities = [block.capacity for block in blocks if block.capacity is not None]
    capacity = block_diagonal(capacities) if len(capacities) == len(blocks) else None
    moving = None
    if any(block.advection is not None for block in blocks):
        moving = Advection(
            block_diagonal([_carried(block) for block in blocks]),
            np.concatenate(
                [_outflow(*pair) for pair in zip(blocks, spaces.each, strict=True)],
            ),
            max(block.advection.peclet for block in blocks if block.advection is not None),
            flows=tuple(
                None if block.advection is None else block.advection.flow for block in blocks
            ),
        )
        if choice.iterative and moving.stabilised:
            moving = replace(moving, paths=closed_paths(bodies, spaces, passage))
        conductivity.axpy(1.0, moving.carried, PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
    fixed, values = given_rises(bodies, spaces, given, even)
    factor = conduction_solver(
        spaces, conductivity, bath, fixed, moving, even, choice, joints=joints
    )
    return Conduction(
        spaces,
        conductivity,
        cooled,
        capacity,
        bath,
        fixed,
        values,
        factor,
        moving,
        even,
        symmetric=moving is None,
        choice=choice,
        joints=joints,
    )


@dataclass(frozen=True)
class _BodyMatrices:
    """Matrices of one body, see `Conduction`; conductivity alone."""

    conductivity: PETSc.Mat
    cooling: PETSc.Mat
    capacity: PETSc.Mat | None
    advection: BodyAdvection | None


def _assembled(
    body: BodyMesh,
    kinematics: Kinematics,
    space: fem.FunctionSpace,
    materials: dict[str, ThermalMaterial],
    cooling: dict[str, float],
    passage: Passage | None,
    choice: SolverChoice,
) -> _BodyMatrices:
    """Conduction, cooling and storage of one body, and advection in it; as in `conduction`."""
    degree, T, δT = space.ufl_element().degree, ufl.TrialFunction(space), ufl.TestFunction(space)
    own = {part: materials[part] for part in body.parts if part in materials}
    conductivities = {part: material.conductivity for part, material in own.items()}
    capacities = {p: m.capacity for p, m in own.items() if m.capacity is not None}
    moving = None
    if passage is not None and set(passage.parts) & set(body.parts):
        moving = advection(body, kinematics, space, passage, conductivities, capacities, choice)
    measure = section_measure(body.mesh, degree)
    conductivity = assembled_matrix(conducting(body, kinematics, conductivities, measure)(T, δT))
    cooled = _cooled(body, kinematics, cooling, conductivity, (T, δT))
    conductivity.axpy(1.0, cooled, PETSc.Mat.Structure.SUBSET_NONZERO_PATTERN)
    capacity = None
    if len(capacities) == len(own):
        test = δT if moving is None else δT + moving.upwind
        density = body.per_part(capacities) * T * test
        capacity = assembled_matrix(kinematics.integral(body.mesh, density, measure))
    return _BodyMatrices(conductivity, cooled, capacity, moving)


def _cooled(
    body: BodyMesh,
    kinematics: Kinematics,
    cooling: dict[str, float],
    conductivity: PETSc.Mat,
    arguments: tuple,
) -> PETSc.Mat:
    """Cooling of one body, with the pattern of its cooled surfaces: far smaller than the body's."""
    if not cooling:
        return assembled_matrix(pattern=conductivity)
    (everywhere,) = transferring(body, kinematics, dict.fromkeys(cooling, 1.0))
    pattern = assembled_matrix(everywhere(*arguments))
    transfers = (form(*arguments) for form in transferring(body, kinematics, cooling))
    return assembled_matrix(*transfers, pattern=pattern)


def _carried(block: _BodyMatrices) -> PETSc.Mat:
    """Advection matrix of a body, zero in a body at rest."""
    if block.advection is not None:
        return block.advection.carried
    nothing = block.conductivity.duplicate()
    nothing.zeroEntries()
    nothing.assemble()
    return nothing


def _outflow(block: _BodyMatrices, space: fem.FunctionSpace) -> np.ndarray:
    """Heat that leaves a body per nodal rise, zero at rest, owned values [W/K]."""
    return np.zeros(owned(space)) if block.advection is None else block.advection.outflow


def conducting(
    body: BodyMesh,
    kinematics: Kinematics,
    conductivities: dict[str, float],
    measure: ufl.Measure,
):
    """Bilinear form of conduction, as a function of trial and test functions [W K]."""
    mesh, k = body.mesh, body.per_part(conductivities)
    return lambda T, δT: kinematics.integral(
        mesh, k * ufl.inner(ufl.grad(T), ufl.grad(δT)), measure
    )


def transferring(
    body: BodyMesh, kinematics: Kinematics, coefficients: dict[str, float]
) -> list[Callable]:
    """Bilinear forms ``∫ h T δT dS`` as functions of T and δT, one per distinct value of h.

    Parameters
    ----------
    body : BodyMesh
    kinematics : Kinematics
    coefficients : dict of str to float
        Heat transfer coefficient h by surface [W/(m² K)].
    """
    mesh = body.mesh

    def form(h: float) -> Callable:
        ds = body.surface_measure(*(s for s, other in coefficients.items() if other == h))
        constant = fem.Constant(mesh, default_scalar_type(h))
        return lambda T, δT: kinematics.integral(mesh, constant * T * δT, ds)

    return [form(h) for h in dict.fromkeys(coefficients.values())]


def surface_heat(
    bodies: Bodies, kinematics: Kinematics, spaces: Spaces, surface: str, flux: float
) -> np.ndarray:
    """Nodal heat of a uniform flux [W/m²] into the body through a surface [W], owned rows.

    Every rank calls; `spaces` are those of the temperature.
    """

    def inflow(body: BodyMesh) -> Callable:
        measure = body.surface_measure(surface)
        q = fem.Constant(body.mesh, default_scalar_type(flux))
        return lambda δT: kinematics.integral(body.mesh, q * δT, measure)

    return spaces.loads(map(inflow, bodies.each))


def stored_heat_rates(
    bodies: Bodies,
    kinematics: Kinematics,
    spaces: Spaces,
    materials: dict[str, ThermalMaterial],
    rates: Sequence[fem.Function],
) -> np.ndarray:
    """Nodal rates of the heat stored where temperatures rise at given rates [W], owned rows.

    Every rank calls; `spaces` are those of the test functions, `rates` by body in [K/s].
    """

    def storing(body: BodyMesh, rate: fem.Function) -> Callable:
        capacities = {p: materials[p].capacity or 0.0 for p in body.parts if p in materials}
        degree = rate.function_space.ufl_element().degree
        density = body.per_part(capacities) * rate
        measure = section_measure(body.mesh, degree + 1)
        return lambda δT: kinematics.integral(body.mesh, density * δT, measure)

    return spaces.loads(map(storing, bodies.each, rates))


def given_rises(
    bodies: Bodies, spaces: Spaces, given: dict[str, float], even: EvenPaths | None
) -> tuple[np.ndarray, np.ndarray]:
    """Mask of fixed owned values, and their rises, linear in the rises given by surface [K]."""
    fixed, values = np.zeros(spaces.owned, dtype=bool), np.zeros(spaces.owned)
    parts = zip(bodies.each, spaces.each, spaces.split(fixed), spaces.split(values), strict=True)
    for body, space, held, at in parts:
        for surface, rise in given.items():
            dofs = fem.locate_dofs_topological(space, bodies.dim - 1, body.facets(surface))
            mine = dofs[dofs < len(held)]
            held[mine], at[mine] = True, rise
    return (fixed, values) if even is None else even.whole(fixed, values)

"""Linear elasticity of the bodies, with thermal strain."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from scipy.linalg import null_space

from ...parallel import sum_over_ranks
from ..bodies import Bodies, BodyMesh
from ..compiled import assembled, assembled_matrix, compiled, surface_area
from ..joints import NO_JOINTS, Border, Joints
from ..kinematics import Kinematics
from ..solvers.choice import AnySolver, SolverChoice, linear_solver
from ..solvers.direct import DirectSolver, eliminate, multiply
from ..solvers.groups import JoinedSolver, factorised
from ..solvers.multigrid import MultigridSolver
from ..spaces import Rows, Spaces, block_diagonal, lagrange_spaces, owned, without_fixed
from .body import ElasticBody, ElasticForms, ElasticMaterial


def pin(fixed: np.ndarray, motions: np.ndarray, comm) -> np.ndarray:
    """Fix as many values, in place, as there are motions that no fixed value prevents.

    Every rank calls.

    Parameters
    ----------
    fixed : ndarray of bool, shape (n_owned,)
    motions : ndarray, shape (n_owned, k)
        Rigid motions of bodies.
    comm : mpi4py.MPI.Comm

    Returns
    -------
    ndarray, shape (n_owned, m)
        Free motions, at most one for each of the given ones.
    """
    free = left = _free(motions, fixed, comm)
    while left.shape[1]:
        _pin(fixed, left[:, 0], comm)
        left = _free(left, fixed, comm)
    return free


def _free(motions: np.ndarray, fixed: np.ndarray, comm) -> np.ndarray:
    """Combinations of motions (n_owned, k) that move no fixed value, scaled to 1."""
    if not motions.shape[1]:
        return motions
    scale = np.sqrt(sum_over_ranks(comm, (motions**2).sum(axis=0)))
    scaled = motions / np.where(scale > 0.0, scale, 1.0)
    held = sum_over_ranks(comm, scaled[fixed].T @ scaled[fixed])
    combined = scaled @ null_space(held, rcond=1e-12) if held.any() else scaled
    largest = max(comm.allgather(float(np.abs(combined).max(initial=0.0))))
    return combined / (largest or 1.0)


def _pin(fixed: np.ndarray, motion: np.ndarray, comm) -> None:
    """Fix the free value that moves most, in place; every rank calls."""
    movable = np.where(fixed, 0.0, np.abs(motion))
    own = float(movable.max(initial=0.0))
    largest = comm.allgather(own)
    if int(np.argmax(largest)) == comm.rank and own > 0.0:
        fixed[int(np.argmax(movable))] = True


@dataclass(frozen=True)
class ThermalForces:
    """Nodal forces of temperature rises, linear in them, body by body.

    Attributes
    ----------
    forms : tuple of UFL forms
        Work of the thermal stress of a rise, bilinear, by body.
    columns : Spaces
        Spaces of the rise.
    once : bool
        True if a single product is expected: its vector takes less memory than a matrix.
    """

    forms: tuple[ufl.Form, ...]
    columns: Spaces
    once: bool = False

    @cached_property
    def each(self) -> tuple[PETSc.Mat, ...]:
        """Matrices G of the nodal forces per nodal rise by body [N/K]. Every rank calls first."""
        return tuple(assembled_matrix(form) for form in self.forms)

    def multiply(self, rise: np.ndarray) -> np.ndarray:
        """Forces [N] of a rise (n_owned,) of all bodies [K], owned rows. Every rank calls."""
        if self.once and "each" not in vars(self):
            rises = zip(self.forms, self.columns.functions(rise, "rise"), strict=True)
            return np.concatenate([assembled(compiled(ufl.action(*one))) for one in rises])
        parts = zip(self.each, self.columns.split(rise), strict=True)
        return np.concatenate([multiply(matrix, part) for matrix, part in parts])


@dataclass(frozen=True)
class ElasticGroup:
    """Elasticity problem of a group of bodies, with the solver of its equations.

    Attributes
    ----------
    spaces : Spaces
        Displacement spaces of its bodies [m].
    fixed : ndarray of bool, shape (n_owned,)
        Mask of values held at zero.
    support_rows : petsc4py.PETSc.Mat
        Rows of the stiffness of the nodes of these values, for the support reactions.
    matrix : petsc4py.PETSc.Mat
        Stiffness with the rows and columns of these values eliminated.
    border : Border
        Conditions of the joints.
    factor : DirectSolver, JoinedSolver or MultigridSolver
        Solver of the matrix.
    choice : SolverChoice
    """

    spaces: Spaces
    fixed: np.ndarray
    support_rows: PETSc.Mat
    matrix: PETSc.Mat
    border: Border
    factor: AnySolver
    choice: SolverChoice

    def solve(self, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Displacements [m] due to nodal loads [N]; owned rows, one or several columns."""
        return self.factor.solve(without_fixed(loads, self.fixed))

    def release(self) -> None:
        """Free the levels of multigrid, until they are needed again. Every rank calls."""
        if isinstance(self.factor, MultigridSolver):
            self.factor.release()

    @contextmanager
    def solver_of_columns(self) -> Iterator[Callable]:
        """Function like `solve` for many columns of loads.

        Where single loads are solved for by multigrid it is a factor that exists meanwhile, if one
        of this body fits into the memory: a column then costs a hundredth. Every rank calls.
        """
        if not self.choice.factorises_columns:
            yield self.solve
            return
        matrix = self.matrix.convert(PETSc.Mat.Type.SBAIJ, PETSc.Mat())
        factor = DirectSolver(matrix, dim=self.spaces.dim)
        try:
            yield lambda loads: factor.solve(without_fixed(loads, self.fixed))
        finally:
            factor.destroy()
            matrix.destroy()

    def reactions(self, displacement: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Support reactions [N], owned rows; zero in the free values."""
        result, held = np.zeros(len(self.fixed)), _of_nodes(self.fixed, self.spaces)
        result[held] = multiply(self.support_rows, displacement) - loads[held]
        if self.border.count:
            result += self.border.jump @ self.multipliers(displacement, loads)
        return np.where(self.fixed, result, 0.0)

    def multipliers(self, displacement: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Multipliers of the joints (m,) of a solution under nodal loads. Every rank calls."""
        if not isinstance(self.factor, JoinedSolver):
            return np.zeros(0)
        residual = loads - multiply(self.matrix, displacement)
        jumps = sum_over_ranks(self.spaces.comm, self.border.jump.T @ displacement)
        return self.factor.multipliers(residual, jumps)


def elastic_group(
    bodies: Sequence[ElasticBody], border: Border, choice: SolverChoice
) -> ElasticGroup:
    """Assemble the stiffness of a body, or of glued ones, and set up its solver; collective."""
    spaces = Spaces(tuple(body.space for body in bodies))
    fixed = np.concatenate([body.fixed for body in bodies])
    blocks = [body.stiffness(body.space, blocked=choice.iterative) for body in bodies]
    matrix = block_diagonal(blocks)
    support_rows = _rows(matrix, _of_nodes(fixed, spaces))
    eliminate(matrix, fixed)
    if border.count:
        choice.require_direct()
        factor: AnySolver = factorised(matrix, border, fixed, "symmetric", spaces.dim)
    else:
        forms, degree = bodies[0], spaces.degree

        def coarse(linear: Spaces) -> PETSc.Mat:
            return forms.coarse_stiffness(linear.each[0], degree)

        factor = linear_solver(choice, matrix, spaces, fixed, coarse=coarse)
    return ElasticGroup(spaces, fixed, support_rows, matrix, border, factor, choice)


def _of_nodes(values: np.ndarray, spaces: Spaces) -> np.ndarray:
    """Mask of all values of the nodes of some owned ones, both (n_owned,)."""
    return np.repeat(values.reshape(-1, spaces.components).any(axis=1), spaces.components)


def _rows(matrix: PETSc.Mat, chosen: np.ndarray) -> PETSc.Mat:
    """Rows of a matrix chosen by a mask of owned values. Every rank calls."""
    (first, _), (start, end) = matrix.getOwnershipRange(), matrix.getOwnershipRangeColumn()
    rows = (np.flatnonzero(chosen) + first).astype(PETSc.IntType)
    return matrix.createSubMatrix(
        PETSc.IS().createGeneral(rows, matrix.comm),
        PETSc.IS().createStride(end - start, start, 1, comm=matrix.comm),
    )


@dataclass(frozen=True)
class Elasticity:
    """Elasticity problem of the bodies, solved group by group: of a body, or of glued ones.

    Attributes
    ----------
    bodies : Bodies
    kinematics : Kinematics
    spaces : Spaces
        Displacement spaces [m].
    each : tuple of ElasticBody
    joints : Joints
        Joints of glued bodies; their multipliers are tractions on the first of them [Pa].
    groups : tuple of ElasticGroup
        In the order of `Spaces.groups`.
    """

    bodies: Bodies
    kinematics: Kinematics
    spaces: Spaces
    each: tuple[ElasticBody, ...]
    joints: Joints
    groups: tuple[ElasticGroup, ...]

    @cached_property
    def fixed(self) -> np.ndarray:
        """Mask of values held at zero, shape (n_owned,)."""
        return np.concatenate([body.fixed for body in self.each])

    @cached_property
    def stiffness(self) -> PETSc.Mat:
        """Stiffness without supports, assembled on first use. Every rank calls."""
        return block_diagonal([body.stiffness(body.space) for body in self.each])

    def surface_work(self, surface: str, force: np.ndarray) -> list[Callable]:
        """Forms by body of the work of a force distributed over a surface [J].

        Parameters
        ----------
        surface : str
        force : ndarray, shape (gdim,)
            Total force on the ring or over the thickness [N].
        """
        traction = force / surface_area(self.bodies, self.kinematics, surface)
        return [body.traction_work(surface, traction) for body in self.each]

    def pressure_work(self, surface: str, pressure: float) -> list[Callable]:
        """Forms by body of the work of a pressure [Pa] along the inward normal [J]."""
        return [body.pressure_work(surface, pressure) for body in self.each]

    def solve(self, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Displacements [m] due to nodal loads [N]; owned rows, one or several columns."""
        result = np.empty(loads.shape, order="F")
        for group, rows in self._with_rows:
            result[rows] = group.solve(loads[rows])
            if group.choice.solves_once:
                group.release()
        return result

    def reactions(self, displacement: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Support reactions [N], owned rows; zero in the free values."""
        result = np.empty(len(loads))
        for group, rows in self._with_rows:
            result[rows] = group.reactions(displacement[rows], loads[rows])
        return result

    def multipliers(self, displacement: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Multipliers of the joints (m,) of a solution under nodal loads. Every rank calls."""
        result = np.zeros(self.joints.count)
        for group, rows in self._with_rows:
            found = group.multipliers(displacement[rows], loads[rows])
            result[group.border.columns] = found
        return result

    def joint_forces(self, displacement: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Nodal forces of the joints on the bodies [N], supported values included, owned rows."""
        if not self.joints.count:
            return np.zeros(len(loads))
        return -(self.joints.jump @ self.multipliers(displacement, loads))

    def unbalanced(self, forces: np.ndarray) -> np.ndarray:
        """Nodal forces (n_owned,) on free values without those that the joints carry [N]."""
        if not self.joints.count:
            return forces
        none = np.zeros(len(forces))
        return forces + without_fixed(self.joint_forces(none, forces), self.fixed)

    @property
    def _with_rows(self) -> Iterator[tuple[ElasticGroup, Rows]]:
        """Groups with their owned rows."""
        for group, bodies in zip(self.groups, self.spaces.groups, strict=True):
            yield group, self.spaces.rows(*bodies)

    def compressibility(self) -> float:
        """Smallest ``1 - 2 ν`` of the bodies; every rank calls."""
        return min(self.bodies.comm.allgather(min(b.least_compressibility for b in self.each)))

    def owned_by(self, *parts: str) -> np.ndarray:
        """Mask of the owned nodes that belong to parts of bodies, shape (n_owned / gdim,)."""
        return self.spaces.nodes_of(self.bodies, *parts)

    def nodes(self) -> np.ndarray:
        """Coordinates of the owned nodes, shape (n_owned / gdim, gdim) [m]."""
        return self.spaces.nodes()

    def expanding(self, materials: dict[str, ElasticMaterial]) -> Elasticity:
        """Same bodies with the expansion of other materials, and the same solver."""
        each = []
        for body in self.each:
            λ, μ, _ = body.lame
            each.append(replace(body, lame=(λ, μ, _lame(body.body, self.kinematics, materials)[2])))
        return replace(self, each=tuple(each))

    def thermal_load(self, temperatures: Spaces, only: str | None = None) -> ThermalForces:
        """Nodal loads of a temperature rise, ``∫ m T tr ε(δu) dV`` [N].

        Over all bodies, or over the part `only`.
        """
        parts = zip(self.each, temperatures.each, strict=True)
        each = tuple(body.load_of_rises(rises, body.space, only) for body, rises in parts)
        return ThermalForces(
            each, temperatures, all(group.choice.solves_once for group in self.groups)
        )


def elasticity(
    bodies: Bodies,
    kinematics: Kinematics,
    degree: int,
    materials: dict[str, ElasticMaterial],
    clamped: Sequence[str],
    symmetric: tuple[str, ...] = (),
    rollers: tuple[str, ...] = (),
    choice: SolverChoice | None = None,
    mid_plane: tuple[str, ...] = (),
    joints: Callable[[Spaces], Joints] | None = None,
    pinned: Callable[[Spaces, list[np.ndarray]], list[np.ndarray]] | None = None,
) -> Elasticity:
    """Assemble the stiffness and set up its solver, group by group. Every rank calls.

    Parameters
    ----------
    bodies : Bodies
    kinematics : Kinematics
    degree : int
        Polynomial degree of the displacement.
    materials : dict of str to ElasticMaterial
        Materials by part.
    clamped : sequence of str
        Surfaces fixed in all directions.
    symmetric : tuple of str
        Surfaces on a plane of symmetry x = const.: the first displacement component vanishes.
    rollers : tuple of str
        Surfaces whose second displacement component vanishes.
    choice : SolverChoice, optional
        Direct by default.
    mid_plane : tuple of str
        Surfaces in space whose third displacement component vanishes.
    joints : callable, optional
        Joints of glued bodies in the displacement spaces, see `contact.ties`.
    pinned : callable, optional
        Masks by body of the owned values held at zero, from the spaces and those of the supports.

    Raises
    ------
    ComputationError
        If a body, or a group of glued ones, is not supported, or is too large for a factor.
    """
    spaces = lagrange_spaces(bodies, degree, kinematics.components(bodies.dim))
    choice = choice or SolverChoice()
    glued = NO_JOINTS if joints is None else joints(spaces)
    spaces = glued.joining(spaces)
    guided = symmetric, rollers, mid_plane
    pairs = list(zip(bodies.each, spaces.each, strict=True))
    held = [fixed_values(body, kinematics, space, clamped, guided) for body, space in pairs]
    if pinned is not None:
        held = pinned(spaces, held)
    each = []
    for (body, space), fixed in zip(pairs, held, strict=True):
        forms = ElasticForms(body, kinematics, _lame(body, kinematics, materials))
        each.append(ElasticBody(forms.body, kinematics, forms.lame, space, fixed))
    groups = tuple(
        elastic_group(
            [each[k] for k in members], glued.border(members, spaces.rows(*members)), choice
        )
        for members in spaces.groups
    )
    return Elasticity(bodies, kinematics, spaces, tuple(each), glued, groups)


def supported(stiffness: PETSc.Mat, fixed: np.ndarray) -> PETSc.Mat:
    """Copy of a stiffness with rows and columns of fixed values eliminated. Every rank calls."""
    result = stiffness.copy()
    eliminate(result, fixed)
    return result


def _lame(body: BodyMesh, kinematics: Kinematics, materials: dict[str, ElasticMaterial]):
    λ, μ, m = {}, {}, {}
    for name, material in materials.items():
        E, ν = material.young_modulus, material.poisson_ratio
        λ[name], μ[name] = kinematics.lame(E, ν)
        m[name] = kinematics.thermal_modulus(E, ν) * material.expansion
    return body.per_part(λ), body.per_part(μ), body.per_part(m)


def fixed_values(body: BodyMesh, kinematics: Kinematics, space, clamped, guided) -> np.ndarray:
    """Mask of the owned values fixed by supports, symmetry planes and the axis of symmetry.

    Parameters
    ----------
    body : BodyMesh
    kinematics : Kinematics
    space : dolfinx.fem.FunctionSpace
        Vector-valued space.
    clamped : sequence of str
        Surfaces fixed in all directions.
    guided : tuple of sequences of str
        Surfaces that fix the first, the second and the third component.
    """
    mesh = body.mesh
    tdim = mesh.topology.dim
    bs, count = space.dofmap.index_map_bs, space.dofmap.index_map.size_local
    held = np.zeros(owned(space), dtype=bool)
    for component in range(bs):
        facets = [body.facets(surface) for surface in clamped]
        facets += [body.facets(surface) for surface in guided[component]]
        if kinematics.vanishes_on_axis(component):
            facets.append(dmesh.locate_entities_boundary(mesh, tdim - 1, kinematics.on_axis))
        nodes = fem.locate_dofs_topological(
            space, tdim - 1, np.unique(np.concatenate(facets)).astype(np.int32)
        )
        held[nodes[nodes < count] * bs + component] = True
    return held

"""Linear elasticity of the bodies, with thermal strain."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp
from dolfinx import fem
from dolfinx import mesh as dmesh

from ..bodies import Bodies
from ..body_mesh import BodyMesh
from ..compiled import surface_area
from ..direct_solver import eliminate
from ..field import owned, without_fixed
from ..joints.joint import NO_JOINTS, Joints
from ..kinematics import Kinematics
from ..solver_choice import SolverChoice
from ..spaces import Rows, Spaces, block_diagonal, lagrange_spaces
from .elastic_body import ElasticBody, ElasticForms, ElasticMaterial
from .elastic_group import ElasticGroup, elastic_group
from .thermal_forces import ThermalForces


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
        Joints of glued bodies in the displacement spaces, see `contact.ties.joints`.
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

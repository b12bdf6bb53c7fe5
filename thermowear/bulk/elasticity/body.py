"""Linear elasticity of one body: forms and stiffness.

Linear tetrahedra are far too stiff in bending, which quadratic ones are not: as a coarse level
below these they would correct thin parts too little. With smoothed strains they bend freely.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp
import ufl
from dolfinx import default_scalar_type, fem

from ..bodies import BodyMesh
from ..compiled import assembled_matrix
from ..kinematics import Kinematics, section_measure

_CHUNK = 20_000
"""Number of patches whose products are formed at once."""
_MORE = 60
"""Room for the nodes of other ranks in a row: more costs memory for a moment, less much time."""
_EDGES = 6
"""Edges of a tetrahedron."""
_SHEARS = (3, 0, 1), (4, 1, 2), (5, 0, 2)
"""Rows of the shear strains, and their directions."""


def edge_smoothed_stiffness(
    space: fem.FunctionSpace, lame: tuple[fem.Function, fem.Function]
) -> PETSc.Mat:
    """Assemble the stiffness of linear tetrahedra with edge-smoothed strains. Every rank calls.

    Each cell gives a sixth of its volume to each of its edges. The strain at an edge is the mean,
    by these volumes, over the cells of one material and of one rank.

    Parameters
    ----------
    space : dolfinx.fem.FunctionSpace
        Vector-valued space of linear elements.
    lame : tuple of dolfinx.fem.Function
        λ and μ, constant in each cell [Pa].

    Notes
    -----
    Cazes and Meschke, Int. J. Numer. Meth. Engng 94 (2013) 715.
    """
    topology, count = space.mesh.topology, space.mesh.topology.index_map(3).size_local
    corners = space.dofmap.list[:count]
    volumes, gradients = _cells(space.tabulate_dof_coordinates()[corners])
    topology.create_connectivity(3, 1)
    edges = topology.connectivity(3, 1).array.reshape(-1, _EDGES)[:count]
    constants = np.stack([f.x.array[f.function_space.dofmap.list[:count, 0]] for f in lame])
    materials, material = np.unique(constants, axis=1, return_inverse=True)
    patches, patch = np.unique(
        edges.astype(np.int64) * materials.shape[1] + material.reshape(-1, 1), return_inverse=True
    )
    shares = np.repeat(volumes / _EDGES, _EDGES)
    total = np.bincount(patch.ravel(), shares)
    of_patch = patch.ravel(), np.repeat(np.arange(count), _EDGES)
    mean = sp.csr_array((shares / total[of_patch[0]], of_patch), (len(patches), count))
    stiffness = _summed(mean, gradients, corners, total, materials[:, patches % materials.shape[1]])
    return _distributed(space, stiffness)


def _cells(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Volumes (c,) and gradients of the functions (c, 4, 3) of tetrahedra by corners (c, 4, 3)."""
    sides = corners[:, 1:] - corners[:, :1]
    others = np.linalg.inv(sides).transpose(0, 2, 1)
    gradients = np.concatenate([-others.sum(axis=1, keepdims=True), others], axis=1)
    return np.abs(np.linalg.det(sides)) / 6, gradients


def _summed(
    mean: sp.csr_array,
    gradients: np.ndarray,
    corners: np.ndarray,
    volumes: np.ndarray,
    lame: np.ndarray,
) -> sp.bsr_array:
    """Sum over patches of ``|V| B̄ᵀ C B̄`` with the mean strain operators B̄, in local nodes."""
    nodes, corner = int(corners.max(initial=-1)) + 1, np.arange(0, corners.size + 1, 4)
    operator = gradients.reshape(-1, 3, 1), corners.ravel(), corner
    gradient = sp.bsr_array(operator, shape=(3 * len(corners), nodes))
    total = sp.bsr_array((3 * nodes, 3 * nodes), blocksize=(3, 3))
    for first in range(0, mean.shape[0], _CHUNK):
        part = slice(first, first + _CHUNK)
        strain = _strain(_thrice(mean[part]) @ gradient)
        stress = _elasticity(volumes[part], lame[:, part]) @ strain
        total = total + strain.T @ stress
    return total


def _thrice(matrix: sp.csr_array) -> sp.bsr_array:
    """Matrix that acts on vectors (3,) as another one does on numbers."""
    blocks = matrix.data[:, None, None] * np.eye(3)
    shape = 3 * matrix.shape[0], 3 * matrix.shape[1]
    return sp.bsr_array((blocks, matrix.indices, matrix.indptr), shape=shape)


def _strain(gradients: sp.bsr_array) -> sp.bsr_array:
    """Strains (three normal ones, shear angles) of patches per displacement of the nodes."""
    blocks = np.zeros((len(gradients.data), 6, 3))
    for i in range(3):
        blocks[:, i, i] = gradients.data[:, i, 0]
    for row, i, j in _SHEARS:
        blocks[:, row, i], blocks[:, row, j] = gradients.data[:, j, 0], gradients.data[:, i, 0]
    shape = 2 * gradients.shape[0], 3 * gradients.shape[1]
    return sp.bsr_array((blocks, gradients.indices, gradients.indptr), shape=shape)


def _elasticity(volumes: np.ndarray, lame: np.ndarray) -> sp.bsr_array:
    """Stresses times volumes per strain, block by block."""
    λ, μ = lame
    blocks = np.zeros((len(volumes), 6, 6))
    blocks[:, :3, :3] = λ[:, None, None]
    axis = np.arange(6)
    blocks[:, axis, axis] += μ[:, None] * np.array([2, 2, 2, 1, 1, 1])
    blocks *= volumes[:, None, None]
    rows = np.arange(len(volumes) + 1)
    return sp.bsr_array((blocks, rows[:-1], rows))


def _distributed(space: fem.FunctionSpace, local: sp.bsr_array) -> PETSc.Mat:
    """Sum over ranks of matrices in local nodes. Every rank calls."""
    nodes = space.dofmap.index_map
    owned, every = nodes.size_local, nodes.size_local + nodes.num_ghosts
    rows = np.repeat(np.arange(local.shape[0] // 3), np.diff(local.indptr))
    inside = np.bincount(rows[local.indices < owned], minlength=every)[:owned]
    outside = np.bincount(rows[local.indices >= owned], minlength=every)[:owned]
    shared = np.diff(nodes.index_to_dest_ranks().offsets)[:owned] > 0  # others add to these rows
    for count, most in ((inside, owned), (outside, nodes.size_global - owned)):
        count[shared] = np.minimum(count[shared] + _MORE, most)
    matrix = PETSc.Mat().create(space.mesh.comm)
    matrix.setSizes([(3 * owned, 3 * nodes.size_global)] * 2, bsize=3)
    matrix.setType(PETSc.Mat.Type.AIJ)
    places = nodes.local_to_global(np.arange(every, dtype=np.int32)).astype(PETSc.IntType)
    matrix.setLGMap(PETSc.LGMap().create(places, bsize=3, comm=space.mesh.comm))
    entries = [np.repeat(3 * count, 3).astype(PETSc.IntType) for count in (inside, outside)]
    matrix.setPreallocationNNZ(tuple(entries))
    matrix.setOption(PETSc.Mat.Option.NEW_NONZERO_ALLOCATION_ERR, False)
    start = np.full(every + 1, local.indptr[-1], PETSc.IntType)
    start[: len(local.indptr)] = local.indptr
    indices = local.indices.astype(PETSc.IntType)
    matrix.setValuesBlockedLocalCSR(start, indices, local.data, addv=PETSc.InsertMode.ADD)
    matrix.assemble()
    return matrix


@dataclass(frozen=True)
class ElasticMaterial:
    """Isotropic material: Young's modulus [Pa], Poisson ratio, thermal expansion [1/K]."""

    young_modulus: float
    poisson_ratio: float
    expansion: float = 0.0


@dataclass(frozen=True)
class ElasticForms:
    """Forms of linear elasticity with thermal strain in one body.

    Attributes
    ----------
    body : BodyMesh
    kinematics : Kinematics
    lame : tuple of dolfinx.fem.Function
        λ, μ and thermal modulus times α of the model, constant on each part [Pa, Pa/K].
    """

    body: BodyMesh
    kinematics: Kinematics
    lame: tuple[fem.Function, fem.Function, fem.Function]

    def stress(self, u, rise=None):
        """Stress of a displacement and a temperature rise, 3 x 3 [Pa]."""
        λ, μ, m = self.lame
        ε = self.kinematics.strain(self.body.mesh, u)
        return self.kinematics.stress(ε, (λ, μ), 0.0 if rise is None else m * rise)

    def virtual_work(self, u, δu, measure: ufl.Measure):
        """Form of the virtual work of the stress of u on the strain of δu [J]."""
        mesh, (λ, μ, _) = self.body.mesh, self.lame
        ε, δε = self.kinematics.strain(mesh, u), self.kinematics.strain(mesh, δu)
        density = λ * ufl.tr(ε) * ufl.tr(δε) + 2 * μ * ufl.inner(ε, δε)
        return self.kinematics.integral(mesh, density, measure)

    def thermal_work(self, rise, δu, measure: ufl.Measure):
        """Form of the work of the thermal stress of a temperature rise on the strain of δu [J]."""
        mesh = self.body.mesh
        ε = self.kinematics.strain(mesh, δu)
        return self.kinematics.integral(mesh, self.lame[2] * rise * ufl.tr(ε), measure)

    def traction_work(self, surface: str, traction: np.ndarray) -> Callable:
        """Form of the work of a uniform traction (gdim,) [Pa], a function of displacement [J]."""
        value = np.asarray(traction, dtype=default_scalar_type)
        return self._work(surface, fem.Constant(self.body.mesh, value))

    def pressure_work(self, surface: str, pressure: float) -> Callable:
        """Form of the work of a pressure [Pa] along the inward normal; see `traction_work`."""
        mesh = self.body.mesh
        constant = fem.Constant(mesh, default_scalar_type(pressure))
        return self._work(surface, -constant * ufl.FacetNormal(mesh))

    def _work(self, surface: str, traction) -> Callable:
        mesh, measure = self.body.mesh, self.body.surface_measure(surface)
        return lambda δu: self.kinematics.integral(mesh, ufl.inner(traction, δu), measure)

    def stiffness(self, space: fem.FunctionSpace, blocked: bool = False) -> PETSc.Mat:
        """Stiffness without supports in a space, see `assembled_matrix`. Every rank calls."""
        u, δu = ufl.TrialFunction(space), ufl.TestFunction(space)
        measure = section_measure(self.body.mesh, space.ufl_element().degree)
        work = self.virtual_work(u, δu, measure)
        return assembled_matrix(work, blocked=blocked)

    def coarse_stiffness(self, linear: fem.FunctionSpace, degree: int) -> PETSc.Mat:
        """Stiffness without supports of linear elements, as a coarse level below others.

        Parameters
        ----------
        linear : dolfinx.fem.FunctionSpace
        degree : int
            Degree of the finer ones; above one, tetrahedra have smoothed strains.
        """
        if degree > 1 and self.body.cell_type == "tetrahedron":
            return edge_smoothed_stiffness(linear, self.lame[:2])
        return self.stiffness(linear)

    def load_of_rises(self, rises: fem.FunctionSpace, space: fem.FunctionSpace, only: str | None):
        """Bilinear form of `thermal_work`, of the part `only` or of all."""
        rise, δu = ufl.TrialFunction(rises), ufl.TestFunction(space)
        if only is not None:
            rise = self.body.per_part({only: 1.0}) * rise
        measure = section_measure(self.body.mesh, rises.ufl_element().degree)
        return self.thermal_work(rise, δu, measure)

    @cached_property
    def least_compressibility(self) -> float:
        """Smallest ``1 - 2 ν = μ / (λ + μ)`` in the cells of this rank."""
        λ, μ, _ = (constant.x.array for constant in self.lame)
        return float((μ / (λ + μ)).min(initial=1.0))


@dataclass(frozen=True)
class ElasticBody(ElasticForms):
    """Elasticity of one body in its displacement space.

    Attributes
    ----------
    space : dolfinx.fem.FunctionSpace
        Displacement space [m].
    fixed : ndarray of bool, shape (n_owned,)
        Mask of values held at zero.
    """

    space: fem.FunctionSpace
    fixed: np.ndarray

"""Traces of the bodies on the contact, and static condensation to its points.

Stored transposed and distributed by owned rows, as nodal loads are: column j holds the shape
functions of the facet of one side at contact point j. All others of its cell vanish there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

from petsc4py import PETSc

import basix
import numpy as np
import scipy.sparse as sp
from dolfinx import fem

from ...bulk.elasticity.elasticity import Elasticity, ThermalForces
from ...bulk.heat.conduction import Conduction
from ...bulk.spaces import Spaces, basis_element, distributed
from ...lagrange import tabulated
from ...parallel import sum_over_ranks
from ..search.pairing import Contacts, PairedFace, Pairing
from .exchange_matrix import NodalResponses, nodes_by_group
from .heat_exchange import FaceHeat, InterfaceHeat
from .pressure import Basis, PressureSpace, scaled
from .rigid_motion import RigidHolder
from .thermal_opening import DistortionRows, elastic_columns


def value_trace(spaces: Spaces, side: PairedFace, component: int = 0) -> sp.csr_matrix:
    """Transposed trace Eᵀ of one component: shape (n_owned, n_points). Every rank calls.

    ``E v`` are the values of a field, or of one of its components, at the points of one side.
    """
    index = side.face.body
    nodes, point, values = _local_values(spaces.each[index], side)
    rows = nodes * spaces.components + component
    return gather_rows(spaces, index, rows, point, values, len(side.t))


def face_traces(spaces: Spaces, contacts: Contacts) -> tuple[sp.csr_matrix, sp.csr_matrix]:
    """Traces Eᵀ of the first and of the second faces of all contacts, see `value_trace`."""
    first, second = (
        sp.hstack([value_trace(spaces, pairing.sides[side]) for pairing in contacts.each]).tocsr()
        for side in (0, 1)
    )
    return first, second


def gap_trace(spaces: Spaces, contacts: Contacts) -> sp.csr_matrix:
    """Transposed gap trace Bᵀ of vector spaces: shape (n_owned, n_points). Every rank calls.

    ``B u = (u2 - u1)·n``, see `pairing` for the sign.
    """
    return vector_trace(spaces, contacts, contacts.normals)


def vector_trace(spaces: Spaces, contacts: Contacts, directions: np.ndarray) -> sp.csr_matrix:
    """Transposed trace of ``(u2 - u1)·e``: shape (n_owned, n_points). Every rank calls.

    Parameters
    ----------
    spaces : Spaces
        Vector spaces.
    contacts : Contacts
    directions : ndarray, shape (n_points, gdim)
        Direction e at each point; not necessarily a unit vector (traction of sliding contact).
    """
    return in_directions(component_traces(spaces, contacts), directions)


def in_directions(components: Sequence[sp.csr_matrix], directions: np.ndarray) -> sp.csr_matrix:
    """`vector_trace` from `component_traces`."""
    along = zip(components, directions.T, strict=True)
    return sum((sp.csr_matrix(one.multiply(part)) for one, part in along), start=0).tocsr()


def component_traces(spaces: Spaces, contacts: Contacts) -> list[sp.csr_matrix]:
    """Traces as in `vector_trace` along each coordinate."""
    each = [_component_traces(spaces, pairing) for pairing in contacts.each]
    if len(each) == 1:
        return each[0]
    return [sp.hstack(one).tocsr() for one in zip(*each, strict=True)]


def _component_traces(spaces: Spaces, pairing: Pairing) -> list[sp.csr_matrix]:
    count, width = len(pairing.weights), spaces.components
    result = [sp.csr_matrix((spaces.owned, count))] * width
    for sign, side in zip((-1.0, 1.0), pairing.sides, strict=True):
        index = side.face.body
        nodes, point, values = _local_values(spaces.each[index], side)
        for component in range(width):
            dofs = nodes * width + component
            added = gather_rows(spaces, index, dofs, point, sign * values, count)
            result[component] = result[component] + added
    return result


def _local_values(space: fem.FunctionSpace, side: PairedFace):
    """Local nodes on the facets, points and basis values at the points whose cell this rank owns.

    Of the values of a cell those of nodes off the facet vanish, and are left out.
    """
    mesh = space.mesh
    mine = np.flatnonzero(side.face.rank[side.facet] == mesh.comm.rank)
    element = basis_element(space)
    reference = reference_points(side, mine, element.cell_type)
    values = tabulated(element, reference)[0]
    cells = side.face.cell[side.facet[mine]]
    if not element.dof_transformations_are_permutations:  # permutations are part of the dofmap
        values = _oriented(mesh, element, cells, values)
    on_facet = np.array(element.entity_closure_dofs[-2])[side.face.local_facet[side.facet[mine]]]
    nodes = np.take_along_axis(space.dofmap.list[cells].astype(np.int64), on_facet, axis=1)
    values = np.take_along_axis(values, on_facet, axis=1)
    point = np.repeat(mine, nodes.shape[1])
    return nodes.ravel(), point, values.ravel()


def _oriented(mesh, element, cells: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Reference basis values, one row per point, transformed to the orientation of the cells."""
    mesh.topology.create_entity_permutations()
    orientation = mesh.topology.get_cell_permutation_info()[cells]
    result = np.empty_like(values)
    for kind in np.unique(orientation):
        chosen = orientation == kind
        turned = np.ascontiguousarray(values[chosen].T)
        element.T_apply(turned.reshape(-1), turned.shape[1], int(kind))
        result[chosen] = turned.T
    return result


def reference_points(side: PairedFace, chosen: np.ndarray, cell_type) -> np.ndarray:
    """Reference coordinates of points on facets of their cells."""
    corners, facets = np.asarray(basix.geometry(cell_type)), np.array(basix.topology(cell_type)[-2])
    facet = side.facet[chosen]
    first, *others = np.moveaxis(corners[facets[side.face.local_facet[facet]]], 1, 0)
    reference = first.copy()
    for t, other in zip(side.face.in_cell(facet, side.t[chosen]).T, others, strict=False):
        reference += t[:, None] * (other - first)
    return reference


def gather_rows(spaces: Spaces, index: int, rows, columns, values, n_points: int) -> sp.csr_matrix:
    """Sum entries of all ranks into the owned rows of each rank; shape (n_owned, n_points).

    Rows are local dof numbers of the body with an index. Every rank calls.
    """
    space = spaces.each[index]
    comm, bs, index_map = space.mesh.comm, space.dofmap.index_map_bs, space.dofmap.index_map
    nodes = index_map.local_to_global((rows // bs).astype(np.int32))
    rows = nodes * bs + rows % bs
    first = index_map.local_range[0] * bs
    if comm.size > 1:
        starts = np.array(comm.allgather(first))
        owner = np.searchsorted(starts, rows, side="right") - 1
        parcels = [
            tuple(part[owner == rank] for part in (rows, columns, values))
            for rank in range(comm.size)
        ]
        received = comm.alltoall(parcels)
        rows, columns, values = (np.concatenate([part[k] for part in received]) for k in range(3))
    shape = (index_map.size_local * bs, n_points)
    own = sp.coo_matrix((values, (rows - first, columns)), shape=shape)
    return spaces.placed(spaces.rows(index), own.tocsr())


@dataclass(frozen=True)
class CondensedContact(PressureSpace):
    """Condensed elastic bodies: weak gap as a function of the pressure.

    The weak gap is ``Ψᵀ w (g0 + W) + A λ - Rw d`` (+ thermal distortion).

    Attributes
    ----------
    compliance : ndarray, shape (m, m)
        A = Ψᵀ w B K⁻¹ B_tᵗ w Ψ [m⁵/N = weak gap per coefficient].
    modes : ndarray, shape (m, k)
        Rw = Ψᵀ w R: weak gap closed per unit of each free rigid motion of the holder.
    force_modes : ndarray, shape (m, k)
        Ψᵀ w T: generalised force of each coefficient on each of these motions.
    """

    compliance: np.ndarray
    modes: np.ndarray
    force_modes: np.ndarray


@dataclass(frozen=True)
class Influence(PressureSpace):
    """Elastic response to each pressure function: the solutions that condensation needs.

    Independent of loads, friction and wear.

    Attributes
    ----------
    trace : csr_matrix, shape (n_owned, n)
        Transposed gap trace Bᵀ.
    touching : ndarray of int, shape (n_touching,)
        Owned degrees of freedom of the faces, the only ones loaded by contact tractions.
    near : ndarray, shape (n_touching, m)
        Rows of K⁻¹ Bᵗ w Ψ for these [m per coefficient].
    per_rise : tuple of ndarray, shape (n_owned of the temperature, m)
        Gᵀ K⁻¹ Bᵗ w Ψ for each thermal load matrix G: weak gap per nodal rise [m³/K]; empty if they
        are not stored, see `thermal_opening`.
    comm : mpi4py.MPI.Comm
    """

    trace: sp.csr_matrix
    touching: np.ndarray
    near: np.ndarray
    per_rise: tuple[np.ndarray, ...]
    comm: object

    def condensed(self, traction: sp.csr_matrix, holder: RigidHolder) -> CondensedContact:
        """Condensed contact for a friction and a holder, without elastic solution; collective.

        Parameters
        ----------
        traction : csr_matrix, shape (n_owned, n)
            B_tᵀ; the gap trace itself if there is no friction in the section.
        holder : RigidHolder
        """
        pulls = traction[self.touching] @ sp.csr_matrix(self.weighted)
        compliance = sum_over_ranks(self.comm, (pulls.T @ self.near).T)
        if traction is self.trace:
            compliance = (compliance + compliance.T) / 2
        modes, force_modes = self.weak(holder.modes), self.weak(holder.force_modes)
        return CondensedContact(self.basis, self.weighted, compliance, modes, force_modes)


def influence(
    elastic: Elasticity,
    weights: np.ndarray,
    trace: sp.csr_matrix,
    basis: Basis,
    thermal_loads: Sequence[ThermalForces] = (),
    distortion: DistortionRows | None = None,
) -> Influence:
    """Compute the elastic response to every pressure function. Every rank calls.

    Solutions are reduced block by block: only rows at the contact are stored, and products with
    the thermal loads, or with `distortion` only what remains of them there.

    Parameters
    ----------
    elastic : Elasticity
    weights : ndarray, shape (n,)
        Areas of the contact points [m²].
    trace : csr_matrix, shape (n_owned, n)
        Transposed gap trace Bᵀ.
    basis : ndarray or csr_array, shape (n, m)
        Ψ, from `pressure.pressure_basis`.
    thermal_loads : sequence of ThermalForces
        Matrices G of nodal forces per nodal rise, from `Elasticity.thermal_load`.
    distortion : DistortionRows, optional
        Receives the weak gap per nodal rise of the first of them, which is not stored.
    """
    dim = elastic.bodies.dim
    weighted = scaled(weights, basis)
    loads = pressure_loads(trace, weighted)
    nodes = np.unique(np.flatnonzero(np.diff(trace.indptr)) // dim)
    touching = (nodes[:, None] * dim + np.arange(dim)).ravel()
    near = np.zeros((len(touching), loads.shape[1]))
    kept, used = (thermal_loads,) * 2 if distortion is None else ((), thermal_loads[:1])
    per_rise = [np.zeros((G.columns.owned, loads.shape[1]), order="F") for G in kept]
    spaces = elastic.spaces
    body = np.searchsorted(spaces.starts, touching, side="right") - 1
    for found in elastic_columns(elastic, loads, used):
        bodies = spaces.groups[found.group]
        inside = np.flatnonzero(np.isin(body, bodies))
        rows = spaces.within(found.group, touching[inside])
        columns = np.r_[found.columns]
        near[np.ix_(inside, columns)] = found.displacements[rows]
        for matrix, products, product in zip(kept, per_rise, found.per_rise, strict=False):
            products[np.ix_(np.r_[matrix.columns.rows(*bodies)], columns)] = product
        if distortion is not None:
            distortion.add(found.group, found.columns, found.per_rise[0])
    comm = elastic.bodies.comm
    return Influence(basis, weighted, trace, touching, near, tuple(per_rise), comm)


def pressure_loads(trace: sp.csr_matrix, weighted: Basis) -> sp.csc_matrix:
    """Nodal loads Bᵗ w Ψ of the pressure functions, shape (n_owned, m)."""
    return (trace @ sp.csr_matrix(weighted)).tocsc()


def condense(
    elastic: Elasticity,
    weights: np.ndarray,
    trace: sp.csr_matrix,
    traction: sp.csr_matrix,
    basis: Basis,
    holder: RigidHolder,
) -> CondensedContact:
    """Condense elasticity to the pressure space; parameters as in `influence` and `Influence`.

    Every rank calls.
    """
    return influence(elastic, weights, trace, basis).condensed(traction, holder)


def condense_heat(conduction: Conduction, face: FaceHeat) -> InterfaceHeat:
    """Condense conduction to the nodes of the contact faces.

    The solutions follow when they are first needed, see `NodalResponses`. Every rank calls.
    """
    nodes = nodes_by_group(conduction.spaces, face.traces)
    responses = NodalResponses(conduction, nodes)
    at_points: dict[str, Any] = {f.name: getattr(face, f.name) for f in fields(FaceHeat)}
    return InterfaceHeat(**at_points, nodes=nodes, responses=responses)


def bath_matrix(
    spaces: Spaces, traces, weights: np.ndarray, shifts: tuple[np.ndarray, np.ndarray]
) -> PETSc.Mat:
    """Matrix ``Σ E_iᵀ w s_i E_i`` of the bath at the faces, for `bulk.conduction`; collective."""
    faces = zip(traces, shifts, strict=True)
    first, second = (transfer_matrix(spaces, trace, weights * shift) for trace, shift in faces)
    first.axpy(1.0, second, PETSc.Mat.Structure.DIFFERENT_NONZERO_PATTERN)
    return first


def transfer_matrix(spaces: Spaces, trace: sp.csr_matrix, sizes: np.ndarray) -> PETSc.Mat:
    """Matrix ``Eᵀ diag(sizes) E`` of a transposed trace Eᵀ and sizes (n,) >= 0; collective."""
    root = distributed(spaces, (trace @ sp.diags(np.sqrt(sizes))).tocsr())
    return root.matMult(root.copy().transpose())

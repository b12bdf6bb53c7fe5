"""Trace operators: from nodal values of a body to values at the contact points.

Stored transposed and distributed by owned rows, as nodal loads are: column j holds the shape
functions of the facet of one side at contact point j. All others of its cell vanish there.
"""

from __future__ import annotations

import basix
import numpy as np
import scipy.sparse as sp
from dolfinx import fem

from ...bulk.field import basis_element
from ...bulk.spaces import Spaces
from ...lagrange import tabulated
from ..search.contacts import Contacts
from ..search.pairing import PairedFace, Pairing


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
    each = [_vector_trace(spaces, pairing, directions[points]) for pairing, points in contacts]
    return each[0] if len(each) == 1 else sp.hstack(each).tocsr()


def _vector_trace(spaces: Spaces, pairing: Pairing, directions: np.ndarray) -> sp.csr_matrix:
    count, width = len(pairing.weights), spaces.components
    result = sp.csr_matrix((spaces.owned, count))
    for sign, side in zip((-1.0, 1.0), pairing.sides, strict=True):
        index = side.face.body
        nodes, point, values = _local_values(spaces.each[index], side)
        for component in range(width):
            scaled = sign * directions[point, component] * values
            dofs = nodes * width + component
            result = result + gather_rows(spaces, index, dofs, point, scaled, count)
    return result.tocsr()


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

"""Transfer of fields from the mesh of a model to the user's mesh of one body."""

from __future__ import annotations

import numpy as np
from dolfinx import fem

from ..bulk.field import as_function, basis_element, lagrange_space
from ..errors import CaseError
from ..lagrange import matching
from ..simulation.system.system import System
from .body import MeshBody
from .user_mesh import UserMeshes


def on_user_mesh(
    meshes: UserMeshes,
    bodies: tuple[MeshBody, ...],
    index: int,
    system: System,
    space: fem.FunctionSpace,
    values: np.ndarray,
    name: str,
) -> fem.Function:
    """Function on the user's mesh of a body, NaN outside of the body. Every rank calls.

    Nodal values are copied cell by cell: cells have the same nodes in both meshes, apart from those
    whose orientation was reversed.

    Parameters
    ----------
    meshes : UserMeshes
    bodies : tuple of MeshBody
        The held body first.
    index : int
        Index of the body.
    system : System
    space : dolfinx.fem.FunctionSpace
        Space on the mesh of the system.
    values : ndarray, shape (n_owned,)
    name : str

    Raises
    ------
    CaseError
        If the body has been remeshed.
    """
    body = bodies[index]
    if system.worn is not None and system.worn.meshed_anew:
        raise CaseError(f"{name}: {body.name!r} has been remeshed; its field has no user mesh")
    first = sum(len(mask) for mask in meshes.reversed_cells[:index])
    reversed_cells = meshes.reversed_cells[index]
    by_cell = _by_cell(space, as_function(space, values, name))
    by_cell = by_cell[first : first + len(reversed_cells)]
    nodes = basis_element(space).points
    if reversed_cells.any():
        by_cell[reversed_cells] = by_cell[reversed_cells][:, matching(nodes[:, ::-1], nodes)]
    return _placed(body, by_cell, space.ufl_element().degree, name)


def _by_cell(space: fem.FunctionSpace, function: fem.Function) -> np.ndarray:
    """Nodal values of all cells on all ranks, in the order of the tagged mesh.

    Shape (n_cells, nodes_per_cell, components).
    """
    mesh = space.mesh
    count = mesh.topology.index_map(mesh.topology.dim).size_local
    nodal = function.x.array.reshape(-1, space.dofmap.index_map_bs)
    own = mesh.topology.original_cell_index[:count], nodal[space.dofmap.list[:count]]
    number, values = (np.concatenate(each) for each in zip(*mesh.comm.allgather(own), strict=True))
    return values[np.argsort(number)]


def _placed(body: MeshBody, by_cell: np.ndarray, degree: int, name: str) -> fem.Function:
    """Function on a user's mesh from nodal values of the body's cells, in their global order."""
    mesh, components = body.mesh, by_cell.shape[2]
    cells = mesh.topology.index_map(mesh.topology.dim)
    number = cells.local_to_global(np.arange(cells.size_local + cells.num_ghosts, dtype=np.int32))
    own = number[np.flatnonzero(body.part_of_cells() >= 0)]
    row = np.full(cells.size_global, -1)
    row[np.concatenate(mesh.comm.allgather(own))] = np.arange(len(by_cell))
    local = np.flatnonzero(row[number] >= 0)
    width = 0 if components == 1 else mesh.geometry.dim
    space = lagrange_space(mesh, degree, width)
    result = fem.Function(space, name=name)
    nodal = np.full((len(result.x.array) // max(width, 1), max(width, 1)), np.nan)
    dofs = space.dofmap.list[local]
    nodal[dofs] = 0.0  # out of plane, in a section embedded in space
    nodal[dofs, :components] = by_cell[row[number[local]]]
    result.x.array[:] = nodal.ravel()
    result.x.scatter_forward()
    return result

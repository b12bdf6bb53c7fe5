"""Transfer of a field to another mesh of the same bodies, moved slightly or remeshed."""

from __future__ import annotations

import numpy as np
from dolfinx import fem

from ..compat import geometry_dofmap
from .bodies import Bodies
from .body_mesh import BodyMesh
from .field import as_function
from .points.cell_search import CellSearch, CellValues
from .spaces import Spaces


def transferred(
    values: np.ndarray,
    old: Spaces,
    new: Spaces,
    old_bodies: Bodies,
    new_bodies: Bodies,
) -> tuple[np.ndarray, float]:
    """Interpolate a scalar field to the nodes of another mesh, body by body. Every rank calls.

    Parameters
    ----------
    values : ndarray, shape (n_owned,)
        Nodal values of the field.
    old, new : Spaces
        Spaces of equal degree on meshes of the same cell types.
    old_bodies, new_bodies : Bodies

    Returns
    -------
    values : ndarray, shape (n_owned,)
        Field at the nodes of the new space.
    error : float
        Largest difference of the two fields at a point between the nodes of each new cell.
    """
    parts = zip(
        old.functions(values, "field"), new.each, old_bodies.each, new_bodies.each, strict=True
    )
    found = [_transferred(*each) for each in parts]
    return np.concatenate([values for values, _ in found]), max(error for _, error in found)


def _transferred(
    function: fem.Function, new: fem.FunctionSpace, old_body: BodyMesh, new_body: BodyMesh
) -> tuple[np.ndarray, float]:
    """Interpolate a field to the nodes of another mesh of one body; see `transferred`."""
    old, values = function.function_space, function.x.array
    count, gdim = new.dofmap.index_map.size_local, old.mesh.geometry.dim
    result, stays = np.zeros(count), np.zeros(count, dtype=bool)
    places = new.tabulate_dof_coordinates()[:count, :gdim]
    unchanged = np.array_equal(old.dofmap.list, new.dofmap.list)
    if all(new.mesh.comm.allgather(unchanged)):  # the meshes differ in node positions only
        stays = np.all(places == old.tabulate_dof_coordinates()[:count, :gdim], axis=1)
        result[stays] = values[:count][stays]
    field, cells = CellSearch(old.mesh, old.ufl_element().degree), _gathered(old_body, function)
    nodes = np.flatnonzero(~stays)
    result[nodes] = field.at(cells, places[nodes])
    at, found = field.between_nodes(_gathered(new_body, as_function(new, result, "field")))
    return result, float(np.abs(field.at(cells, at) - found).max(initial=0.0))


def _gathered(body: BodyMesh, function: fem.Function) -> CellValues:
    """Gather the cells of a body and a field in them from all ranks."""
    mesh, count = body.mesh, body.n_cells
    nodes = mesh.geometry.x[geometry_dofmap(mesh)[:count]][..., : mesh.geometry.dim]
    values = function.x.array[function.function_space.dofmap.list[:count]]
    gathered = mesh.comm.allgather((nodes, values))
    return CellValues(*(np.concatenate([part[k] for part in gathered]) for k in (0, 1)))

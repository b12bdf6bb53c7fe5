"""Function spaces, and fields as plain arrays of the values owned by a rank."""

from __future__ import annotations

import basix
import basix.ufl
import numpy as np
import scipy.sparse as sp
from dolfinx import fem

from ..compat import coordinate_element


def lagrange_space(mesh, degree: int, components: int = 0) -> fem.FunctionSpace:
    """Continuous Lagrange space (Gauss-Lobatto-Legendre warped nodes), scalar or vector-valued."""
    shape = (components,) if components else None
    element = basix.ufl.element("Lagrange", mesh.basix_cell(), degree, shape=shape)
    return fem.functionspace(mesh, element)


def geometry_space(mesh) -> fem.FunctionSpace:
    """Continuous scalar space whose nodes are the points of the mesh."""
    element = basix.ufl.element(
        "Lagrange",
        mesh.basix_cell(),
        coordinate_element(mesh).degree,
        lagrange_variant=basix.LagrangeVariant.equispaced,
    )
    return fem.functionspace(mesh, element)


def reference_element(mesh, degree: int):
    """Scalar basix element of `lagrange_space`, for tabulation."""
    cell = mesh.basix_cell()
    cell = basix.CellType[cell] if isinstance(cell, str) else cell
    return basix.create_element(
        basix.ElementFamily.P, cell, degree, basix.LagrangeVariant.gll_warped
    )


def basis_element(space: fem.FunctionSpace):
    """Scalar basix element of a scalar or vector-valued space, for tabulation."""
    element = space.ufl_element()
    return (element.sub_elements[0] if space.dofmap.index_map_bs > 1 else element).basix_element


def owned(space: fem.FunctionSpace) -> int:
    """Number of values owned by this rank."""
    return space.dofmap.index_map.size_local * space.dofmap.index_map_bs


def as_function(space: fem.FunctionSpace, values: np.ndarray, name: str) -> fem.Function:
    """Create a dolfinx function from owned values. Every rank calls."""
    function = fem.Function(space, name=name)
    function.x.array[: len(values)] = values
    function.x.scatter_forward()
    return function


def without_fixed(loads, fixed: np.ndarray):
    """Copy of dense or sparse loads, (n_owned,) or (n_owned, m), with zeros in the fixed rows."""
    if sp.issparse(loads):
        return (sp.diags(~fixed, dtype=float) @ loads).tocsr()
    result = np.array(loads, dtype=float)
    result[fixed] = 0.0
    return result

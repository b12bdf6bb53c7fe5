"""Differences between dolfinx 0.9 and 0.11, all in this module.

Each function tests for a feature, not for a version.
"""

from __future__ import annotations

import inspect

import numpy as np
from dolfinx import fem


def geometry_dofmap(mesh) -> np.ndarray:
    """Geometry nodes of each cell, shape (n_cells, nodes_per_cell)."""
    geometry = mesh.geometry
    return geometry.dofmaps[0] if hasattr(geometry, "dofmaps") else geometry.dofmap


def coordinate_element(mesh):
    """Coordinate element of the (single) cell type of a mesh."""
    geometry = mesh.geometry
    return geometry.cmaps[0] if hasattr(geometry, "cmaps") else geometry.cmap


def evaluate(expression: fem.Expression, mesh, cells: np.ndarray) -> np.ndarray:
    """Values of an expression at its points in cells, shape (n_cells, n_points, value_size)."""
    values = expression.eval(mesh, np.asarray(cells, dtype=np.int32))
    size = int(np.prod(expression.ufl_expression.ufl_shape))  # a rank may own no cell
    return values.reshape(len(cells), len(expression.X()), size)


def exterior_facet_domain(mesh, facets: np.ndarray) -> np.ndarray:
    """Integration entities (cell, local facet) of the facets that lie on the boundary."""
    needs_dim = "dim" in inspect.signature(fem.compute_integration_domains).parameters
    dim = (mesh.topology.dim - 1,) if needs_dim else ()
    return fem.compute_integration_domains(
        fem.IntegralType.exterior_facet, mesh.topology, np.sort(facets), *dim
    )

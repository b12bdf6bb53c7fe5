"""Areas and shapes of curved cells, and moved meshes, for tests of meshes."""

from __future__ import annotations

import numpy as np

from thermowear.bulk.mesh_motion import serial_extension
from thermowear.geometry.mesh.nodes import reference_nodes


def _powers(order: int, triangle: bool) -> list[tuple[int, int]]:
    n = range(order + 1)
    return [(i, j) for i in n for j in n if not triangle or i + j <= order]


def _polynomials(mesh, x, y):
    """Lagrange polynomials and their slopes along both directions, (n_points, n_nodes) each."""
    triangle = mesh.cell_type == "triangle"
    order = mesh.facets.shape[1] - 1
    nodes = reference_nodes(mesh.cell_type, order)
    powers = _powers(order, triangle)
    matrix = np.stack([nodes[:, 0] ** i * nodes[:, 1] ** j for i, j in powers], axis=1)
    inverse = np.linalg.inv(matrix)
    values = np.stack([x**i * y**j for i, j in powers], axis=1)
    along = np.stack([i * x ** max(i - 1, 0) * y**j for i, j in powers], axis=1)
    across = np.stack([j * x**i * y ** max(j - 1, 0) for i, j in powers], axis=1)
    return values @ inverse, along @ inverse, across @ inverse


def _tangents(mesh, x, y):
    """Derivatives of the coordinates along both reference directions, (n_cells, n_points, 2)."""
    places = mesh.points[mesh.cells]
    return tuple(
        np.einsum("qk,nki->nqi", slopes, places) for slopes in _polynomials(mesh, x, y)[1:]
    )


def _determinants(tangents):
    a, b = tangents
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _rule(triangle: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points x, y and weights of a quadrature rule."""
    t, w = np.polynomial.legendre.leggauss(8)
    t, w = (t + 1) / 2, w / 2
    x, y = (v.ravel() for v in np.meshgrid(t, t, indexing="ij"))
    weights = np.outer(w, w).ravel()
    return (x, y * (1 - x), weights * (1 - x)) if triangle else (x, y, weights)


def areas(mesh, body: str) -> np.ndarray:
    """Area of each cell of a body, by quadrature that is exact for its polynomial [m²]."""
    x, y, weights = _rule(mesh.cell_type == "triangle")
    cells = mesh.cell_tags == mesh.bodies.index(body) + 1
    return _determinants(_tangents(mesh, x, y))[cells] @ weights


def volume(mesh, body: str, factor) -> float:
    """Volume of a plane body, with a factor from area to volume at points (n, 2) [m³]."""
    x, y, weights = _rule(mesh.cell_type == "triangle")
    cells = mesh.cell_tags == mesh.bodies.index(body) + 1
    values, _, _ = _polynomials(mesh, x, y)
    points = np.einsum("qk,nki->nqi", values, mesh.points[mesh.cells])[cells]
    sizes = _determinants(_tangents(mesh, x, y))[cells] * weights
    return float(sizes.ravel() @ factor(points.reshape(-1, 2)))


def followed(mesh, outlined) -> np.ndarray:
    """Points of a mesh whose boundary has been displaced [m]."""
    return mesh.points + serial_extension(mesh, mesh.cell_type, mesh.cells)(outlined)


def scaled_jacobians(mesh) -> np.ndarray:
    """Smallest sine of the angle between the grid lines of each cell, negative if inverted."""
    x, y = (v.ravel() for v in np.meshgrid(*[np.linspace(0, 1, 7)] * 2))
    if mesh.cell_type == "triangle":
        x, y = x[x + y < 1.01], y[x + y < 1.01]
    tangents = _tangents(mesh, x, y)
    lengths = np.prod([np.linalg.norm(v, axis=2) for v in tangents], axis=0)
    return (_determinants(tangents) / lengths).min(axis=1)


def dofs(mesh, degree: int) -> int:
    """Displacements of a mesh of quadrilaterals."""
    sides = np.concatenate([mesh.cells[:, [i, (i + 1) % 4]] for i in range(4)])
    edges = len(np.unique(np.sort(sides, axis=1), axis=0))
    corners = len(np.unique(mesh.cells[:, :4]))
    return 2 * (corners + edges * (degree - 1) + len(mesh.cells) * (degree - 1) ** 2)


def edges(mesh, surface: str) -> np.ndarray:
    """Nodes of the facets of a surface, shape (n_facets, order + 1, 2) [m]."""
    return mesh.points[mesh.facets[mesh.facet_tags == mesh.surfaces.index(surface) + 1]]


def ends(mesh, surface: str) -> np.ndarray:
    """x at the ends of the elements of a surface, increasing [m]."""
    return np.unique(np.round(edges(mesh, surface)[:, :2, 0], 12))


def unnamed(mesh) -> int:
    """Boundary edges that belong to no surface."""
    n = 4 if mesh.cell_type == "quadrilateral" else 3
    sides = np.concatenate([mesh.cells[:, [i, (i + 1) % n]] for i in range(n)])
    _, count = np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)
    return int((count == 1).sum()) - len(mesh.facets)


def volumes(mesh, body: str) -> np.ndarray:
    """Volume of each cell of a body in space, by quadrature exact for its polynomial [m³]."""
    order = mesh.order
    t, w = np.polynomial.legendre.leggauss(6)
    places = np.stack(np.meshgrid(*[(t + 1) / 2] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    weights = np.einsum("i,j,k->ijk", w, w, w).ravel() / 8
    powers = np.array(
        [(i, j, k) for i in range(order + 1) for j in range(order + 1) for k in range(order + 1)]
    )
    if mesh.cell_type == "tetrahedron":
        powers = powers[powers.sum(axis=1) <= order]
        a, b, c = places.T  # Duffy's map of the cube
        weights = weights * (1 - a) ** 2 * (1 - b)
        places = np.stack([a, b * (1 - a), c * (1 - a) * (1 - b)], axis=1)
    nodes = reference_nodes(mesh.cell_type, order)
    inverse = np.linalg.inv(np.prod(nodes[:, None] ** powers, axis=2))
    slopes = [
        powers[:, a]
        * np.prod(places[:, None] ** np.maximum(powers - np.eye(3, dtype=int)[a], 0), axis=2)
        for a in range(3)
    ]
    cells = mesh.points[mesh.cells[mesh.cell_tags == mesh.bodies.index(body) + 1]]
    a, b, c = (np.einsum("qk,nki->nqi", s @ inverse, cells) for s in slopes)
    return np.einsum("nqi,nqi->nq", np.cross(a, b), c) @ weights

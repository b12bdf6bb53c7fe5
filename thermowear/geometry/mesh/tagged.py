"""Tagged mesh, returned by every geometry and used by all later steps."""

from __future__ import annotations

import hashlib
import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from ...lagrange import order_of
from .nodes import FACETS, reference_nodes, shape_functions, slopes

_AT_ONCE = 2000
"""Number of cells evaluated together."""
_CORNERS = np.vstack([np.zeros(3), np.eye(3)])
"""Corners of the reference cell."""
_EDGES = list(itertools.combinations(range(4), 2))
_AT_CORNERS = [[k for k, edge in enumerate(_EDGES) if corner in edge] for corner in range(4)]
"""Edges that meet at each corner."""


def scaled_jacobians_of_tetrahedra(order: int, nodes: np.ndarray) -> np.ndarray:
    """Smallest scaled Jacobian of each tetrahedron, shape (n_cells,).

    ``√2 J / L`` with the determinant J of the map from the reference cell and the largest product L
    of the lengths of three tangents along the edges that meet at a corner: 1 for a regular
    tetrahedron (Knupp, Int. J. Numer. Meth. Engng 48 (2000) 1165). It is sampled on the lattice of
    the polynomial J of degree 3 (order - 1). The Bernstein coefficients of J bound it from below in
    between (Johnen, Remacle, Geuzaine, J. Comput. Phys. 233 (2013) 359): where one of them is not
    positive, the cell may be inverted, and it takes the place of the smallest J.

    Parameters
    ----------
    order : int
    nodes : ndarray, shape (n_cells, nodes_per_cell, 3)
        In gmsh's order [m].
    """
    places, to_bernstein = _lattice(3 * (order - 1))
    derivatives = slopes("tetrahedron", order, places)
    result = np.empty(len(nodes))
    for first in range(0, len(nodes), _AT_ONCE):
        some = slice(first, first + _AT_ONCE)
        maps = np.einsum("qdk,cki->cqdi", derivatives, nodes[some])
        determinants = np.einsum(
            "cqi,cqi->cq", np.cross(maps[:, :, 0], maps[:, :, 1]), maps[:, :, 2]
        )
        lengths = np.stack(
            [
                np.linalg.norm(np.einsum("d,cqdi->cqi", _CORNERS[b] - _CORNERS[a], maps), axis=2)
                for a, b in _EDGES
            ]
        )
        products = np.max([lengths[edges].prod(axis=0) for edges in _AT_CORNERS], axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):
            sampled = math.sqrt(2) * (determinants / products).min(axis=1)
            bound = (determinants @ to_bernstein.T).min(axis=1) / products.max(axis=1)
        result[some] = np.where(bound > 0.0, sampled, np.minimum(sampled, math.sqrt(2) * bound))
    return result


@cache
def _lattice(degree: int) -> tuple[np.ndarray, np.ndarray]:
    """Lattice points of polynomials of a degree, and the map from values there to Bernstein's."""
    powers = np.array(
        [p for p in itertools.product(range(degree + 1), repeat=4) if sum(p) == degree]
    )
    places = powers[:, 1:] / max(degree, 1)
    if degree == 0:
        return np.full((1, 3), 0.25), np.ones((1, 1))
    weights = np.column_stack([1 - places.sum(axis=1), places])
    binomials = [math.factorial(degree) / math.prod(map(math.factorial, p)) for p in powers]
    values = np.prod(weights[:, None] ** powers, axis=2) * binomials
    return places, np.linalg.inv(values)


_PLACES = {2: 7, 3: 4}
"""Points along each side of a plane or spatial cell at which its Jacobian is evaluated."""


@dataclass(frozen=True)
class TaggedMesh:
    """Two meshed bodies with named parts.

    Cells and facets are listed with the node order of gmsh. Tags are indices into the tuples of
    names, plus one (as gmsh's physical groups).

    Attributes
    ----------
    points : ndarray, shape (n_points, gdim) [m]
    cell_type : str
        ``"quadrilateral"`` or ``"triangle"``, in space ``"hexahedron"`` or ``"tetrahedron"``; the
        same for all cells.
    cells : ndarray of int64, shape (n_cells, nodes_per_cell)
        Nodes, of any order: curved cells have nodes between their corners.
    cell_tags : ndarray of int32, shape (n_cells,)
    facets : ndarray of int64, shape (n_facets, nodes_per_facet)
        Named boundary facets only.
    facet_tags : ndarray of int32, shape (n_facets,)
    bodies : tuple of str
        Names of the bodies, body 1 (held) first, then those of zones within bodies that have a
        material of their own: the cells of a zone are not tagged with the body.
    surfaces : tuple of str
        Names of the surfaces.
    """

    points: np.ndarray
    cell_type: str
    cells: np.ndarray
    cell_tags: np.ndarray
    facets: np.ndarray
    facet_tags: np.ndarray
    bodies: tuple[str, ...]
    surfaces: tuple[str, ...]

    @property
    def blocks(self) -> tuple[TaggedMesh, ...]:
        """Only this mesh, as its cells are of one type and order; see `mixed.MixedMesh`."""
        return (self,)

    @property
    def facet_type(self) -> str:
        """``"interval"``, in space ``"quadrilateral"`` or ``"triangle"``."""
        return FACETS[self.cell_type]

    @property
    def order(self) -> int:
        """Geometric order of the cells."""
        return order_of(self.facet_type, self.facets.shape[1])

    def checksum(self) -> str:
        """SHA-256 of the mesh, in hexadecimal digits."""
        arrays = (self.points, self.cells, self.cell_tags, self.facets, self.facet_tags)
        found = hashlib.sha256(repr((self.cell_type, self.bodies, self.surfaces)).encode())
        for values in arrays:
            found.update(repr((values.dtype.str, values.shape)).encode())
            found.update(np.ascontiguousarray(values).tobytes())
        return found.hexdigest()

    def tags_of(self, parts: Iterable[str]) -> list[int]:
        """Tags of the cells of some bodies or zones."""
        return [self.bodies.index(part) + 1 for part in parts]

    def facets_of(self, surface: str) -> np.ndarray:
        """Facets of a surface, shape (n, nodes_per_facet)."""
        return self.facets[self.facet_tags == self.surfaces.index(surface) + 1]

    def node_places(self, kind: str) -> np.ndarray:
        """Reference coordinates of the nodes of a cell or facet, shape (n_nodes, dim)."""
        return reference_nodes(kind, self.order)


def quadratic(mesh: TaggedMesh) -> TaggedMesh:
    """Mesh with cells of order 2 whose nodes lie on the cells of higher order."""
    kind, order = mesh.cell_type, mesh.order
    values = shape_functions(kind, order, reference_nodes(kind, 2))
    places = np.einsum("qk,cki->cqi", values, mesh.points[mesh.cells])
    keys = [_corner_keys(kind, mesh.cells), _corner_keys(FACETS[kind], mesh.facets)]
    keys[1] = np.pad(
        keys[1], ((0, 0), (keys[0].shape[1] - keys[1].shape[1], 0)), constant_values=-1
    )
    _, first, node = np.unique(np.concatenate(keys), axis=0, return_index=True, return_inverse=True)
    cells, facets = np.split(node.ravel(), [len(keys[0])])
    return replace(
        mesh,
        points=places.reshape(-1, mesh.points.shape[1])[first],
        cells=cells.reshape(len(mesh.cells), -1),
        facets=facets.reshape(len(mesh.facets), -1),
    )


def _corner_keys(kind: str, cells: np.ndarray) -> np.ndarray:
    """Corners between which each node of order 2 lies, padded with -1, sorted; one row per node."""
    belongs = shape_functions(kind, 1, reference_nodes(kind, 2)) > 1e-9
    corners = cells[:, : belongs.shape[1]]
    return np.sort(np.where(belongs, corners[:, None], -1), axis=2).reshape(-1, belongs.shape[1])


def compact(mesh: TaggedMesh) -> TaggedMesh:
    """Mesh without unused points."""
    used = np.zeros(len(mesh.points), dtype=bool)
    used[mesh.cells] = True
    number = np.where(used, np.cumsum(used) - 1, -1)
    return replace(
        mesh,
        points=np.ascontiguousarray(mesh.points[used]),
        cells=number[mesh.cells],
        facets=number[mesh.facets],
    )


def jacobians(
    cell_type: str, order: int, nodes: np.ndarray, along: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Smallest and largest scaled Jacobian of each cell, and its mean Jacobian determinant.

    The scaled Jacobian is the determinant of the unit tangents along the grid lines of a cell, in
    the plane the sine of the angle between them: negative if a cell is inverted, NaN where a
    tangent vanishes.

    Parameters
    ----------
    cell_type : str
    order : int
    nodes : ndarray, shape (n_cells, nodes_per_cell, gdim) [m]
    along : int
        Number of points along each side of a cell.

    Returns
    -------
    least, most, mean : ndarray, shape (n_cells,)
    """
    derivatives = slopes(cell_type, order, _grid(cell_type, along, nodes.shape[2]))
    flat = derivatives.reshape(-1, derivatives.shape[2])
    result = np.empty((3, len(nodes)))
    for first in range(0, len(nodes), _AT_ONCE):
        some = slice(first, first + _AT_ONCE)
        tangents = (flat @ nodes[some]).reshape(-1, *derivatives.shape[:2], nodes.shape[2])
        lengths = np.sqrt(np.einsum("cqdi,cqdi->cqd", tangents, tangents)).prod(axis=2)
        determinants = _determinants(tangents)
        with np.errstate(invalid="ignore", divide="ignore"):
            scaled = determinants / lengths
        result[:, some] = scaled.min(axis=1), scaled.max(axis=1), determinants.mean(axis=1)
    return result[0], result[1], result[2]


def scaled_jacobians(mesh: TaggedMesh) -> np.ndarray:
    """Smallest scaled Jacobian of each cell, shape (n_cells,).

    See `jacobians`, for tetrahedra `scaled_jacobians_of_tetrahedra`.
    """
    if mesh.cell_type == "tetrahedron":
        return scaled_jacobians_of_tetrahedra(mesh.order, mesh.points[mesh.cells])
    along = _PLACES[mesh.points.shape[1]]
    return jacobians(mesh.cell_type, mesh.order, mesh.points[mesh.cells], along)[0]


def quality(mesh: TaggedMesh, parts: tuple[str, ...]) -> float:
    """Smallest scaled Jacobian of some parts of a mesh; -1 if cells have degenerated."""
    of_parts = np.isin(mesh.cell_tags, mesh.tags_of(parts))
    found = scaled_jacobians(replace(mesh, cells=mesh.cells[of_parts]))
    return float(np.nan_to_num(found, nan=-1.0).min())


def _grid(cell_type: str, along: int, dim: int) -> np.ndarray:
    """Reference points (n, dim) on a grid with `along` points on each side of a cell."""
    places = np.array(list(itertools.product(np.linspace(0.0, 1.0, along), repeat=dim)))
    simplex = cell_type in ("triangle", "tetrahedron")
    return places[places.sum(axis=1) <= 1.0 + 1e-9] if simplex else places


def _determinants(matrices: np.ndarray) -> np.ndarray:
    """Determinants of small matrices (..., d, d), explicitly: faster than by LAPACK."""
    if matrices.shape[-1] == 2:
        (a, b), (c, d) = np.moveaxis(matrices, (-2, -1), (0, 1))
        return a * d - b * c
    (a, b, c), (d, e, f), (g, h, i) = np.moveaxis(matrices, (-2, -1), (0, 1))
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)

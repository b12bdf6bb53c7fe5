"""Quadratic geometry fitted to the faces of straight-sided cells.

Corners of facets lie on the face that was meshed; the nodes between them are moved onto it. A face
is divided into smooth patches. A patch is a plane, cylinder, cone or sphere (a line or a circle in
a section) if its corners are on one, up to a small part of the height of arcs over their chords.
Otherwise the node between two corners is that of the cubic curve normal to the normals at both
(Vlachos et al., Curved PN triangles, I3D 2001), which are those of quadratic functions fitted to
the corners around.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy

from ...errors import CaseError
from .mixed import AnyMesh, of_blocks
from .nodes import boundary, centre, components, facet_nodes, meeting, numbered, reference_nodes
from .tagged import TaggedMesh, quadratic, scaled_jacobians

Projection = Callable[[np.ndarray], np.ndarray]
"""Nearest points on a shape to points (n, gdim)."""
_CORNER = float(np.radians(40.0))
"""Angle between facets of different patches."""
_ONWARD = np.cos(np.radians(15.0))
"""Cosine between a patch and a flat facet beyond its rim above which the facet continues it."""
_FINER = np.radians([20.0, 10.0, 5.0, 2.0])
"""Angles at which a patch of no simple shape is divided if all of its parts have one."""
_FEWEST = {2: 2, 3: 3}
"""Least number of facets of such a part, by dimension."""
_FITS = 0.02
"""Largest distance of corners from a shape, relative to the height of arcs."""
_LEVEL = 1e-6
"""Height of arcs relative to the size of a patch below which it is flat."""
_CORNERS = {3: 2, 6: 3, 9: 4}
"""Number of corners of a facet of order 2 by its nodes."""
_STRAIGHT = 0.05
"""Distance of nodes between corners from chords, relative to the height of arcs, of flat facets."""
_SWEEPS, _SETTLED = 300, 1e-14
"""Largest number of sweeps over all patches, and movement relative to the size that ends them."""
_THIN = 0.02
"""Scaled Jacobian of curved cells below which the nodes further inside follow."""


@dataclass(frozen=True)
class Curving:
    """Mesh with cells of order 2 whose nodes have been moved onto smooth faces.

    Attributes
    ----------
    straight, mesh : TaggedMesh
        Before and after.
    nodes : ndarray of int
        Nodes of the curved facets.
    heights : dict of str to float
        Largest distance that a node has moved, by surface [m].
    angles : dict of str to float
        Largest angle between adjacent facets of one patch, by surface [rad].
    """

    straight: TaggedMesh
    mesh: TaggedMesh
    nodes: np.ndarray
    heights: dict[str, float]
    angles: dict[str, float]


class _Patch:
    """Smooth part of a surface.

    Attributes
    ----------
    points : ndarray, shape (n_points, gdim)
        All nodes of the mesh of order 2, straight [m].
    members : ndarray, shape (n,)
        Indices of its facets among those of the surface.
    nodes : ndarray, shape (n, nodes_per_facet)
        Nodes of its facets in gmsh's order.
    corners : ndarray, shape (n, n_corners)
    normals : ndarray, shape (n, gdim)
        Unit normals of the facets.
    angle : float
        Largest angle between adjacent facets [rad].
    ends, middle : ndarray, shape (n_edges, 2) and (n_edges,)
        Nodes at the ends and in the middle of the edges of facets.
    places : ndarray, shape (n_corners, gdim)
        Coordinates of all corners [m].
    tolerance : float
        Distance of corners from a shape that is allowed [m].
    flat : bool
        Whether the nodes between corners are in the middle of chords.
    shape : Projection or None
        Projection on the simple shape of the corners, if they have one.
    """

    def __init__(self, points: np.ndarray, nodes: np.ndarray, members: np.ndarray, angle: float):
        self.points, self.members, self.angle = points, members, angle
        self.nodes = nodes = nodes[members]
        count = _CORNERS[nodes.shape[1]]
        self.corners = nodes[:, :count]
        self.normals = _normals(points[self.corners])
        of_edges = nodes[:, count : (3 if count == 2 else 2 * count)].ravel()
        self.middle, first = np.unique(of_edges, return_index=True)
        self.ends = _edges(self.corners)[first]
        self.places = points[np.unique(self.corners)]
        a, b = points[self.ends.T]
        self.height = angle * float(np.linalg.norm(b - a, axis=1).max()) / 8
        off = np.linalg.norm(points[self.middle] - (a + b) / 2, axis=1)
        self.flat = float(off.max()) <= _STRAIGHT * self.height
        self.level = _LEVEL * float(np.ptp(self.places, axis=0).max())
        self.tolerance = max(_FITS * self.height, self.level)
        self.shape = self._shape()

    def _shape(self) -> Projection | None:
        """Projection on the simple shape of the corners; None if they have none."""
        if not self.flat or self.height < self.level:
            return _as_it_is
        in_section = self.points.shape[1] == 2
        fits = (_sphere,) if in_section else (_plane, _cone, _sphere)
        for fit in fits:
            project = fit(self.places, self.normals)
            if project is not None:
                distances = np.linalg.norm(project(self.places) - self.places, axis=1)
                if distances.max() <= self.tolerance:
                    return _as_it_is if fit is _plane else project
        return None

    def steps(self) -> tuple[np.ndarray, Projection]:
        """Nodes between corners, and their projection on the patch."""
        if self.shape is not None:
            return self.middle, self.shape
        a, b = self.ends.T
        normals = self._corner_normals()
        chords = self.points[b] - self.points[a]
        bulge = _along(chords, normals[b]) - _along(chords, normals[a])
        places = (self.points[a] + self.points[b]) / 2 + bulge / 8
        return self.middle, _on_planes(places, _unit(normals[a] + normals[b]))

    def _corner_normals(self) -> np.ndarray:
        """Unit normals at the corners, shape (n_points, gdim); NaN at other nodes.

        Heights over the mean plane around a corner are fitted by a quadratic function.
        """
        dim, number = self.points.shape[1], np.unique(self.corners)
        local = np.searchsorted(number, self.ends)
        count = len(number)
        mean = np.zeros((count, dim))
        for corner in np.searchsorted(number, self.corners).T:
            np.add.at(mean, corner, self.normals)
        mean = _unit(mean)
        links = scipy.sparse.coo_matrix((np.ones(len(local)), local.T), (count, count)).tocsr()
        links = links + links.T
        of, other = (links + links @ links).nonzero()
        of, other = of[of != other], other[of != other]
        across = np.linalg.svd(mean[:, None])[2][:, 1:]  # tangents, shape (count, dim - 1, dim)
        steps = self.places[other] - self.places[of]
        far = np.linalg.norm(steps, axis=1)
        scale = (np.bincount(of, far, count) / np.bincount(of, minlength=count))[of]
        t = np.einsum("pti,pi->pt", across[of], steps) / scale[:, None]
        one, two = np.triu_indices(dim - 1)
        weights = (scale / far)[:, None]
        rows = weights * np.hstack([t, t[:, one] * t[:, two]])
        heights = weights * (np.einsum("pi,pi->p", mean[of], steps) / scale)[:, None]
        left = np.zeros((count, rows.shape[1], rows.shape[1]))
        right = np.zeros((count, rows.shape[1]))
        np.add.at(left, of, rows[:, :, None] * rows[:, None])
        np.add.at(right, of, rows * heights)
        left += 1e-9 * np.trace(left, axis1=1, axis2=2)[:, None, None] * np.eye(rows.shape[1])
        slopes = np.linalg.solve(left, right[..., None])[:, : dim - 1, 0]
        result = np.full_like(self.points, np.nan)
        result[number] = _unit(mean - np.einsum("nt,nti->ni", slopes, across))
        return result


def curved(mesh: AnyMesh, surfaces: Sequence[str], key: str) -> AnyMesh:
    """Mesh whose surfaces are smooth, with cells of order 2; those of order 3 stay as they are.

    Raises
    ------
    CaseError
        If cells would be tangled, reported at the key.
    """
    return of_blocks(
        [
            _valid(block, curving(block, surfaces), key) if block.order <= 2 else block
            for block in mesh.blocks
        ]
    )


def _valid(given: TaggedMesh, found: Curving, key: str) -> TaggedMesh:
    """Curved mesh; nodes inside follow where cells would be tangled otherwise."""
    if not any(found.heights.values()):
        return given
    mesh = found.mesh
    if not scaled_jacobians(mesh).min() > _THIN:
        mesh = _followed(found)
    tangled = ~(scaled_jacobians(mesh) > 0.0)
    if tangled.any():
        where = ", ".join(f"{x:.6g} m" for x in mesh.points[mesh.cells[np.argmax(tangled), 0]])
        raise CaseError(
            f"{key}: {tangled.sum()} cells would be tangled, one at ({where}); refine the mesh "
            "along the curved surface, whose cells are too thin for their length"
        )
    return mesh


def curving(mesh: TaggedMesh, surfaces: Sequence[str]) -> Curving:
    """Move the nodes between the corners of surfaces, of cells of order 1 or of flat facets."""
    second = quadratic(mesh) if mesh.order == 1 else mesh
    points = second.points.copy()
    of_surface = {name: list(_patches(second, name)) for name in surfaces}
    bent = [
        patch
        for patches in of_surface.values()
        for patch in patches
        if patch.shape is not _as_it_is
    ]
    steps = [patch.steps() for patch in bent]
    if bent and points.shape[1] == 3:
        steps += _level_rims(second, bent)
    size = float(np.ptp(points, axis=0).max())
    for _ in range(_SWEEPS):
        before = points.copy()
        for nodes, project in steps:
            points[nodes] = project(points[nodes])
        if np.abs(points - before).max() < _SETTLED * size:
            break
    points = _centred(second, points)
    for patch in bent:
        if patch.shape is not None and patch.nodes.shape[1] == 9:
            inner = patch.nodes[:, 8]
            points[inner] = patch.shape(points[inner])
    heights = {}
    for name in surfaces:
        nodes = second.facets_of(name).ravel()
        moved = np.linalg.norm(points[nodes] - second.points[nodes], axis=1)
        heights[name] = float(moved.max(initial=0.0))
    angles = {name: max((p.angle for p in of), default=0.0) for name, of in of_surface.items()}
    curved_nodes = np.unique(np.concatenate([np.empty(0, int), *(p.nodes.ravel() for p in bent)]))
    return Curving(second, replace(second, points=points), curved_nodes, heights, angles)


def _patches(mesh: TaggedMesh, surface: str) -> Iterator[_Patch]:
    """Smooth parts of a surface of cells of order 2."""
    nodes = mesh.facets_of(surface)
    if not len(nodes):
        return
    count = _CORNERS[nodes.shape[1]]
    corners = nodes[:, :count]
    normals = _normals(mesh.points[corners])
    joints = corners.reshape(-1, 1) if count == 2 else _edges(corners)
    pairs = meeting(joints) // count
    between = 2 * np.arctan2(
        np.linalg.norm(normals[pairs[:, 0]] - normals[pairs[:, 1]], axis=1),
        np.linalg.norm(normals[pairs[:, 0]] + normals[pairs[:, 1]], axis=1),
    )

    def parts(members: np.ndarray, largest: float, fewest: int = 1) -> list[_Patch]:
        inside = (between < largest) & np.isin(pairs, members).all(axis=1)
        label = components(pairs[inside], len(corners))
        angle = np.zeros(len(corners))
        np.maximum.at(angle, label[pairs[inside, 0]], between[inside])
        number, sizes = np.unique(label[members], return_counts=True)
        if sizes.min() < fewest:
            return []
        groups = [members[label[members] == k] for k in number]
        return [_Patch(mesh.points, nodes, g, angle[label[g[0]]]) for g in groups]

    for patch in parts(np.arange(len(corners)), _CORNER):
        finer = (
            parts(patch.members, largest, _FEWEST[mesh.points.shape[1]])
            for largest in (() if patch.shape is not None else _FINER)
        )
        simple = (found for found in finer if found and all(p.shape is not None for p in found))
        yield from next(simple, [patch])


def _level_rims(mesh: TaggedMesh, patches: Sequence[_Patch]) -> list[tuple[np.ndarray, Projection]]:
    """Nodes at the rims of patches, and their projection on the flat facets beyond."""
    around = boundary(mesh.cell_type, 2, mesh.cells)
    count = patches[0].corners.shape[1]
    own = np.concatenate([patch.corners for patch in patches])
    number, _ = numbered(np.concatenate([around[:, :count], own]))
    around = around[~np.isin(number[: len(around)], number[len(around) :])]
    normal = np.full_like(mesh.points, np.nan)
    for patch in patches:
        for side in range(count):
            normal[patch.nodes[:, count + side]] = patch.normals
    levels, steps = _normals(mesh.points[around[:, :count]]), []
    for side in range(count):
        nodes = around[:, count + side]
        turned = np.abs(np.einsum("ni,ni->n", normal[nodes], levels)) < _ONWARD
        places = mesh.points[around[turned, 0]]
        steps.append((nodes[turned], _on_planes(places, levels[turned])))
    return [step for step in steps if len(step[0])]


def _centred(mesh: TaggedMesh, points: np.ndarray) -> np.ndarray:
    """Nodes (n, gdim) with those inside faces and cells where the others imply them."""
    points, cells = points.copy(), mesh.cells
    if mesh.cell_type == "hexahedron":
        faces = cells[:, facet_nodes("hexahedron", 2)].reshape(-1, 9)
        points[faces[:, 8]] = centre(points[faces[:, :8]], 4, 2)
        points[cells[:, 26]] = centre(points[cells[:, :20]], 8, 4)
    elif mesh.cell_type == "quadrilateral":
        points[cells[:, 8]] = centre(points[cells[:, :8]], 4, 2)
    return points


def _followed(found: Curving) -> TaggedMesh:
    """Mesh whose nodes inside have moved like those around them, by harmonic displacements.

    Corners on the boundary stay, and nodes between them stay in their flat facets.
    """
    straight, mesh = found.straight, found.mesh
    moves = mesh.points - straight.points
    places = reference_nodes(mesh.cell_type, 2)
    near = np.linalg.norm(places[:, None] - places, axis=2) < 0.75
    one, other = np.nonzero(np.triu(near, 1))
    a, b = mesh.cells[:, one].ravel(), mesh.cells[:, other].ravel()
    weights = 1 / np.sum((straight.points[a] - straight.points[b]) ** 2, axis=1)
    count = len(moves)
    links = scipy.sparse.coo_matrix((weights, (a, b)), (count, count)).tocsr()
    links = links + links.T
    matrix = scipy.sparse.diags(np.asarray(links.sum(axis=1)).ravel()) - links
    around = boundary(mesh.cell_type, 2, mesh.cells)
    corners = _CORNERS[around.shape[1]]
    held = np.zeros(count, dtype=bool)
    held[around[:, :corners]] = True
    held[found.nodes] = True
    free = np.flatnonzero(~held)
    inner = matrix[free][:, free]
    preconditioner = scipy.sparse.diags(1 / inner.diagonal())
    given = -matrix[free][:, np.flatnonzero(held)] @ moves[held]
    for axis in range(moves.shape[1]):
        moves[free, axis], _ = scipy.sparse.linalg.cg(
            inner, given[:, axis], rtol=1e-6, maxiter=1000, M=preconditioner
        )
    levels = _normals(straight.points[around[:, :corners]])
    for nodes in around[:, corners:].T:
        own = ~held[nodes]
        moves[nodes[own]] -= _along(moves[nodes[own]], levels[own])
    return replace(mesh, points=_centred(mesh, straight.points + moves))


def _plane(places: np.ndarray, normals: np.ndarray) -> Projection:
    middle = places.mean(axis=0)
    normal = np.linalg.svd(places - middle, full_matrices=False)[2][-1:]
    return _on_planes(middle, normal)


def _sphere(places: np.ndarray, normals: np.ndarray) -> Projection | None:
    """Sphere or circle by least squares of the difference of squared radii."""
    dim = places.shape[1]
    if len(places) < dim + 2:
        return None
    middle, size = places.mean(axis=0), np.ptp(places, axis=0).max()
    x = (places - middle) / size
    (*place, level), *_ = np.linalg.lstsq(
        np.column_stack([2 * x, np.ones(len(x))]), np.sum(x**2, axis=1), rcond=None
    )
    origin = middle + size * np.array(place)
    radius = size * np.sqrt(level + np.sum(np.square(place)))
    return lambda points: origin + radius * _unit(points - origin)


def _cone(places: np.ndarray, normals: np.ndarray) -> Projection | None:
    """Cylinder or cone by least squares of the distances."""
    if len(places) < 8:
        return None
    middle, size = places.mean(axis=0), np.ptp(places, axis=0).max()
    x = (places - middle) / size
    axes = np.linalg.svd(normals - normals.mean(axis=0))[2]

    def local(turn: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Axis, distance along it and vector across of points."""
        axis = _unit(axes[2] + turn @ axes[:2])
        along = points @ axis
        return axis, along, points - along[:, None] * axis

    def distances(values: np.ndarray) -> np.ndarray:
        turn, at, (radius, slope) = np.split(values, [2, 4])
        axis, along, across = local(turn, x)
        origin = at @ axes[:2]
        origin = origin - (origin @ axis) * axis
        radii = np.linalg.norm(across - origin, axis=1)
        return (radii - radius - slope * along) / np.hypot(1.0, slope)

    _, along, across = local(np.zeros(2), x)
    flat = across @ axes[:2].T
    # |flat|² = 2 flat·at + 2 radius slope along + slope² along² + radius² - |at|²
    columns = np.column_stack([2 * flat, 2 * along, along**2, np.ones(len(x))])
    (*at, both, square, level), *_ = np.linalg.lstsq(columns, np.sum(flat**2, axis=1), rcond=None)
    radius = np.sqrt(max(level + np.sum(np.square(at)), 0.0))
    slope = np.copysign(np.sqrt(max(square, 0.0)), both)
    start = np.array([0.0, 0.0, *at, radius, slope])
    if not np.isfinite(start).all():
        return None
    turn, at, (radius, slope) = np.split(
        scipy.optimize.least_squares(distances, start, method="lm", max_nfev=200).x, [2, 4]
    )

    def project(points: np.ndarray) -> np.ndarray:
        axis, along, across = local(turn, (points - middle) / size)
        origin = at @ axes[:2]
        origin = origin - (origin @ axis) * axis
        outward = _unit(across - origin)
        radii = np.linalg.norm(across - origin, axis=1)
        off = (radii - radius - slope * along) / (1.0 + slope**2)
        return points - size * off[:, None] * (outward - slope * axis)

    return project


def _as_it_is(points: np.ndarray) -> np.ndarray:
    return points


def _on_planes(places: np.ndarray, normals: np.ndarray) -> Projection:
    """Projection of each point on the plane through a place with a normal."""
    return lambda points: points - _along(points - places, normals)


def _along(vectors: np.ndarray, units: np.ndarray) -> np.ndarray:
    """Parts of vectors (n, gdim) along unit vectors."""
    return np.sum(vectors * units, axis=1, keepdims=True) * units


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def _edges(corners: np.ndarray) -> np.ndarray:
    """Ends of the edges of facets, facet by facet; of an edge, the edge itself."""
    if corners.shape[1] == 2:
        return corners
    return np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)


def _normals(corners: np.ndarray) -> np.ndarray:
    """Outward unit normals of facets (n, n_corners, gdim), of warped ones at their middle."""
    if corners.shape[2] == 2:
        x, y = (corners[:, 1] - corners[:, 0]).T
        return _unit(np.column_stack([y, -x]))
    count = corners.shape[1]
    one, other = (corners[:, 1], corners[:, 2]) if count == 3 else (corners[:, 2], corners[:, 3])
    second = other - corners[:, 0] if count == 3 else other - corners[:, 1]
    return _unit(np.cross(one - corners[:, 0], second))

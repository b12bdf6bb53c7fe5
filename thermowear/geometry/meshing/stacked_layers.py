"""Mesh of rectangles on top of each other, of different widths; mirror images of meshes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...lagrange import matching
from ..mesh.nodes import reference_nodes
from ..mesh.tagged import TaggedMesh
from .cells import Claim, MeshedBody, Sheet, between, both, grid, level, mesh_body, tagged_bodies
from .divisions import SAME, graded_face, growing, growing_from_both, joined

_LARGEST, _SLENDER = 3.0, 0.25
"""Height of the largest row: in elements of equal size along the widest layer, and of graded layers
that are much higher than wide in elements of equal size along the height."""


@dataclass(frozen=True)
class Layer:
    """Rectangle of a stack.

    Attributes
    ----------
    left, right : float
        Range of x, or of the radius [m].
    height : float [m]
    """

    left: float
    right: float
    height: float

    @property
    def width(self) -> float:
        return self.right - self.left


def stacked_layers(
    layers: Mapping[str, Layer],
    face: Callable[[str], tuple[int, float]],
    row: Callable[[float], float],
) -> TaggedMesh:
    """Mesh layers from the top downwards; the first one ends at y = 0.

    All layers have element ends where any of them ends, and elements shrink towards these places
    and towards the faces between layers.

    Parameters
    ----------
    layers : mapping of str to Layer
    face : callable
        Number of elements along the widest layer, and grading, of a body.
    row : callable
        Height of the first row at a face between layers by that of the thinnest column [m].
    """
    bodies: dict[str, MeshedBody] = {}
    surfaces: dict[str, Claim] = {}
    widest = max(layer.width for layer in layers.values())
    for name, layer, span, (over, under) in _placed(layers):
        elements, grading = face(name)
        columns = _columns(layer, layers, elements, grading)
        largest, column = _LARGEST * widest / elements, float(np.diff(columns).min())
        thin = row(column)
        if thin < column:
            largest = max(largest, _SLENDER * layer.height / elements)
        rows = _rows(span, (over is not None, under is not None), thin, largest, grading)
        bodies[name] = mesh_body([Sheet(grid(columns, rows))], 1)
        surfaces |= _surfaces(name, layer, span, over, under)
    return tagged_bodies(bodies, surfaces)


def surface_names(layers: Mapping[str, Layer]) -> tuple[str, ...]:
    """Names of the surfaces of a stack, see `_surfaces`."""
    return tuple(
        surface
        for name, layer, span, neighbours in _placed(layers)
        for surface in _surfaces(name, layer, span, *neighbours)
    )


def _placed(
    layers: Mapping[str, Layer],
) -> Iterator[tuple[str, Layer, tuple[float, float], tuple[Layer | None, Layer | None]]]:
    """Layers with their names, bottom and top, and the layers above and below."""
    over, top = None, next(iter(layers.values())).height
    below = [*layers.values()][1:]
    for (name, layer), under in zip(layers.items(), [*below, None], strict=True):
        yield name, layer, (top - layer.height, top), (over, under)
        over, top = layer, top - layer.height


def _surfaces(
    name: str,
    layer: Layer,
    span: tuple[float, float],
    over: Layer | None,
    under: Layer | None,
) -> dict[str, Claim]:
    """Predicates of the parts of the boundary of a layer.

    ``top`` and ``bottom`` are opposite to the neighbours; what they leave free of these faces is
    ``top_rest`` and ``bottom_rest``.
    """
    found = {f"{name}_inside": level(0, layer.left), f"{name}_outside": level(0, layer.right)}
    for side, y, other in (("top", span[1], over), ("bottom", span[0], under)):
        at = level(1, y)
        if other is None or _covered(layer, other):
            found[f"{name}_{side}"] = at
        else:
            found[f"{name}_{side}"] = both(at, between(other.left, other.right))
            found[f"{name}_{side}_rest"] = at
    return found


def _covered(layer: Layer, by: Layer) -> bool:
    near = SAME * max(abs(layer.left), abs(layer.right))
    return by.left <= layer.left + near and layer.right <= by.right + near


def _columns(
    layer: Layer, layers: Mapping[str, Layer], elements: int, grading: float
) -> np.ndarray:
    """Ends of the columns of a layer."""
    every = sorted(x for one in layers.values() for x in (one.left, one.right))
    near = SAME * max(abs(every[0]), abs(every[-1]))
    ends = [layer.left]
    for x in every:
        if ends[-1] + near < x <= layer.right + near:
            ends.append(min(x, layer.right))
    widest = max(one.width for one in layers.values())
    counts = [max(2, round(elements * (b - a) / widest)) for a, b in pairwise(ends)]
    parts = zip(pairwise(ends), counts, strict=True)
    return joined(*(graded_face(a, b, count, grading) for (a, b), count in parts))


def _rows(
    span: tuple[float, float],
    neighbours: tuple[bool, bool],
    thin: float,
    largest: float,
    grading: float,
) -> np.ndarray:
    """Ends of the rows of a layer, which grow from its faces to neighbours above and below.

    A layer between two others has twice the rows of its upper half below one of them.
    """
    (bottom, top), (above, below) = span, neighbours
    if above and below:
        return growing_from_both(bottom, top, (thin, thin), grading, largest)
    start, end = (top, bottom) if above else (bottom, top)
    return growing(start, end, thin, grading, largest)


_ON_LINE = 1e-9
"""Distance from the line, relative to the size of the mesh, of nodes that lie on it."""


def mirrored(
    mesh: TaggedMesh, through: str, bodies: Mapping[str, str], surfaces: Mapping[str, str]
) -> TaggedMesh:
    """Mesh with its mirror image in a line y = const.

    Parameters
    ----------
    mesh : TaggedMesh
        Plane mesh above the line.
    through : str
        Surface on the line, which disappears: its body continues across it.
    bodies, surfaces : mapping of str to str
        Names of the mirror images; those of the body that continues, and of its surfaces that do,
        are unchanged.

    Returns
    -------
    TaggedMesh
        New bodies and surfaces follow the present ones in the order of their images.
    """
    points, line = mesh.points, float(mesh.points[mesh.facets_of(through), 1].mean())
    on_line = np.abs(points[:, 1] - line) < _ON_LINE * np.ptp(points, axis=0).max()
    image = np.where(on_line, -1, len(points) + np.cumsum(~on_line) - 1)
    image[on_line] = np.flatnonzero(on_line)
    reflected = points[~on_line] * [1.0, -1.0] + [0.0, 2 * line]
    nodes = reference_nodes(mesh.cell_type, mesh.order)
    turned = matching(nodes[:, ::-1], nodes)  # keeps the orientation of the cells
    of_bodies, body_names = _names(mesh.bodies, bodies)
    of_surfaces, surface_names = _names(mesh.surfaces, surfaces)
    kept = mesh.facet_tags != mesh.surfaces.index(through) + 1
    facets, tags = mesh.facets[kept], mesh.facet_tags[kept]
    return TaggedMesh(
        points=np.vstack([points, reflected]),
        cell_type=mesh.cell_type,
        cells=np.vstack([mesh.cells, image[mesh.cells][:, turned]]),
        cell_tags=np.concatenate([mesh.cell_tags, of_bodies[mesh.cell_tags - 1]]),
        facets=np.vstack([facets, image[facets]]),
        facet_tags=np.concatenate([tags, of_surfaces[tags - 1]]),
        bodies=body_names,
        surfaces=surface_names,
    )


def _names(names: tuple[str, ...], images: Mapping[str, str]) -> tuple[np.ndarray, tuple[str, ...]]:
    """Tags of the images by those of the originals, and all names."""
    new = [images[name] for name in names if images.get(name, name) != name]
    every = (*names, *new)
    tags = [every.index(images.get(name, name)) + 1 for name in names]
    return np.array(tags, dtype=np.int32), every

"""Mirror image of a plane mesh added below it, with one of its bodies continued across the line."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...lagrange import matching
from ..mesh.nodes import reference_nodes
from ..mesh.tagged import TaggedMesh

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

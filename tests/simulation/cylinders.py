"""Cylinders and balls that touch each other, with contact faces of any extent, as mesh files."""

from dataclasses import replace

import numpy as np

from thermowear.case.tables.mesh import MeshTable
from thermowear.geometry.geometries.on_block import CylinderOnBlock
from thermowear.geometry.mesh.tagged import TaggedMesh

from ..conftest import NAMES


def cylinder(radius: float, zone: float, elements: int, half: bool = False) -> TaggedMesh:
    """Lower half of a cylinder that touches the origin from above, and the block below it."""
    geometry = CylinderOnBlock(
        type="cylinder-on-block",
        radius=f"{radius!r} m",
        block_width=f"{4 * radius!r} m",
        block_height=f"{2 * radius!r} m",
        half=half,
    )
    return geometry.build(MeshTable(elements=elements, grading=0.5), (-zone, zone))


def ball(radius: float, zone: float, elements: int, angle: float) -> TaggedMesh:
    """Half sections of two balls of the same radius, see `on_cylinder`."""
    half = cylinder(radius, zone, elements, half=True)
    return on_cylinder(half, half, angle)


def on_cylinder(
    upper: TaggedMesh,
    lower: TaggedMesh,
    angle: float,
    edges: str = "curved",
    overlap: float = 0.0,
) -> TaggedMesh:
    """Two halves of cylinders, one on top of the other.

    Parameters
    ----------
    upper, lower : TaggedMesh
        From `cylinder`; of both the round body.
    angle : float
        Contact faces reach so far from the bottom or top of each, 90 for all of it [°].
    edges : str
        ``"straight"``: cells of the first order.
    overlap : float
        How far they are drawn into each other [m].
    """
    bodies = [_round(mesh, angle) for mesh in (upper, lower)]
    (points, cells, facets), (below, *others) = bodies
    below = below * [1.0, -1.0] + [0.0, overlap]
    shift = len(points)
    mirrored, opposite = others
    surfaces = tuple(f"{body}_{part}" for body in ("upper", "lower") for part in ("face", "end"))
    made = TaggedMesh(
        points=np.vstack([points, below]),
        cell_type=upper.cell_type,
        cells=np.vstack([cells, mirrored + shift]),
        cell_tags=np.repeat(np.array([1, 2], dtype=np.int32), [len(cells), len(mirrored)]),
        facets=np.vstack([facets[0], facets[1], opposite[0] + shift, opposite[1] + shift]),
        facet_tags=np.repeat(
            np.arange(1, 5, dtype=np.int32), [len(f) for f in (*facets, *opposite)]
        ),
        bodies=("upper", "lower"),
        surfaces=surfaces,
    )
    return straightened(made) if edges == "straight" else made


def pin_in_bush(angle: float, count: int = 64) -> TaggedMesh:
    """A ring of 10 mm in one that is 20 µm wider, touching at the bottom of both.

    Parameters
    ----------
    angle : float
        Contact faces reach so far from the bottom, 180 for whole circles [°].
    count : int
        Cells of the second order round each, smaller near the bottom.
    """
    rings = [_ring(6e-3, 10e-3, 0.0, count), _ring(10.02e-3, 15e-3, 20e-6, count)]
    (points, cells, inner, outer), (more, others, inside, outside) = rings
    shift = len(points)
    middle = points[outer].mean(axis=1)
    chosen = np.degrees(np.abs(np.arctan2(middle[:, 0], -middle[:, 1]))) < angle
    facets = [outer[chosen], inner, inside[chosen] + shift, outside + shift]
    return TaggedMesh(
        points=np.vstack([points, more]),
        cell_type="quadrilateral",
        cells=np.vstack([cells, others + shift]),
        cell_tags=np.repeat(np.array([1, 2], dtype=np.int32), len(cells)),
        facets=np.vstack(facets),
        facet_tags=np.repeat(np.arange(1, 5, dtype=np.int32), [len(f) for f in facets]),
        bodies=("upper", "lower"),
        surfaces=tuple(f"{body}_{part}" for body in ("upper", "lower") for part in ("face", "end")),
    )


def _ring(inner: float, outer: float, height: float, count: int, rows: int = 4):
    """Points, cells, and the facets inside and outside of a ring, cells of the second order."""
    turn = np.linspace(-np.pi, np.pi, 2 * count + 1)[:-1]
    from_bottom = turn - 0.8 * np.sin(turn)
    r = np.linspace(inner, outer, 2 * rows + 1)
    x, y = r[:, None] * np.sin(from_bottom), height - r[:, None] * np.cos(from_bottom)
    number = np.arange(x.size).reshape(x.shape)
    i, k = (
        v.ravel() for v in np.meshgrid(2 * np.arange(rows), 2 * np.arange(count), indexing="ij")
    )
    places = ((0, 0), (0, 2), (2, 2), (2, 0), (0, 1), (1, 2), (2, 1), (1, 0), (1, 1))
    cells = np.column_stack([number[i + a, (k + b) % (2 * count)] for a, b in places])
    k = 2 * np.arange(count)
    along = np.column_stack([k, (k + 2) % (2 * count), k + 1])
    return np.column_stack([x.ravel(), y.ravel()]), cells, number[0][along], number[-1][along]


def straightened(mesh: TaggedMesh) -> TaggedMesh:
    """First-order mesh of the same cells with straight edges, without mid-side nodes."""
    cells, facets = mesh.cells[:, :4], mesh.facets[:, :2]
    kept, number = np.unique(np.concatenate([cells.ravel(), facets.ravel()]), return_inverse=True)
    return replace(
        mesh,
        points=mesh.points[kept],
        cells=number[: cells.size].reshape(cells.shape),
        facets=number[cells.size :].reshape(facets.shape),
    )


def _round(mesh: TaggedMesh, angle: float):
    """Points, cells, and the facets of face and end of the round body."""
    tags = {name: k for k, name in enumerate(mesh.surfaces, start=1)}
    arc = np.isin(mesh.facet_tags, [tags["cylinder_face"], tags["cylinder_side"]])
    radius = mesh.points[mesh.facets[mesh.facet_tags == tags["cylinder_top"]]][..., 1].max()
    middle = mesh.points[mesh.facets].mean(axis=1)
    from_bottom = np.degrees(np.arctan2(np.abs(middle[:, 0]), radius - middle[:, 1]))
    face = mesh.facets[arc & (from_bottom < angle)]
    end = mesh.facets[mesh.facet_tags == tags["cylinder_top"]]
    cells = mesh.cells[mesh.cell_tags == 1]
    kept, number = np.unique(cells, return_inverse=True)
    new = np.full(len(mesh.points), -1)
    new[kept] = np.arange(len(kept))
    return mesh.points[kept], number.reshape(cells.shape), (new[face], new[end])


def case_tables(path, force: float, thickness: str = "1 mm", **changes) -> dict:
    """A case with such a mesh: steel, pressed by a force on all of its thickness [N]."""
    tables = {
        "title": "cylinders",
        "model": "plane-strain",
        "geometry": {"type": "file", "path": str(path), "thickness": thickness} | NAMES,
        "mesh": {"degree": 2},
        "bodies": {
            "upper": {"young_modulus": "200 GPa", "poisson_ratio": 0.3},
            "lower": {"young_modulus": "200 GPa", "poisson_ratio": 0.3},
        },
        "load": {"force": f"{force!r} N"},
        "analysis": {"type": "initial"},
    }
    return tables | changes

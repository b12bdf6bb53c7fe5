"""Meshes of the bodies from a tagged mesh."""

from dataclasses import replace

import numpy as np
import pytest

from thermowear.bulk.bodies import bisected, distribute
from thermowear.compat import geometry_dofmap

from ..contact.solids import COMM, two_solids


def test_cells_in_the_order_of_the_tagged_mesh():
    """requirement: values by cell come back in the order of the file, whose bodies are mixed up."""
    tagged = two_solids(((3, 2, 2), (2, 3, 2)), cell_type="tetrahedron")
    order = np.random.default_rng(0).permutation(len(tagged.cells))
    tagged = replace(tagged, cells=tagged.cells[order], cell_tags=tagged.cell_tags[order])
    bodies = distribute(tagged if COMM.rank == 0 else None, COMM)
    assert [body.parts for body in bodies.each] == [("upper",), ("lower",)]
    columns = []
    for body in bodies.each:
        nodes = geometry_dofmap(body.mesh)[: body.n_cells]
        tags = body.parts_of_cells(np.arange(body.n_cells)) + 1
        columns.append((body.mesh.geometry.x[nodes].mean(axis=1), tags))
    found = bodies.in_file_order(columns)
    if COMM.rank == 0:
        ((middles, tags),) = found
        np.testing.assert_allclose(middles, tagged.points[tagged.cells].mean(axis=1), atol=1e-15)
        np.testing.assert_array_equal(tags, tagged.cell_tags)


@pytest.mark.parametrize("parts", [1, 2, 3, 4])
def test_points_are_bisected_into_equal_compact_parts(parts):
    """requirement: parts of equal numbers, cut across the longest side: of a bar along z, ranges
    of z in order.
    """
    points = np.random.default_rng(0).random((1201, 3)) * [1.0, 1.0, 10.0]
    part = bisected(points, parts)
    assert np.ptp(np.bincount(part, minlength=parts)) <= 1
    in_order = part[np.argsort(points[:, 2])]
    assert np.array_equal(in_order, np.sort(part))
    assert len(bisected(points[:0], parts)) == 0

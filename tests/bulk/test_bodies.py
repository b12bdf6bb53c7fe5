"""Meshes of the bodies from a tagged mesh."""

from dataclasses import replace

import numpy as np

from thermowear.bulk.bodies import distribute
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

"""Edges of bodies in space that are cut at a plane."""

import numpy as np
import pytest

pyvista = pytest.importorskip("pyvista")

from thermowear.output.pictures.in_space.solids import clipped, solid_of  # noqa: E402


def grooved(rounding):
    """Tetrahedra of a pad of 8 by 8 by 4, cut away below 2 at |y| < 2, with nodes at y = 0.

    Coordinates y are off by up to `rounding`, as those of meshes of CAD files are.
    """
    whole = pyvista.ImageData(dimensions=(9, 9, 5), origin=(0.0, -4.0, 0.0))
    cells = whole.to_tetrahedra()
    _, y, z = cells.cell_centers().points.T
    pad = cells.extract_cells(np.flatnonzero((np.abs(y) > 2.0) | (z > 2.0)))
    points = pad.points.astype(float)
    points[:, 1] += rounding * np.random.default_rng(1).uniform(-1.0, 1.0, len(points))
    pad = pyvista.UnstructuredGrid(pad.cells, pad.celltypes, points)
    pad.cell_data["body"] = np.ones(pad.n_cells, dtype=int)
    return pad


@pytest.mark.parametrize("rounding", [0.0, 1e-14, 1e-9])
def test_no_edges_within_a_cut_through_nodes(rounding):
    """requirement: only the outline of a cut along a groove is drawn, and edges of the body."""
    edges = solid_of(clipped(grooved(rounding), 0.0)).edges
    along_x = 6 * 8.0
    ends = 2 * 4 * 4.0  # the groove changes the outline of a square, but not its length
    assert edges.compute_cell_sizes()["Length"].sum() == pytest.approx(along_x + ends, rel=1e-3)


def test_the_cut_is_where_it_is_said_to_be():
    """requirement: its offset from the plane is too small to be seen."""
    (surface,) = clipped(grooved(0.0), 0.0)
    assert surface.points[:, 1].min() == pytest.approx(0.0, abs=1e-3)

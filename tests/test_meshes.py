"""Reference meshes in meshes/ compared with the output of the generator."""

import runpy
from pathlib import Path

import meshio
import numpy as np
import pytest

import thermowear as tw

MESHES = Path(__file__).parent.parent / "meshes"
KNOWN = runpy.run_path(str(MESHES / "regenerate.py"))["MESHES"]


def in_order(points):
    """Points sorted by place, whatever their numbers."""
    return points[np.lexsort(np.round(points.T, 9))]


@pytest.mark.parametrize("name", KNOWN)
def test_reference_mesh(name):
    """requirement: same points, elements and names."""
    demo, *overrides = KNOWN[name]
    made = tw.load(MESHES.parent / "demos" / demo, tuple(overrides)).tagged_mesh()
    kept = meshio.read(MESHES / name)
    np.testing.assert_allclose(in_order(kept.points[:, :2]), in_order(made.points), atol=1e-9)
    assert set(kept.field_data) == {*made.bodies, *made.surfaces}
    tags = kept.cell_data_dict["gmsh:physical"]
    kinds = ("quad", "line") if made.cells.shape[1] == 4 else ("quad16", "line4")
    tagged = (made.cell_tags, made.facet_tags)
    for cells, own, shift in zip(kinds, tagged, (0, 2), strict=True):
        assert np.array_equal(np.bincount(tags[cells]), np.bincount(own + shift)), cells


def test_every_mesh_is_known():
    assert {path.name for path in MESHES.glob("*.msh")} == set(KNOWN)

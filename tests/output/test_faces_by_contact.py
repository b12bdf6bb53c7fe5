"""Pictures of the contact faces of several bodies in space."""

import json

import numpy as np
import pytest

from thermowear.output.files import is_ours
from thermowear.output.pictures.bodies import _seen

SUMMARY = {
    "bodies": {"disk": {}, "upper": {}, "lower": {}},
    "contacts": {"top": {"between": ["upper", "disk"]}, "under": {"between": ["disk", "lower"]}},
}


@pytest.fixture
def folder(tmp_path):
    """Results folder of three bodies, without pictures."""
    (tmp_path / "summary.json").write_text(json.dumps(SUMMARY))
    (tmp_path / "run.json").write_text(json.dumps({"contacts": ["top", "under"]}))
    return tmp_path


def test_the_second_body_of_each_contact_is_drawn(folder):
    """requirement: number and name of the body that bears the face; body 2 of a pair."""
    assert _seen(folder, "top") == (1, "disk, seen from upper")
    assert _seen(folder, "under") == (3, "lower, seen from disk")
    assert _seen(folder, "").number == 2


def test_they_are_files_of_the_program(folder):
    """requirement: a picture for each contact belongs to the results, others do not."""
    assert is_ours(folder / "faces_top.png")
    assert not is_ours(folder / "faces_side.png")


def test_bodies_are_clipped_whatever_their_number():
    """requirement: all bodies behind the plane are drawn, the last one first."""
    pyvista = pytest.importorskip("pyvista")
    from thermowear.output.pictures.in_space.solids import clipped

    blocks = [pyvista.Box((k, k + 1, y, y + 2, 0, 1)) for k, y in ((0, -1), (2, -1), (4, -5))]
    grid = pyvista.merge([block.delaunay_3d() for block in blocks])
    middles = grid.cell_centers().points[:, 0]
    grid.cell_data["body"] = 1 + (middles > 1.5).astype(int) + (middles > 3.5)
    surfaces = clipped(grid, 0.0)
    lowest = [float(np.min(surface.points[:, 0])) for surface in surfaces]
    assert lowest == pytest.approx([2.0, 0.0], abs=0.1)  # the third one lies before the plane

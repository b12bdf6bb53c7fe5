"""Sides from which contact faces in space are seen."""

import pytest


@pytest.mark.parametrize(("height", "direction"), [(0.0, 1.0), (-10.0, -1.0)])
@pytest.mark.parametrize("tower", [30.0, -40.0])
def test_a_face_is_seen_from_its_outside(height, direction, tower):
    """requirement: the rubbed face of a disk is seen from outside, wherever its hat lies."""
    pyvista = pytest.importorskip("pyvista")
    from thermowear.output.pictures.in_space.faces import _outwards

    plate = pyvista.Box((0, 100, 0, 100, -10, 0)).triangulate().subdivide(3)
    hat = pyvista.Box((40, 60, 40, 60, min(0, tower), max(0, tower)))
    face = pyvista.Plane(center=(20, 20, height), i_size=20, j_size=20)
    assert _outwards(face, plate.merge(hat)) == direction

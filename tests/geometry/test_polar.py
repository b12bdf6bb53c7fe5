"""Division of rings below an arc of contact."""

import numpy as np
import pytest

from thermowear.geometry.meshing.rings import Polar, complete, incomplete

ARC = (-0.3, 0.7)
R = 50e-3


@pytest.mark.parametrize("grading", [0.3, 1.0])
def test_a_complete_contact_is_divided_up_to_its_edges(grading):
    """
    requirement: the asked elements from edge to edge, graded to both; rows start as small.
    """
    division = complete(ARC, R, (12, grading))
    h = np.diff(division.angles)
    assert (division.angles[0], division.angles[-1]) == ARC
    assert division.span == ARC
    assert len(h) == 12
    np.testing.assert_allclose(h[1:4] / h[:3], 1 / grading, rtol=1e-9)
    np.testing.assert_allclose(h, h[::-1], rtol=1e-9)
    assert division.first == pytest.approx(R * h.min(), rel=1e-9)


@pytest.mark.parametrize("face", [(12, 0.3), (12, 1.0), (40, 1.0), (1, 0.3), (100, 0.05)])
@pytest.mark.parametrize("arc", [ARC, (-1.4, 1.4), (0.0, 0.01)])
def test_elements_go_once_round_and_grow_away_from_the_contact(face, arc):
    """
    requirement: the circle is closed; beside the contact elements start as at its edge, grow at
    most threefold, to 12 degrees, alike on both sides.
    """
    division = complete(arc, R, face)
    angles = division.all_round()
    beside = np.diff(angles)[face[0] :]
    assert angles[-1] == pytest.approx(angles[0] + 2 * np.pi, rel=1e-15)
    np.testing.assert_allclose(beside, beside[::-1], rtol=1e-6)
    assert np.all(beside > 0)
    assert beside.max() <= np.radians(12.0) * 1.5
    edge = min(division.angles[1] - division.angles[0], np.radians(12.0))
    assert beside[0] == pytest.approx(edge, rel=0.5)
    away = beside[: len(beside) // 2]
    ratios = away[1:] / away[:-1]
    assert np.all(ratios < 4.0)
    assert np.all(ratios > 0.6)


def test_rows_grow_from_the_face_inwards_or_outwards():
    """
    requirement: rows start as the division says, fill the ring, and thin rings have several.
    """
    division = complete(ARC, R, (12, 0.3))
    inwards, outwards = division.rows(R, 20e-3), division.rows(R, 80e-3)
    assert (inwards[0], inwards[-1]) == (R, 20e-3)
    assert (outwards[0], outwards[-1]) == (R, 80e-3)
    for radii in (inwards, outwards):
        steps = np.abs(np.diff(radii))
        assert steps[0] == pytest.approx(division.first, rel=0.3)
        assert steps.max() <= 1.5 * np.radians(12.0) * radii.max()
    assert len(division.rows(R, 0.999 * R)) >= 3
    coarse = incomplete(ARC, R, (2, 1.0), 1.3)
    assert len(coarse.rows(R, 0.999 * R)) >= 3


def test_layers_meet_at_ends_of_rows():
    """
    requirement: each layer has its thickness exactly, its rows small at its borders.
    """
    layers = complete(ARC, R, (12, 0.3)).layered((8e-3, 5e-3), R)
    assert layers[0][0] == 0.0
    assert layers[0][-1] == layers[1][0] == 8e-3
    assert layers[1][-1] == pytest.approx(13e-3, rel=1e-15)
    for depths in layers:
        steps = np.diff(depths)
        assert np.all(steps > 0)
        assert max(steps[0], steps[-1]) <= steps.max()


def test_angles_are_from_the_vertical_towards_x():
    """
    requirement: angle 0 is up (or down), positive angles lie at x > 0; arcs are found by them.
    """
    places = np.array([[0.0, 2.0], [np.pi / 6, 2.0]])
    up, down = Polar(), Polar(3.0, downwards=True)
    np.testing.assert_allclose(up.place(places), [[0.0, 2.0], [1.0, np.sqrt(3)]])
    np.testing.assert_allclose(down.place(places), [[0.0, 1.0], [1.0, 3 - np.sqrt(3)]])
    angles = np.radians([[170.0, 185.0], [185.0, 200.0], [200.0, 215.0], [530.0, 545.0]])
    arcs = np.stack([angles, np.full_like(angles, 2.0)], axis=-1)
    for polar in (up, down):
        found = polar.circle(2.0, (np.radians(-190.0), np.radians(-160.0)))(polar.place(arcs))
        assert found.tolist() == [True, True, False, True]
        assert not np.any(polar.circle(2.001)(polar.place(arcs)))

"""Tangential directions on faces in space."""

import numpy as np
import pytest

from thermowear.contact.faces.normals import TangentFrame, frame_in_space

DOWN = np.array([0.0, 0.0, -1.0])


def cap(steepest, count=40):
    """Normals of a spherical cap that looks down, up to an angle from the pole."""
    angle, turn = np.meshgrid(np.linspace(0, steepest, count), np.linspace(0, 2 * np.pi, count))
    x, y = np.sin(angle) * np.cos(turn), np.sin(angle) * np.sin(turn)
    return np.stack([x, y, -np.cos(angle)], axis=-1).reshape(-1, 3)


def test_axes_below_a_body_are_x_and_y():
    """requirement: on a flat face of a body above the directions are those of the results."""
    e = frame_in_space(np.tile(DOWN, (3, 1)), np.ones(3)).at(np.tile(DOWN, (3, 1)))
    np.testing.assert_allclose(e[0], np.tile([1.0, 0.0, 0.0], (3, 1)), atol=1e-15)
    np.testing.assert_allclose(e[1], np.tile([0.0, 1.0, 0.0], (3, 1)), atol=1e-15)


@pytest.mark.parametrize("turned", [0.0, 0.7])
@pytest.mark.parametrize("steepest", [0.3, 1.5, 2.2])
def test_orthonormal_right_handed_and_smooth(steepest, turned):
    """requirement: unit vectors in the tangent plane, e_2 = e_1 × n, without jumps."""
    n = cap(steepest)
    e = TangentFrame(DOWN, turned).at(n)
    np.testing.assert_allclose((e[0] * e[1]).sum(axis=1), 0.0, atol=1e-12)
    np.testing.assert_allclose((e * n).sum(axis=2), 0.0, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(e, axis=2), 1.0, rtol=1e-12)
    np.testing.assert_allclose(np.cross(e[0], n), e[1], atol=1e-12)
    near = np.linalg.norm(n[1:] - n[:-1], axis=1)
    change = np.linalg.norm(e[0, 1:] - e[0, :-1], axis=1)
    small = near < 0.2
    assert np.all(change[small] <= 3.0 * near[small] + 1e-12)


def test_turned_frames_have_one_angle_everywhere():
    """requirement: another first axis at the pole turns all directions alike."""
    n = cap(1.2)
    one, other = TangentFrame(DOWN).at(n), TangentFrame(DOWN, 0.7).at(n)
    np.testing.assert_allclose((one[0] * other[0]).sum(axis=1), np.cos(0.7), atol=1e-12)
    np.testing.assert_allclose((one[1] * other[0]).sum(axis=1), np.sin(0.7), atol=1e-12)


def test_planes_of_symmetry_keep_their_directions():
    """requirement: normals in the plane y = 0 have one direction along y, others in that plane."""
    angle = np.linspace(-1.4, 1.4, 9)
    n = np.column_stack([np.sin(angle), np.zeros(9), -np.cos(angle)])
    e = frame_in_space(n, np.ones(9), DOWN).at(n)
    np.testing.assert_allclose(e[1], np.tile([0.0, 1.0, 0.0], (9, 1)), atol=1e-15)


def test_closed_faces_have_a_frame():
    """requirement: round a pin, whose mean normal vanishes, and for a load along its radius."""
    angle = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    n = np.column_stack([np.cos(angle), np.zeros(16), np.sin(angle)])
    frame = frame_in_space(n, np.ones(16), DOWN)
    e = frame.at(n)
    assert abs(frame.pole[1]) == 1.0
    np.testing.assert_allclose((e * n).sum(axis=2), 0.0, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(e, axis=2), 1.0, rtol=1e-12)

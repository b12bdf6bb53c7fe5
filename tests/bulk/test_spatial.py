"""Solids in space: hexahedra of any order, Hooke's law, thermal strain, sliding."""

from mpi4py import MPI

import numpy as np
import pytest
import ufl

from thermowear.bulk.kinematics import Spatial, kinematics_of
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.case.tables.conditions import MotionTable
from thermowear.contact.operators.rigid_motion import sliding

from ..contact.solids import HEIGHTS, MODULI, SIZE, bent, elastic_bodies, gathered, straight, turned
from ..contact.solids import two_solids as solids
from .fields import integral, interpolated, times

COMM = MPI.COMM_WORLD
DIVISIONS = ((3, 2, 2), (2, 3, 2))


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("place", [straight, bent, turned])
def test_the_bodies_have_their_volume(place, order):
    """requirement: nodes of cells of every order are numbered correctly."""
    bodies, _ = gathered(solids(DIVISIONS, order, (place, place)))
    for body, name, height in zip(bodies.each, MODULI, HEIGHTS, strict=True):
        only, dx = body.per_part({name: 1.0}), ufl.dx(domain=body.mesh)
        x, y, _ = ufl.SpatialCoordinate(body.mesh)
        volume, moment = integral(bodies, only * dx), integral(bodies, only * (x + 2 * y) * dx)
        if place is turned:
            allowed = {1: 0.2, 2: 2e-2, 3: 5e-4}[order]
            expected = height * np.pi / 4 * (0.09**2 - 0.05**2)
            assert volume == pytest.approx(expected, rel=allowed, abs=0.0)
            continue
        assert volume == pytest.approx(height * SIZE[0] * SIZE[1], rel=1e-10, abs=0.0)
        if place is straight:
            mean = SIZE[0] / 2 + SIZE[1]
            assert moment == pytest.approx(volume * mean, rel=1e-10, abs=0.0)


@pytest.mark.parametrize(("order", "degree"), [(1, 1), (1, 3), (2, 2), (3, 3)])
def test_uniform_strain(order, degree):
    """requirement: Hooke's law, without forces inside of distorted and curved cells."""
    bodies, _ = gathered(solids(DIVISIONS, order, (bent, bent)))
    elastic = elastic_bodies(bodies, degree, 0.3)
    H = 1e-3 * np.array([[1.0, -0.7, 0.2], [0.4, 2.0, 0.5], [-0.3, 0.1, -1.5]])
    displacement = interpolated(elastic.spaces, lambda x: H @ x)
    strain, E, ν = (H + H.T) / 2, MODULI["upper"], 0.3
    expected = E / (1 + ν) * (strain + ν / (1 - 2 * ν) * np.trace(strain) * np.eye(3))
    volume, upper = HEIGHTS[0] * SIZE[0] * SIZE[1], elastic.each[0]
    assert upper.body.parts == ("upper",)
    σ = upper.stress(elastic.spaces.functions(displacement, "u")[0])
    for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)):
        mean = integral(bodies, σ[i, j] * ufl.dx) / volume
        assert mean == pytest.approx(expected[i, j], rel=1e-9)
    forces = times(elastic.stiffness, displacement).reshape(-1, 3)
    places = elastic.nodes()
    low, high = (0.0, 0.0, -HEIGHTS[1]), (*SIZE, HEIGHTS[0])
    inside = np.all((places > np.add(low, 1e-6)) & (places < np.subtract(high, 1e-6)), axis=1)
    inside &= np.abs(places[:, 2]) > 1e-6
    assert inside.any()
    assert np.abs(forces[inside]).max() < 1e-8 * np.abs(forces).max()


def test_free_expansion_is_free_of_stress():
    """requirement: a uniform rise stretches a body by α ΔT in all directions."""
    bodies, _ = gathered(solids(DIVISIONS, 1, (bent, bent)))
    α, rise, ν = 1.2e-5, 80.0, 0.3
    elastic = elastic_bodies(bodies, 2, ν, α)
    heat = lagrange_spaces(bodies, 2)
    warm, grown = np.full(heat.owned, rise), interpolated(elastic.spaces, lambda x: α * rise * x)
    fields = elastic.spaces.functions(grown, "u"), heat.functions(warm, "rise")
    stresses = [body.stress(u, T) for body, u, T in zip(elastic.each, *fields, strict=True)]
    squares = integral(bodies, *(ufl.inner(σ, σ) * ufl.dx for σ in stresses))
    root_mean = (squares / (sum(HEIGHTS) * SIZE[0] * SIZE[1])) ** 0.5
    assert root_mean < 1e-11 * α * rise * MODULI["upper"]
    forces = elastic.thermal_load(heat).multiply(warm)
    left = times(elastic.stiffness, grown) - forces
    assert np.abs(left).max() < 1e-10 * np.abs(forces).max()


def test_no_thickness():
    model = kinematics_of("3d", None)
    assert isinstance(model, Spatial)
    points = np.random.default_rng(0).normal(size=(4, 3))
    np.testing.assert_array_equal(model.area_factor(points), 1.0)


@pytest.mark.parametrize("velocity", ["50 mm/s", "-50 mm/s"])
def test_sliding_along_x(velocity):
    """requirement: e is the unit direction in which body 1 slides."""
    motion, points = MotionTable(velocity=velocity), np.zeros((2, 3))
    normals = np.array([[0.0, 0.0, -1.0], [0.0, 0.6, -0.8]])
    slides = sliding(Spatial().sliding(points, motion), normals, (0.0, 0.0, -1.0))
    np.testing.assert_allclose(slides.speed, 0.05)
    expected = np.sign(motion.velocity) * np.array([[1.0, 0.0, 0.0]] * 2)
    np.testing.assert_allclose(slides.along, expected, atol=1e-12)


@pytest.mark.parametrize("turning", ["2 rad/s", "-2 rad/s"])
def test_a_turning_disk_drags_the_pad_along(turning):
    """requirement: seen from above, an anticlockwise disk drags a pad on the x-axis along y."""
    motion = MotionTable(angular_velocity=turning)
    points, center = np.array([[0.4, -0.2, 0.0], [0.1, 0.3, 0.0]]), (0.1, -0.2)
    normals = np.array([[0.0, 0.0, -1.0]] * 2)
    slides = sliding(Spatial().sliding(points, motion, center), normals, (0.0, 0.0, -1.0))
    np.testing.assert_allclose(slides.speed, [0.6, 1.0])
    dragged = -(slides.traction_direction(normals, 0.3, 0.0) - normals)
    sense = np.sign(motion.angular_velocity)
    np.testing.assert_allclose(dragged, sense * 0.3 * np.array([[0, 1, 0], [-1, 0, 0]]), atol=1e-12)

"""Plane strain, plane stress and axisymmetry, on straight and curved cells of both kinds."""

from mpi4py import MPI

import numpy as np
import pytest
import ufl
from dolfinx import fem

from thermowear.bulk.bodies import distribute
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.kinematics import Axisymmetric, PlaneStrain, PlaneStress, kinematics_of
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.case.tables.conditions import MotionTable
from thermowear.contact.operators.rigid_motion import sliding

from ..conftest import two_blocks
from .fields import integral, interpolated, times

E, ν, α = 2e11, 0.3, 1.2e-5
THICKNESS = 0.007
CELLS = [(False, 1), (True, 1), (False, 2), (True, 2), (False, 3), (True, 3)]
PLANE = [PlaneStrain(THICKNESS), PlaneStress(THICKNESS)]


def test_area_of_the_solid_per_length_of_its_section():
    """requirement: thickness of a plate; ``2 π r``, and its part in a sector, of a ring."""
    points = np.array([[0.02, 0.0], [0.05, 0.01]])
    for plane in PLANE:
        np.testing.assert_array_equal(plane.area_factor(points), THICKNESS)
    ring = [2 * np.pi * 0.02, 2 * np.pi * 0.05]
    np.testing.assert_allclose(Axisymmetric().area_factor(points), ring)
    np.testing.assert_allclose(Axisymmetric(0.25).area_factor(points), np.array(ring) / 4)


def bent(points):
    """Smooth map of all points after which the sides of cells are curved."""
    x, y = points[:, 0], points[:, 1]
    moved, raised = np.sin(90 * y + 20 * x), np.cos(70 * x) * np.sin(50 * y)
    return points + 2e-3 * np.column_stack([moved, raised])


def build(model, degree, triangles=False, order=1, clamped=()):
    tagged = two_blocks(triangles=triangles, order=order) if MPI.COMM_WORLD.rank == 0 else None
    if tagged is not None:
        tagged.points[:] = bent(tagged.points)
    bodies = distribute(tagged, MPI.COMM_WORLD)
    materials = dict.fromkeys(("upper", "lower"), ElasticMaterial(E, ν, α))
    return elasticity(bodies, model, degree, materials, list(clamped))


def nodal(elastic, function):
    return interpolated(elastic.spaces, function)


def hooke(model, e):
    """σ within the section of a strain within the section, by the textbook, 2 x 2 [Pa]."""
    if isinstance(model, PlaneStress):
        return E / (1 - ν**2) * ((1 - ν) * e + ν * np.trace(e) * np.eye(2))
    return E / (1 + ν) * (e + ν / (1 - 2 * ν) * np.trace(e) * np.eye(2))


@pytest.mark.parametrize(("triangles", "order"), CELLS)
@pytest.mark.parametrize("model", PLANE, ids=lambda m: m.name)
def test_linear_patch_on_curved_cells(model, triangles, order):
    """requirement: forces of a linear field are its tractions to 1e-12, degree >= the order."""
    elastic = build(model, max(order, 2), triangles, order, ("upper_end",))
    gradient = np.array([[1e-3, -4e-4], [2e-4, 7e-4]])
    strain = (gradient + gradient.T) / 2
    forces = times(elastic.stiffness, nodal(elastic, lambda x: gradient @ x[:2]))
    σ = ufl.as_matrix(hooke(model, strain).tolist())
    ds = ufl.ds(metadata={"quadrature_degree": 2 * max(order, 2) + 2 * order})
    normals = [ufl.FacetNormal(body.mesh) for body in elastic.bodies.each]
    tractions = elastic.spaces.loads(
        [lambda δu, n=n: THICKNESS * ufl.inner(σ * n, δu) * ds for n in normals]
    )
    assert forces == pytest.approx(tractions, abs=1e-11 * np.abs(tractions).max())


@pytest.mark.parametrize("model", PLANE, ids=lambda m: m.name)
def test_free_expansion_is_free_of_stress(model):
    """requirement: free expansion by α T or (1 + ν) α T without stress."""
    elastic = build(model, 2, clamped=("upper_end",))
    rise, stretch = 80.0, 1.0 if isinstance(model, PlaneStress) else 1 + ν
    expanded = nodal(elastic, lambda x: stretch * α * rise * x[:2])
    spaces = lagrange_spaces(elastic.bodies, 2)
    heated = elastic.thermal_load(spaces).multiply(np.full(spaces.owned, rise))
    forces = times(elastic.stiffness, expanded)
    assert forces == pytest.approx(heated, abs=1e-10 * np.abs(heated).max())
    stresses = [
        body.stress(u, fem.Constant(body.body.mesh, rise))
        for body, u in zip(elastic.each, elastic.spaces.functions(expanded, "u"), strict=True)
    ]
    across = _mean(elastic, [σ[2, 2] for σ in stresses])
    expected = 0.0 if isinstance(model, PlaneStress) else -E * α * rise
    assert across == pytest.approx(expected, abs=1e-10 * E * α * rise)
    for i, j in ((0, 0), (1, 1), (0, 1)):
        assert _mean(elastic, [abs(σ[i, j]) for σ in stresses]) < 1e-10 * E * α * rise


def _mean(elastic, densities):
    """Mean over both blocks of a density in each."""
    meshes = [body.mesh for body in elastic.bodies.each]
    total = integral(
        elastic.bodies, *(f * ufl.dx(m) for f, m in zip(densities, meshes, strict=True))
    )
    return total / integral(elastic.bodies, *(fem.Constant(m, 1.0) * ufl.dx(m) for m in meshes))


def test_volumes():
    """requirement: plane models integrate over thickness, axisymmetric ones over the circle."""
    mesh = build(PlaneStrain(THICKNESS), 1, clamped=("upper_end",)).bodies.each[0].mesh
    one = fem.Constant(mesh, 1.0)
    section = fem.assemble_scalar(fem.form(one * ufl.dx(mesh)))
    plane = fem.assemble_scalar(fem.form(PLANE[0].integral(mesh, one, ufl.dx)))
    assert plane == pytest.approx(THICKNESS * section)
    x = ufl.SpatialCoordinate(mesh)
    moment = fem.assemble_scalar(fem.form(x[0] * ufl.dx(mesh)))
    ring = fem.assemble_scalar(fem.form(Axisymmetric().integral(mesh, one, ufl.dx)))
    assert ring == pytest.approx(2 * np.pi * moment)


def test_symmetric_side_rolls():
    """requirement: symmetry planes fix the normal displacement only."""
    materials = dict.fromkeys(("upper", "lower"), ElasticMaterial(E, ν))
    bodies = distribute(two_blocks(), MPI.COMM_WORLD)
    sides = ("upper_inside", "lower_inside")
    elastic = elasticity(bodies, PLANE[0], 2, materials, ["upper_end", "lower_end"], sides)
    load = nodal(elastic, lambda x: np.array([np.ones(x.shape[1]), -np.ones(x.shape[1])]))
    u, x = elastic.solve(load).reshape(-1, 2), elastic.nodes()
    side = (np.abs(x[:, 0] - 0.05) < 1e-12) & (x[:, 1] > -0.029) & (x[:, 1] < 0.019)
    assert side.sum() > 4
    assert np.abs(u[side, 0]).max() == 0.0
    assert np.abs(u[side, 1]).min() > 0.0


@pytest.mark.parametrize("velocity", ["50 mm/s", "-50 mm/s"])
def test_sliding_of_plane_models(velocity):
    """requirement: e is the unit direction, along the face, in which body 1 slides."""
    motion = MotionTable(velocity=velocity)
    normals = np.array([[0.0, -1.0], [0.6, -0.8], [-0.6, -0.8]])
    model = kinematics_of("plane-strain", 1.0)
    slides = sliding(model.sliding(normals, motion), normals, (0.0, -1.0))
    e = slides.along
    assert np.sign(e[:, 0]) == pytest.approx(np.sign(motion.velocity))
    assert (e * normals).sum(axis=1) == pytest.approx(0.0)
    assert np.linalg.norm(e, axis=1) == pytest.approx(1.0)
    assert slides.speed == pytest.approx(0.05)


def test_friction_of_the_slowest_sliding():
    """requirement: friction depends on the direction of sliding, not on its speed."""
    model, normals = kinematics_of("plane-strain", 1.0), np.array([[0.0, -1.0], [0.6, -0.8]])
    slow, fast = (
        sliding(model.sliding(normals, MotionTable(velocity=v)), normals, (0.0, -1.0)).along
        for v in ("1e-15 m/s", "1 m/s")
    )
    assert slow == pytest.approx(fast, abs=1e-12)


@pytest.mark.parametrize("model", ["plane-strain", "plane-stress"])
def test_sliding_across_a_section(model):
    """requirement: the given speed, without a component in the section."""
    normals = np.array([[0.0, -1.0], [0.6, -0.8]])
    moved = kinematics_of(model, 1.0).sliding(
        normals, MotionTable(velocity="-50 mm/s"), across=True
    )
    assert moved == pytest.approx(np.array([[0.0, 0.0, -0.05]] * 2))
    slides = sliding(moved, normals, (0.0, -1.0))
    assert slides.speed == pytest.approx(0.05)
    np.testing.assert_array_equal(slides.traction_direction(normals, 0.3, 0.0), normals)


@pytest.mark.parametrize("turning", ["2 rad/s", "-2 rad/s"])
def test_sliding_over_a_turning_disk(turning):
    """requirement: an anticlockwise disk drags a body on top of it along -x."""
    motion = MotionTable(angular_velocity=turning)
    angle = np.array([-0.4, 0.0, 0.7])
    outward = np.column_stack([np.sin(angle), np.cos(angle)])
    center = np.array([0.1, -0.2])
    velocity = kinematics_of("plane-strain", 1.0).sliding(center + 0.3 * outward, motion, center)
    slides = sliding(velocity, -outward, (0.0, -1.0))
    assert slides.speed == pytest.approx(0.6)
    assert (slides.along * outward).sum(axis=1) == pytest.approx(0.0)
    # friction's part of the traction
    dragged = -slides.traction_direction(-outward, 0.3, 0.0) - outward
    assert np.sign(dragged[:, 0]) == pytest.approx(-np.sign(motion.angular_velocity))
    assert np.linalg.norm(dragged, axis=1) == pytest.approx(0.3)


def test_transverse_friction_holds_back_on_a_cone():
    """requirement: across the sliding, friction carries part of the load of a conical face."""
    normals = np.array([[0.6, -0.8], [0.0, -1.0], [-0.6, -0.8]])
    velocity = np.tile([0.0, 0.0, 3.0], (3, 1))
    slides = sliding(velocity, normals, (0.0, -1.0))
    down = slides.traction_direction(normals, 0.25, 0.1) @ [0.0, -1.0]
    assert down == pytest.approx([0.8 + 0.1 * 0.6, 1.0, 0.8 + 0.1 * 0.6])

"""The mesh of the annular punch on a plate."""

from mpi4py import MPI

import numpy as np
import pytest

import thermowear as tw
from thermowear.bulk.bodies import distribute
from thermowear.bulk.kinematics import kinematics_of
from thermowear.case.tables.mesh import MeshTable
from thermowear.contact.faces.face import gather_face
from thermowear.contact.search.pairing import pair
from thermowear.geometry.geometries.annular_punch import AnnularPunch

from ..conftest import HOT
from .measure import edges
from .sound import check_mesh, fault


def mesh_of(*overrides):
    case = tw.load(HOT, overrides)
    return case, case.tagged_mesh()


def area(mesh, body):
    corners = mesh.points[mesh.cells[mesh.cell_tags == mesh.bodies.index(body) + 1]]
    x, y = corners[..., 0], corners[..., 1]
    return 0.5 * (x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1)).sum(axis=1)


@pytest.mark.parametrize(
    "overrides",
    [
        (),
        ("mesh.elements=5", "mesh.grading=1.0"),
        ("mesh.bodies.plate.elements=17",),
        ("mesh.elements=1",),
    ],
)
def test_bodies_are_filled(overrides):
    """requirement: quadrilaterals without inversion that fill both sections."""
    _, mesh = mesh_of(*overrides)
    punch, plate = area(mesh, "punch"), area(mesh, "plate")
    assert np.all(np.abs(np.sign(punch).sum()) == len(punch))
    assert np.abs(punch.sum()) == pytest.approx(0.1 * 0.05, rel=1e-12)
    assert np.abs(plate.sum()) == pytest.approx(0.14 * 0.1, rel=1e-12)


def test_surfaces_are_where_their_names_say():
    """requirement: tags by name, every boundary named, axis left free."""
    _, mesh = mesh_of()
    expected = {
        "punch_face": (1, 0.0),
        "punch_top": (1, 0.05),
        "punch_inside": (0, 0.02),
        "punch_outside": (0, 0.12),
        "plate_face": (1, 0.0),
        "plate_bottom": (1, -0.1),
        "plate_side": (0, 0.14),
    }
    assert set(expected) == set(mesh.surfaces)
    for surface, (axis, value) in expected.items():
        assert np.allclose(edges(mesh, surface)[..., axis], value, atol=1e-12), surface
    for face in ("punch_face", "plate_face"):
        r = edges(mesh, face)[..., 0]
        assert (r.min(), r.max()) == pytest.approx((0.02, 0.12), abs=1e-12)


def test_elements_and_grading_along_the_contact():
    """requirement: `mesh.elements` and `mesh.grading` mean what the case file says."""
    _, mesh = mesh_of("mesh.elements=12", "mesh.grading=0.3")
    h = np.sort(np.abs(np.diff(edges(mesh, "punch_face")[..., 0], axis=1)).ravel())
    assert len(h) == 12
    assert h[-1] / h[0] == pytest.approx(0.3**-3, rel=1e-6)


def test_bodies_may_be_divided_differently():
    """requirement: the contact sides of the two bodies need not match."""
    _, mesh = mesh_of("mesh.bodies.plate.elements=17", "mesh.bodies.plate.grading=0.5")
    assert len(edges(mesh, "punch_face")) == 12
    assert len(edges(mesh, "plate_face")) == 17


SIZES = {
    "inner_radius": "20 mm",
    "outer_radius": "120 mm",
    "punch_height": "50 mm",
    "plate_radius": "140 mm",
    "plate_height": "100 mm",
}


def punch(**changes):
    return AnnularPunch(type="annular-punch", **SIZES | changes)


CONES = {
    "rising": ({"face": "conical", "cone_angle": "65 deg"}, np.radians(65)),
    "falling": ({"face": "conical", "cone_angle": "125 deg"}, np.radians(125)),
    "level": ({"face": "conical", "cone_angle": "90 deg"}, np.pi / 2),
    "steep": (
        {
            "face": "conical",
            "cone_angle": "10.5 deg",
            "inner_radius": "110 mm",
        },
        np.radians(10.5),
    ),
}
TORI = {
    "flat": {"face": "toroidal", "torus_radius": "400 mm"},
    "round": {"face": "toroidal", "torus_radius": "75 mm"},
}
DIVISIONS = [({}, None), ({"elements": 10, "grading": 1.0}, None), ({}, (0.03, 0.1))]


def arc_area(geometry):
    """Area between the arc of a toroidal face and its tangent at the mean radius [m²]."""
    a = (geometry.outer_radius - geometry.inner_radius) / 2
    radius = geometry.torus_radius
    circle = a * np.sqrt(radius**2 - a**2) + radius**2 * np.arcsin(a / radius)
    return 2 * a * radius - circle


@pytest.mark.parametrize(("settings", "zone"), DIVISIONS)
@pytest.mark.parametrize(("changes", "angle"), CONES.values(), ids=CONES)
def test_a_conical_face(changes, angle, settings, zone):
    """
    requirement: nodes of both faces on the cone exactly, level at the mean radius and beside it.
    """
    geometry = punch(**changes)
    zone = zone if geometry.inner_radius < 0.03 else None
    mesh = geometry.build(MeshTable(**settings), zone)
    inner, outer = geometry.inner_radius, geometry.outer_radius
    # what the plate gains outside and loses inside; the trapezoids keep their heights at the middle
    rise = (outer - inner) / 2 / np.tan(angle)
    plate = 0.14 * 0.1 + rise * ((0.14 - outer) - inner)
    check_mesh(mesh, {"punch": (outer - inner) * 0.05, "plate": plate}, rel=1e-9)
    faces = [edges(mesh, face) for face in geometry.contact]
    for face in faces:
        r, z = face.reshape(-1, 2).T
        exact = (r - (inner + outer) / 2) * np.cos(angle) / np.sin(angle)
        np.testing.assert_allclose(z, exact, atol=1e-9 * outer)
    r_1, r_2 = (np.unique(face[..., 0].round(12)) for face in faces)
    np.testing.assert_allclose(r_1, r_2, rtol=1e-9)
    check_level(mesh)


@pytest.mark.parametrize(("settings", "zone"), DIVISIONS)
@pytest.mark.parametrize("changes", TORI.values(), ids=TORI)
def test_a_toroidal_face(changes, settings, zone):
    """
    requirement: nodes of both faces on the torus exactly; it bulges downwards in the middle.
    """
    geometry = punch(**changes)
    mesh = geometry.build(MeshTable(**settings), zone)
    lost, radius = arc_area(geometry), geometry.torus_radius
    edge = radius - np.sqrt(radius**2 - 0.05**2)
    sections = {"punch": 0.1 * 0.05 - lost, "plate": 0.14 * 0.1 + lost + 0.04 * edge}
    check_mesh(mesh, sections, rel=1e-6)
    faces = [edges(mesh, face) for face in geometry.contact]
    for face in faces:
        assert face.shape[1] == 4
        r, z = face.reshape(-1, 2).T
        np.testing.assert_allclose(np.hypot(r - 0.07, z - radius), radius, rtol=1e-9)
        assert np.all(z < radius)
    rows = [np.unique(face.reshape(-1, 2).round(11), axis=0) for face in faces]
    np.testing.assert_allclose(*rows, atol=1e-9 * 0.12)
    check_level(mesh)


def check_level(mesh):
    """Top of the punch, bottom of the plate and all sides stay as they are with flat faces."""
    inner = edges(mesh, "punch_inside")[..., 0].min()
    places = {
        "punch_top": (1, 0.05),
        "punch_inside": (0, inner),
        "punch_outside": (0, 0.12),
        "plate_bottom": (1, -0.1),
        "plate_side": (0, 0.14),
    }
    for surface, (axis, value) in places.items():
        np.testing.assert_allclose(edges(mesh, surface)[..., axis], value, atol=1e-12)


@pytest.mark.parametrize(("changes", "angle"), CONES.values(), ids=CONES)
def test_normals_of_a_cone(changes, angle):
    """
    requirement: the cone angle lies between the axis and the face that rises outwards.
    """
    tagged = punch(**changes).build(MeshTable(), None)
    face = gather_face(distribute(tagged, MPI.COMM_SELF), "punch_face")
    facets = np.arange(len(face.nodes))
    normals = face.normals(facets, np.full(len(facets), 0.4))
    expected = np.broadcast_to([np.cos(angle), -np.sin(angle)], normals.shape)
    np.testing.assert_allclose(normals, expected, atol=1e-9)


def test_faces_of_a_torus_pair():
    """
    requirement: faces that are divided differently lie on one another, and their area is right.
    """
    geometry = punch(**TORI["round"])
    settings = MeshTable(bodies={"plate": {"elements": 17}})
    bodies = distribute(geometry.build(settings, None), MPI.COMM_SELF)
    faces = [gather_face(bodies, name) for name in geometry.contact]
    pairing = pair(*faces, kinematics_of("axisymmetric", None), 9)
    np.testing.assert_allclose(pairing.gap, 0.0, atol=2e-6 * 0.075)
    half_angle = np.arcsin(50 / 75)
    exact = 2 * np.pi * 0.07 * 2 * half_angle * 0.075  # Pappus
    assert pairing.weights.sum() == pytest.approx(exact, rel=1e-6)
    seen = pairing.weights @ -pairing.normals[:, 1]
    assert seen == pytest.approx(geometry.contact_area(), rel=1e-7)


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"face": "conical"}, "cone_angle"),
        ({"face": "toroidal"}, "torus_radius"),
        ({"cone_angle": "60 deg"}, "cone_angle"),
        ({"face": "conical", "cone_angle": "60 deg", "torus_radius": "1 m"}, "torus_radius"),
        ({"face": "conical", "cone_angle": "0 deg"}, "cone_angle"),
        ({"face": "conical", "cone_angle": "-60 deg"}, "cone_angle"),
        ({"face": "conical", "cone_angle": "175 deg"}, "cone_angle"),
        ({"face": "conical", "cone_angle": "45 deg"}, "cone_angle"),  # deeper than the punch
        ({"face": "toroidal", "torus_radius": "50.5 mm"}, "torus_radius"),
        ({"face": "toroidal", "torus_radius": "55 mm", "punch_height": "20 mm"}, "torus_radius"),
        ({"inner_radius": "120 mm"}, "inner_radius"),
        ({"plate_radius": "120 mm"}, "plate_radius"),
    ],
)
def test_sizes_that_do_not_fit(changes, key):
    """
    requirement: one clear line with the key's path.
    """
    assert fault(punch, **changes)[0] == key

"""The mesh of a beam above a foundation."""

from mpi4py import MPI

import numpy as np
import pytest
import ufl
from dolfinx.mesh import meshtags

from thermowear.bulk.bodies import distribute
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.kinematics import kinematics_of
from thermowear.case.tables.mesh import MeshTable
from thermowear.geometry.geometries.beam_on_foundation import BeamOnFoundation

from .measure import ends, unnamed
from .sound import check_mesh, check_surfaces, fault, spans

SIZES = {
    "length": "300 mm",
    "height": "25 mm",
    "thickness": "10 mm",
    "load_position": "150 mm",
    "load_width": "10 mm",
    "gap": "0.05 mm",
    "foundation_height": "10 mm",
}


def beam(**changes):
    return BeamOnFoundation(type="beam-on-foundation", **SIZES | changes)


@pytest.mark.parametrize("elements", [1, 3, 12, 40, 101])
def test_beam_and_foundation(elements):
    """
    requirement: well-shaped cells fill both bodies, a gap apart; every boundary edge named.
    """
    mesh = beam().build(MeshTable(elements=elements), None)
    check_mesh(mesh, {"beam": 0.3 * 0.025, "foundation": 0.3 * 0.01}, shape=0.999)
    assert unnamed(mesh) == 0
    places = {
        "beam_face": (1, 5e-5),
        "beam_clamp": (0, 0.0),
        "beam_support": (0, 0.3),
        "beam_load": (1, 0.02505),
        "beam_top": (1, 0.02505),
        "foundation_face": (1, 0.0),
        "foundation_left": (0, 0.0),
        "foundation_right": (0, 0.3),
        "foundation_bottom": (1, -0.01),
    }
    check_surfaces(mesh, places)
    assert spans(mesh, "beam_load") == [pytest.approx((0.145, 0.155))]
    assert spans(mesh, "beam_face") == [pytest.approx((0.0, 0.3))]


@pytest.mark.parametrize("elements", [12, 40, 101])
@pytest.mark.parametrize("position", ["20 mm", "150 mm", "213.7 mm"])
def test_elements_are_equally_long(elements, position):
    """
    requirement: the asked elements along the contact, alike but for the ends of the load.
    """
    mesh = beam(load_position=position).build(MeshTable(elements=elements), None)
    x, opposite = ends(mesh, "beam_face"), ends(mesh, "foundation_face")
    assert len(x) == elements + 1
    np.testing.assert_allclose(x, opposite, atol=1e-12)
    sizes = np.diff(x)
    assert sizes.max() < 1.35 * 0.3 / elements
    rows = (mesh.cell_tags == 1).sum() / elements, (mesh.cell_tags == 2).sum() / elements
    assert 2 <= rows[0] <= 4
    assert 1 <= rows[1] <= 3


def test_supports():
    """
    requirement: clamped on the left, on rollers on the right, nothing pressed by a mean pressure.
    """
    assert beam().held == "beam_clamp"
    assert beam().rollers == ("beam_support",)
    assert beam().contact_area() is None
    assert beam(gap="0 mm").build(MeshTable(), None).points[:, 1].max() == pytest.approx(0.025)


def deflection(geometry, modulus, force):
    """Deflection of the lower face at the middle of the load, without contact [m]."""
    bodies = distribute(geometry.build(MeshTable(elements=40), None), MPI.COMM_SELF)
    model = kinematics_of("plane-stress", geometry.thickness_factor)
    steel = ElasticMaterial(modulus, 0.3, 0.0)
    elastic = elasticity(
        bodies,
        model,
        4,
        {"beam": steel, "foundation": steel},
        [geometry.held, geometry.fixed],
        geometry.symmetry,
        geometry.rollers,
    )
    pressure = force / (geometry.thickness * geometry.load_width)

    def pushed(body):
        facets = np.sort(body.facets("beam_load"))
        loaded = meshtags(body.mesh, 1, facets, np.ones(len(facets), dtype=np.int32))
        measure = ufl.Measure("ds", body.mesh, subdomain_data=loaded)(1)
        return lambda v: model.integral(body.mesh, -pressure * v[1], measure)

    load = elastic.spaces.loads(map(pushed, bodies.each))
    assert load.sum() == pytest.approx(-force, rel=1e-12)
    moved, places = elastic.solve(load).reshape(-1, 2), elastic.nodes()
    below = np.array([geometry.load_position, geometry.gap])
    return -moved[np.linalg.norm(places - below, axis=1).argmin(), 1]


@pytest.mark.parametrize("position", [100, 150, 200])
def test_a_slender_beam_bends_as_it_is_supported(position):
    """
    requirement: ``F a³ b² (3 L + b) / (12 E I L³)`` under a load at a, b from clamp and support.
    """
    geometry = beam(height="5 mm", load_position=f"{position} mm")
    a, b, length, force, modulus = position * 1e-3, 0.3 - position * 1e-3, 0.3, 1e4, 2.1e11
    inertia = 0.01 * 0.005**3 / 12
    exact = force * a**3 * b**2 * (3 * length + b) / (12 * modulus * inertia * length**3)
    assert deflection(geometry, modulus, force) == pytest.approx(exact, rel=2e-3)


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"load_position": "5 mm"}, "load_position"),
        ({"load_position": "299 mm"}, "load_position"),
        ({"load_width": "300 mm"}, "load_position"),
        ({"gap": "-1 um"}, "gap"),
    ],
)
def test_sizes_that_do_not_fit(changes, key):
    """
    requirement: one clear line with the key's path.
    """
    assert fault(beam, **changes)[0] == key

"""The mesh of pads on a disk."""

import numpy as np
import pytest

from thermowear.case.tables.mesh import MeshTable
from thermowear.geometry.geometries.brakes.disk_brake import DiskBrake

from .measure import ends, unnamed
from .sound import check_mesh, check_surfaces, fault, spans

SIZES = {
    "pad_inner_radius": "80 mm",
    "pad_outer_radius": "120 mm",
    "pad_thickness": "12 mm",
    "pad_angle": "60 deg",
    "disk_inner_radius": "60 mm",
    "disk_outer_radius": "130 mm",
    "disk_thickness": "20 mm",
}


def brake(**changes):
    return DiskBrake(type="disk-brake", **SIZES | changes)


@pytest.mark.parametrize("zone", [None, (0.08, 0.1), (0.09, 0.115)])
@pytest.mark.parametrize(
    "settings", [{}, {"elements": 5, "grading": 1.0}, {"elements": 1}, {"elements": 30}]
)
def test_pad_and_half_the_disk(settings, zone):
    """
    requirement: well-shaped cells fill the pad and half the disk; every boundary edge named.
    """
    mesh = brake().build(MeshTable(**settings), zone)
    check_mesh(mesh, {"pad": 0.04 * 0.012, "disk": 0.07 * 0.01}, shape=0.999)
    assert unnamed(mesh) == 0
    places = {
        "pad_face": (1, 0.0),
        "pad_back": (1, 0.012),
        "pad_inside": (0, 0.08),
        "pad_outside": (0, 0.12),
        "disk_face": (1, 0.0),
        "disk_rest": (1, 0.0),
        "disk_middle": (1, -0.01),
        "disk_inside": (0, 0.06),
        "disk_outside": (0, 0.13),
    }
    check_surfaces(mesh, places)
    assert spans(mesh, "disk_face") == [pytest.approx((0.08, 0.12))]
    assert spans(mesh, "disk_rest") == [pytest.approx((0.06, 0.08)), pytest.approx((0.12, 0.13))]


def test_faces_are_divided_alike_up_to_the_edge_of_contact():
    """
    requirement: element ends agree on both faces, and lie at the ends of the contact.
    """
    mesh = brake().build(MeshTable(), None)
    assert len(ends(mesh, "pad_face")) == 13
    np.testing.assert_allclose(ends(mesh, "pad_face"), ends(mesh, "disk_face"), rtol=1e-12)
    parted = ends(brake().build(MeshTable(), (0.08, 0.1073)), "pad_face")
    assert np.abs(parted - 0.1073).min() < 1e-12


def test_what_a_sector_takes_up():
    """
    requirement: a mean pressure presses on the pads only, at any unit of their angle.
    """
    sixth = brake()
    assert sixth.sector == pytest.approx(1 / 6, rel=1e-12)
    assert sixth.contact_area() == pytest.approx(np.pi * (0.12**2 - 0.08**2) / 6, rel=1e-12)
    assert brake(pad_angle="1.5 rad").sector == pytest.approx(1.5 / (2 * np.pi), rel=1e-12)
    assert brake(pad_angle="360 deg").sector == pytest.approx(1.0, rel=1e-12)
    assert DiskBrake.model_validate(sixth.model_dump()) == sixth


def test_a_pad_as_wide_as_the_disk():
    """
    requirement: the edges are shared, whatever unit they are written in; no empty surface.
    """
    geometry = brake(disk_inner_radius="0.08 m", disk_outer_radius="12 cm")
    mesh = geometry.build(MeshTable(), None)
    check_mesh(mesh, {"pad": 0.04 * 0.012, "disk": 0.04 * 0.01}, shape=0.999)
    assert unnamed(mesh) == 0
    assert mesh.surfaces == geometry.surfaces
    assert "disk_rest" not in mesh.surfaces
    np.testing.assert_allclose(ends(mesh, "pad_face"), ends(mesh, "disk_face"), rtol=1e-12)


@pytest.mark.parametrize(("side", "span"), [("inner", (0.12, 0.13)), ("outer", (0.06, 0.08))])
def test_a_pad_that_ends_where_the_disk_ends_on_one_side(side, span):
    """
    requirement: what the pad leaves of the disk's face is the rest, on the other side only.
    """
    radius = {"inner": "80 mm", "outer": "120 mm"}[side]
    mesh = brake(**{f"disk_{side}_radius": radius}).build(MeshTable(), None)
    assert spans(mesh, "disk_rest") == [pytest.approx(span)]
    assert spans(mesh, "disk_face") == [pytest.approx((0.08, 0.12))]


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"disk_inner_radius": "81 mm"}, "disk_inner_radius"),
        ({"pad_inner_radius": "120 mm"}, "pad_inner_radius"),
        ({"disk_outer_radius": "119 mm"}, "pad_outer_radius"),
        ({"pad_angle": "361 deg"}, "pad_angle"),
        ({"pad_angle": "0 deg"}, "pad_angle"),
        ({"pad_angle": "-10 deg"}, "pad_angle"),
    ],
)
def test_sizes_that_do_not_fit(changes, key):
    """
    requirement: one clear line with the key's path.
    """
    assert fault(brake, **changes)[0] == key

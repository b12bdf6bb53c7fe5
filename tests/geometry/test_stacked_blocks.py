"""The mesh of two blocks of one width between planes of symmetry."""

import numpy as np
import pytest

from thermowear.case.tables.mesh import MeshTable
from thermowear.geometry.geometries.stacked import StackedBlocks

from .measure import edges, ends, unnamed
from .sound import check_mesh, fault, spans

SIZES = {
    "width": "10 mm",
    "upper_height": "30 mm",
    "lower_height": "4 mm",
    "thickness": "7 mm",
}
SIDES = ("upper_side", "lower_side")


def blocks(**changes):
    return StackedBlocks(type="stacked-blocks", **SIZES | changes)


def rows(mesh, side, at=0.0):
    """y at the ends of the rows of a block, away from the contact [m]."""
    found = edges(mesh, side)[:, :2]
    y = np.unique(np.round(found[np.abs(found[..., 0] - at) < 1e-12][:, 1], 12))
    return y[np.abs(y).argsort()]


@pytest.mark.parametrize(
    "settings", [{}, {"elements": 5, "grading": 1.0}, {"elements": 1}, {"elements": 30}]
)
def test_two_blocks(settings):
    """
    requirement: well-shaped cells fill both blocks; every boundary edge named.
    """
    mesh = blocks().build(MeshTable(**settings))
    check_mesh(mesh, {"upper": 0.01 * 0.03, "lower": 0.01 * 0.004}, shape=0.999)
    assert unnamed(mesh) == 0
    sides = {side: edges(mesh, side)[..., 0] for side in SIDES}
    for x in sides.values():
        assert {float(v) for v in x[:, 0]} == {0.0, 0.01}
        np.testing.assert_array_equal(x[:, 0], x[:, 1])
    places = {
        "upper_face": (1, 0.0),
        "upper_top": (1, 0.03),
        "lower_face": (1, 0.0),
        "lower_bottom": (1, -0.004),
    }
    level = [mesh.surfaces.index(name) + 1 for name in places]
    kept = np.isin(mesh.facet_tags, level)
    assert kept.sum() == 4 * MeshTable(**settings).elements
    for name in places:
        assert spans(mesh, name) == [pytest.approx((0.0, 0.01))]
        np.testing.assert_allclose(edges(mesh, name)[..., 1], places[name][1], atol=1e-15)


def test_faces_are_divided_evenly_and_alike():
    """
    requirement: nothing is singular at a plane of symmetry; element ends agree on both faces.
    """
    mesh = blocks().build(MeshTable(elements=8))
    np.testing.assert_allclose(ends(mesh, "upper_face"), np.linspace(0, 0.01, 9), atol=1e-15)
    np.testing.assert_allclose(ends(mesh, "lower_face"), np.linspace(0, 0.01, 9), atol=1e-15)


def test_faces_of_their_own():
    """
    requirement: each block may be divided by its own numbers.
    """
    own = {"lower": {"elements": 3, "grading": 1.0}}
    mesh = blocks().build(MeshTable(elements=8, grading=0.5, bodies=own))
    assert len(ends(mesh, "upper_face")) == 9
    assert len(ends(mesh, "lower_face")) == 4
    np.testing.assert_allclose(np.diff(np.abs(rows(mesh, "lower_side"))), 0.004 / 3, rtol=1e-9)


@pytest.mark.parametrize(("side", "end"), [("upper_side", 0.03), ("lower_side", -0.004)])
def test_rows_are_thin_at_the_contact(side, end):
    """
    requirement: the last three rows shrink by the grading; the others are equal.
    """
    mesh = blocks().build(MeshTable(elements=8, grading=0.25))
    y = rows(mesh, side)
    assert y[0] == 0.0
    assert y[-1] == pytest.approx(end, rel=1e-12)
    sizes = np.abs(np.diff(y))
    np.testing.assert_allclose(sizes[1:4] / sizes[:3], 4.0, rtol=1e-6)
    np.testing.assert_allclose(sizes[4:] / sizes[4], 1.0, rtol=1e-6)
    assert sizes[-1] == pytest.approx(abs(end) / 8, rel=0.15)
    np.testing.assert_array_equal(rows(mesh, side, at=0.01), y)


def test_what_it_stands_for():
    """
    requirement: forces are of the thickness as given; both sides of both are planes of symmetry.
    """
    geometry = blocks()
    assert geometry.contact_area() == pytest.approx(0.01 * 0.007, rel=1e-12)
    assert geometry.thickness_factor == pytest.approx(0.007, rel=1e-12)
    assert geometry.symmetry == SIDES
    assert geometry.slides_across
    assert geometry.track is None
    assert not geometry.follows_contact


@pytest.mark.parametrize("key", ["width", "upper_height", "lower_height"])
def test_sizes_that_do_not_fit(key):
    """
    requirement: one clear line with the key's path.
    """
    assert fault(blocks, **{key: "0 mm"})[0] == key

"""Meshes of a strip between two cylinders or punches."""

from __future__ import annotations

import numpy as np
import pytest

from thermowear.case.tables.mesh import MeshTable
from thermowear.errors import CaseError
from thermowear.geometry.geometries.strip_between import (
    StripBetweenCylinders,
    StripBetweenPunches,
)

from .measure import unnamed
from .sound import check_mesh

R, WIDTH, HEIGHT, PUNCH, LENGTH = 6e-3, 24e-3, 10e-3, 10e-3, 60e-3
MESH = MeshTable(elements=12, grading=1.0)


def cylinders(**changes) -> StripBetweenCylinders:
    keys = {"radius": "6 mm", "strip_width": "24 mm", "strip_height": "10 mm", "zone": "0.3 mm"}
    return StripBetweenCylinders(type="strip-between-cylinders", **keys | changes)


def punches(**changes) -> StripBetweenPunches:
    keys = {"width": "10 mm", "height": "8 mm", "strip_length": "60 mm", "strip_height": "10 mm"}
    return StripBetweenPunches(type="strip-between-punches", **keys | {"stroke": "5 mm"} | changes)


@pytest.mark.parametrize(
    ("geometry", "body", "strip"),
    [
        (cylinders(), np.pi * R**2 / 2, WIDTH * HEIGHT),
        (punches(), PUNCH * 8e-3, LENGTH * HEIGHT),
    ],
)
def test_areas_and_names(geometry, body, strip):
    """requirement: areas of all bodies, well shaped cells; every edge has one name."""
    mesh = geometry.build(MESH)
    check_mesh(mesh, {"upper": body, "strip": strip, "lower": body}, rel=2e-4)
    assert mesh.surfaces == geometry.surfaces
    assert unnamed(mesh) == 0
    lengths = {name: mesh.points[mesh.facets_of(name)] for name in mesh.surfaces}
    for name, side in (("strip_left", -1), ("strip_right", 1)):
        ends = lengths[name]
        assert np.all(side * ends[..., 0] > 0.0)
        assert np.ptp(ends[..., 1]) == pytest.approx(HEIGHT, rel=1e-12)
    for side, sign in (("upper", 1), ("lower", -1)):
        np.testing.assert_allclose(lengths[f"strip_{side}"][..., 1], sign * HEIGHT / 2, rtol=1e-12)
        lowest = (sign * lengths[f"{side}_face"][..., 1]).min()
        assert lowest == pytest.approx(HEIGHT / 2, rel=1e-9)


@pytest.mark.parametrize("make", [cylinders, punches])
def test_the_half_is_the_upper_part(make):
    """requirement: the same nodes above the line of symmetry, which is the strip's middle."""
    whole, half = make().build(MESH), make(half=True).build(MESH)
    assert half.bodies == ("upper", "strip")
    middle = half.points[half.facets_of("strip_middle")]
    np.testing.assert_allclose(middle[..., 1], 0.0, atol=1e-15)
    np.testing.assert_array_equal(whole.points[: len(half.points)], half.points)
    lower = whole.points[len(half.points) :]
    assert np.all(lower[:, 1] < 0.0)
    assert len(lower) == (half.points[:, 1] > 1e-12).sum()


def test_what_cannot_be_meshed():
    """requirement: a zone beyond the cylinder, a strip shorter than the stroke, an own mesh of the
    lower body.
    """
    with pytest.raises(ValueError, match="too large for this radius"):
        cylinders(zone="4 mm")
    with pytest.raises(ValueError, match="must be greater than the way of a punch"):
        punches(strip_length="20 mm")
    with pytest.raises(CaseError, match=r"mesh\.bodies\.lower"):
        cylinders().build(MeshTable(bodies={"lower": {"elements": 4}}))

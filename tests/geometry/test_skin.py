"""Rows at the contact faces that resolve a thermal skin."""

import numpy as np
import pytest

from thermowear.case import load
from thermowear.errors import CaseError

from ..case.starter import tables

SKIN = 2e-5


def nodes(name, **changes):
    """Distances of the mesh nodes from the contact, of both sides, and their other coordinate."""
    mesh = load(tables(name, changes)).tagged_mesh()
    y, x = mesh.points[:, 1], mesh.points[:, 0]
    contact = 0.0 if name != "clutch-pack" else None
    return np.unique(np.round(y - (contact or 0.0), 12)), np.unique(np.round(x, 12))


@pytest.mark.parametrize("name", ["disk-brake-stability", "stacked-blocks", "annular-punch"])
def test_first_rows(name):
    """requirement: first rows of both bodies as thin as the skin, the columns as without it."""
    y, x = nodes(name, **{"mesh.skin": f"{SKIN} m"})
    plain, columns = nodes(name)
    np.testing.assert_array_equal(x, columns)
    for side in (y[y > 0][0], -y[y < 0][-1]):
        assert 0.5 * SKIN < side < 1.5 * SKIN
    assert plain[plain > 0][0] > 2 * SKIN
    steps = np.diff(y[y >= 0])
    assert (steps[1:] / steps[:-1]).max() < 1.2 / load(tables(name, {})).mesh.grading


def test_thick_skin():
    """requirement: a skin thicker than the rows changes nothing."""
    name = "disk-brake-stability"
    for with_skin, without in zip(nodes(name, **{"mesh.skin": "1 m"}), nodes(name), strict=True):
        np.testing.assert_array_equal(with_skin, without)


def test_stack():
    """requirement: rows at all faces between the layers of a stack."""
    given = tables("clutch-pack", {"mesh.skin": f"{SKIN} m"})
    case = load(given)
    mesh = case.tagged_mesh()
    ends = np.cumsum([0.0, *(-layer.height for layer in case.geometry.layers.values())])[1:-1]
    ends += next(iter(case.geometry.layers.values())).height - 0.0
    y = np.unique(np.round(mesh.points[:, 1], 12))
    faces = y[np.flatnonzero(np.diff(y) < 1.5 * SKIN)]
    assert len(faces) >= len(ends)


def test_refused():
    """requirement: meshes without rows along the contact have no skin."""
    with pytest.raises(CaseError, match=r"mesh.skin: the mesh of 'cylinder-on-block' has no rows"):
        load(tables("cylinder-on-block", {"mesh.skin": "1 um"}))

"""Rows at the contact faces that resolve a thermal skin."""

import numpy as np
import pytest

from thermowear.case import load
from thermowear.errors import CaseError

from ..case.starter import tables

SKIN = 2e-5


def nodes(name, **changes):
    """Coordinates of the mesh nodes across the contact at y = 0, and along it."""
    x, y = load(tables(name, changes)).tagged_mesh().points.T
    return np.unique(np.round(y, 12)), np.unique(np.round(x, 12))


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
    case = load(tables("clutch-pack", {"mesh.skin": f"{SKIN} m", "mesh.grading": 0.5}))
    heights = [layer.height for layer in case.geometry.layers.values()]
    faces = heights[0] - np.cumsum(heights)[:-1]
    y = np.unique(np.round(case.tagged_mesh().points[:, 1], 12))
    for face in faces:
        k = int(np.argmin(np.abs(y - face)))
        assert np.diff(y[k - 1 : k + 2]).max() < 1.5 * SKIN


def test_equal_rows():
    """requirement: rows that do not grow have no thinner first one."""
    with pytest.raises(CaseError, match=r"mesh.skin: the rows grow by mesh.grading"):
        load(tables("disk-brake-stability", {"mesh.skin": "1 um", "mesh.grading": 1.0}))


def test_refused():
    """requirement: meshes without rows along the contact have no skin."""
    with pytest.raises(CaseError, match=r"mesh.skin: the mesh of 'cylinder-on-block' has no rows"):
        load(tables("cylinder-on-block", {"mesh.skin": "1 um"}))

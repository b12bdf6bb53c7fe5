"""Projected areas of contact faces in space."""

from dataclasses import replace

import numpy as np
import pytest

from thermowear.geometry.checks.solid_pairs import projected_area
from thermowear.geometry.meshing.cells import level, mesh_lattice, tagged_bodies

RADIUS, LENGTH = 5e-3, 20e-3


@pytest.mark.parametrize("angle", [np.pi, 2 * np.pi])
def test_shaft_seen_across_its_axis(angle):
    """requirement: half of a shaft and a whole one show 2 R L across their axis, 1e-4 by chords of
    order 2; the other half of the whole one does not cancel it.
    """
    lattice = (np.array([3e-3, RADIUS]), np.linspace(0, angle, 17), np.array([0, LENGTH]))
    body = mesh_lattice(lattice, 2, closed=angle > 6.0)
    tagged = tagged_bodies({"shaft": body}, {"shaft_face": level(0, RADIUS)})
    r, φ, along = tagged.points.T
    turned = replace(tagged, points=np.column_stack([r * np.cos(φ), along, r * np.sin(φ)]))
    assert projected_area(turned, "shaft_face") == pytest.approx(2 * RADIUS * LENGTH, rel=1e-4)

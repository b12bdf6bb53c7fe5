"""Relative position of contact faces in space."""

import numpy as np
import pytest

from thermowear.geometry.checks.solid_pairs import projected_area
from thermowear.geometry.mesh.tagged import TaggedMesh


def bore(columns: int) -> TaggedMesh:
    """Hexahedra round a bore of radius 1 along y of length 3; its face is S."""
    angles = np.linspace(0, 2 * np.pi, columns, endpoint=False)
    points = np.array(
        [(r * np.cos(a), y, r * np.sin(a)) for r in (1.0, 2.0) for y in (0.0, 3.0) for a in angles]
    )
    one = np.arange(columns)
    two = np.roll(one, -1)
    inner = np.column_stack([one, two, two + columns, one + columns])
    cells = np.hstack([inner, inner + 2 * columns])
    ones = np.ones(columns, np.int32)
    return TaggedMesh(points, "hexahedron", cells, ones, inner, ones, ("b",), ("S",))


def test_projected_area_of_a_bore():
    """
    requirement: the area of a bore that a load across its axis can press on is that of its half,
    2 R L, not the difference of both halves, which is nothing.
    """
    assert projected_area(bore(64), "S") == pytest.approx(2 * 1.0 * 3.0, rel=1e-3)

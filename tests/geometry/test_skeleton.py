"""The lines that bound the parts of a body."""

import numpy as np
import pytest

from tests.conftest import two_blocks
from thermowear.geometry.moving.skeleton import skeleton
from thermowear.verification.check import starter


@pytest.mark.parametrize("order", [1, 2])
def test_a_block_has_four_sides(order):
    mesh = two_blocks(order=order, columns=(3, 3), rows=(2, 2))
    face = np.unique(mesh.facets[mesh.facet_tags == mesh.surfaces.index("upper_face") + 1])
    lines = skeleton(mesh, ("upper",), face)
    assert sorted(len(line.edges) for line in lines) == [2, 2, 3, 3]
    assert {mesh.surfaces[line.surface - 1] for line in lines} == {
        "upper_face",
        "upper_end",
        "upper_inside",
        "upper_outside",
    }
    assert [mesh.surfaces[line.surface - 1] for line in lines if line.is_face] == ["upper_face"]
    for line in lines:
        assert line.parts.keys() == {1}
        assert np.array_equal(line.edges[1:, 0], line.edges[:-1, -1])
        way, middle = line.edges[0, -1] - line.edges[0, 0], line.edges[0].mean(axis=0)
        inward = np.array([0.07, 0.01]) - middle
        to_left = way[0] * inward[1] - way[1] * inward[0] > 0.0
        assert line.parts[1] == to_left
        assert line.backwards().parts[1] != to_left


def test_zones_share_their_border_and_rings_are_closed():
    case = starter("drum-brake")
    mesh, nothing = case.tagged_mesh(), np.empty(0, dtype=int)
    shoe = case.geometry.parts_of("shoe")
    (border,) = (line for line in skeleton(mesh, shoe, nothing) if len(line.parts) == 2)
    assert sorted(border.parts.values()) == [False, True]
    drum = skeleton(mesh, case.geometry.parts_of("drum"), nothing)
    assert any(line.ends[0] == line.ends[1] for line in drum)

"""Surfaces whose facets are numbered anew."""

from dataclasses import replace

import numpy as np
import pytest

from thermowear.contact.faces.face import renumbering
from thermowear.contact.wear.worn_face import nodes_of

from .solids import bent, gathered, straight
from .solids import two_solids as solids


def shuffled(order):
    """The upper face of two bodies before and after renumbering of cells and of their corners."""
    mesh = solids(((3, 3, 2), (2, 2, 2)), order, (bent, straight), "tetrahedron")
    rng = np.random.default_rng(3)
    cells = rng.permutation(len(mesh.cells))
    number = rng.permutation(len(mesh.points))
    points = np.empty_like(mesh.points)
    points[number] = mesh.points
    turn = {1: [1, 2, 0, 3], 2: [1, 2, 0, 3, 5, 6, 4, 9, 7, 8]}[order]
    new = replace(
        mesh,
        points=points,
        cells=number[mesh.cells[cells][:, turn]],
        cell_tags=mesh.cell_tags[cells],
        facets=number[mesh.facets],
    )
    return gathered(mesh)[1][0], gathered(new)[1][0]


@pytest.mark.parametrize("order", [1, 2])
def test_points_stay_in_place(order):
    former, new = shuffled(order)
    numbers = renumbering(former, nodes_of(former), new)
    assert np.any(numbers.facets != np.arange(len(former.nodes)))
    assert nodes_of(former)[numbers.nodes] == pytest.approx(nodes_of(new), abs=1e-15)
    assert numbers.of_facets(former.sizes) == pytest.approx(new.sizes, rel=1e-12, abs=0.0)
    t = np.array([(0.2, 0.3), (0.0, 0.0), (0.1, 0.9), (0.7, 0.0)])
    facet, t = former.on_each(t)
    assert new.points(*numbers.place(facet, t)) == pytest.approx(former.points(facet, t), abs=1e-15)


def test_another_surface():
    former, new = shuffled(1)
    other = replace(new, corners=new.corners[::-1], nodes=new.nodes[:, ::-1])
    with pytest.raises(ValueError, match="facets of upper_face differ"):
        renumbering(former, nodes_of(former), other)

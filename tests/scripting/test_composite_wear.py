"""Wear laws by cell tag of a body of several materials."""

from dataclasses import replace

from mpi4py import MPI

import dolfinx
import numpy as np
import pytest
from dolfinx.mesh import CellType, locate_entities_boundary, meshtags

import thermowear as tw

LEFT, RIGHT = 12, 13
WIDTH, HEIGHT, FORCE, SPEED = 0.03, 0.01, 600.0, 0.1
LAWS = {LEFT: tw.PowerWear(2e-14), RIGHT: tw.PowerWear(7e-14)}


def block(name, bottom, **sides):
    """Quadrilaterals; the cells of the right third have a tag of their own."""
    ends = [[0.0, bottom], [WIDTH, bottom + HEIGHT]]
    mesh = dolfinx.mesh.create_rectangle(MPI.COMM_SELF, ends, (6, 2), CellType.quadrilateral)
    count = mesh.topology.index_map(2).size_local
    middle = dolfinx.mesh.compute_midpoints(mesh, 2, np.arange(count, dtype=np.int32))
    of_cells = np.where(middle[:, 0] > 2 / 3 * WIDTH, RIGHT, LEFT).astype(np.int32)
    cells = meshtags(mesh, 2, np.arange(count, dtype=np.int32), of_cells)
    below, above = (
        locate_entities_boundary(mesh, 1, lambda x, y=y: np.isclose(x[1], y))
        for y in (bottom, bottom + HEIGHT)
    )
    facets = np.concatenate([below, above])
    tags = np.repeat(np.array([7, 8], np.int32), [len(below), len(above)])
    order = np.argsort(facets)
    marks = meshtags(mesh, 1, facets[order], tags[order])
    steel = tw.Material("2 GPa", 0.3)
    return tw.Body(name, mesh, cells, marks, {LEFT: steel, RIGHT: steel}, **sides)


@pytest.fixture(scope="module")
def model():
    upper, lower = block("upper", 0.0), block("lower", -HEIGHT, fixed=7)
    return tw.Model(
        [tw.Interface(upper.surface(7), lower.surface(8), wear={upper: LAWS})],
        [tw.Holder(upper.surface(8), force=FORCE)],
        motions={upper: tw.Translation(SPEED)},
        kinematics="plane-strain",
        thickness=0.02,
    )


def with_wear(model, wear):
    (face,) = model.interfaces
    return replace(model, interfaces=[replace(face, wear={face.one.body: wear})])


@pytest.mark.parametrize("kind", ["laws", "functions", "regions"])
def test_laws_by_cell_tag_or_region(model, kind):
    """
    requirement: each tag or region has its own law: p_i = p̄ k_eff/k_i, steady and run in.
    """
    if kind == "regions":
        regions = {"x < 20 mm": LAWS[LEFT], "x > 20 mm": LAWS[RIGHT]}
        model = with_wear(model, regions)
    if kind == "functions":
        model = with_wear(model, {LEFT: "2e-14/Pa*p*v", RIGHT: lambda p, v: 7e-14 * p * v})
    effective = 1 / ((2 / 3) / 2e-14 + (1 / 3) / 7e-14)
    known = np.array([7e-14, 2e-14])
    expected = FORCE / (WIDTH * 0.02) * effective / known
    for found, allowed in ((model.steady(), 1e-9), (model.transient("5e4 s"), 1e-3)):
        i = found.result.interface
        each = np.where(i.pressure > FORCE / (WIDTH * 0.02), expected[1], expected[0])
        np.testing.assert_allclose(i.pressure, each, rtol=allowed)
        assert np.all((i.x <= 2 / 3 * WIDTH + 1e-9) == (each == expected[1]) | at_border(i.x))


def at_border(x):
    return np.abs(x - 2 / 3 * WIDTH) < 1e-9


@pytest.mark.parametrize(
    ("wear", "message"),
    [
        ({14: LAWS[LEFT]}, r"Interface\.wear of 'upper': unknown cell tag 14; known: 12, 13"),
        ({LEFT: LAWS[LEFT]}, r"wear\.upper\.materials\.upper:13: missing; the contact face"),
        ({LEFT: LAWS[LEFT], RIGHT: "1 m/s"}, r"Interface\.wear of 'upper', tag 13: "),
        ({"x > 1": LAWS[LEFT]}, r"Interface\.wear of 'upper': in \"1\": "),
        ({"x > 9 mm": LAWS[LEFT]}, r"materials\.x > 9 mm\.where: the border of this region cuts"),
    ],
)
def test_faults(model, wear, message):
    with pytest.raises(tw.CaseError, match=message):
        with_wear(model, wear).steady()


def test_cyclic_analyses_refuse_them(model):
    """
    requirement: an analysis without support for them says so in one line.
    """
    with pytest.raises(
        tw.CaseError, match="a reciprocating analysis does not support contact faces"
    ):
        model.reciprocating("1 mm", "2 Hz", end_time=10.0)

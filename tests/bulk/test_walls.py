"""Walls of bodies that pass: round ones are, others would carry heat out."""

from itertools import permutations

import numpy as np
import pytest

from thermowear.bulk.bodies import distribute
from thermowear.bulk.heat.advection import Passage, require_swept
from thermowear.bulk.heat.heat_equation import conduction
from thermowear.bulk.kinematics import Spatial
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.errors import CaseError
from thermowear.geometry.mesh.tagged import TaggedMesh, compact

from .fields import empty_matrix, times
from .passing import COMM, STEEL, largest, total
from .passing import ring as flat_ring
from .passing import strip as flat_strip
from .test_advection import random_rise

INNER, OUTER, HEIGHT = 0.02, 0.1, 0.02
TURNING = Passage(("body",), (0.0, 0.0), 30.0, spread=False)
ALONG = Passage(("body",), None, 2.0, spread=False, contact=(0.04, 0.06))
_HEXAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
_CORNERS = np.concatenate([_HEXAHEDRON, _HEXAHEDRON + [0, 0, 1]])


def blocks(counts, place, closed, keep=None, split=False, second=None):
    """Lattice of cells, closed along the first index or not, with places of its nodes.

    Cells are kept, and of a second material, by their indices; or split into six tetrahedra. The
    facets at the end of the second index are the surface "rim".
    """
    cells = np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), -1).reshape(-1, 3)
    if keep is not None:
        cells = cells[keep(*cells.T)]
    nodes = np.add(counts, [0 if closed else 1, 1, 1])

    def number(at):
        at = at.copy()
        at[..., 0] %= nodes[0]
        return np.ravel_multi_index(np.moveaxis(at, -1, 0), nodes)

    shapes, sides = [_CORNERS], [np.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]])]
    if split:
        steps = [np.eye(3, dtype=int)[list(order)] for order in permutations(range(3))]
        shapes = [np.concatenate([[[0, 0, 0]], np.cumsum(step, axis=0)]) for step in steps]
        sides = [sides[0][[0, 1, 2]], sides[0][[0, 2, 3]]]
    last = cells[cells[:, 1] == counts[1] - 1] + [0, 1, 0]
    lattice = np.stack(np.meshgrid(*map(np.arange, nodes), indexing="ij"), -1).reshape(-1, 3)
    zone = np.ones(len(cells), dtype=np.int32)
    if second is not None:
        zone[second(*cells.T)] = 2
    mesh = TaggedMesh(
        points=place(*(lattice / counts).T),
        cell_type="tetrahedron" if split else "hexahedron",
        cells=np.concatenate([number(cells[:, None] + shape) for shape in shapes]),
        cell_tags=np.tile(zone, len(shapes)),
        facets=np.concatenate([number(last[:, None] + side) for side in sides]),
        facet_tags=np.ones(len(sides) * len(last), dtype=np.int32),
        bodies=("body",) if second is None else ("body", "insert"),
        surfaces=("rim",),
    )
    return distribute(compact(mesh) if COMM.rank == 0 else None, COMM)


def rotor(columns=24, meridian=None, off=(0.0, 0.0), tilt=0.0, oval=0.0, wave=0.0, **others):
    """Ring about z of many columns, with a meridian (r, z) by two coordinates from 0 to 1.

    Rows of cells may be wavy on the same surfaces.
    """

    def place(along, out, up):
        up = up + wave * np.sin(np.pi * up) * np.cos(10 * np.pi * along)
        r, z = INNER + out * (OUTER - INNER), up * HEIGHT
        if meridian is not None:
            r, z = meridian(out, up)
        angle = 2 * np.pi * along
        x, y = r * np.cos(angle) * (1 + oval), r * np.sin(angle)
        return np.stack([x + off[0], y + off[1], z + tilt * x], axis=-1)

    return blocks((columns, 5, 4), place, closed=True, **others)


def bar(section=None, slant=0.0, **others):
    """Bar along x of 0.1 m, with a section (y, z) by two coordinates from 0 to 1."""

    def place(along, out, up):
        y, z = (out * 0.02, up * 0.02) if section is None else section(out, up)
        return np.stack([along * 0.1 + slant * z, y, z], axis=-1)

    return blocks((12, 5, 4), place, closed=False, **others)


def rounded(out, up):
    """Meridian of a ring with a round rim and face, as a tyre has."""
    angle, size = 1.2 * (up - 0.5), INNER + out * (OUTER - INNER)
    return size * (0.4 + 0.6 * np.cos(angle)), size * 0.6 * np.sin(angle)


def refused(bodies, passage=TURNING, kinds=None, mirrors=()):
    """Message of the refusal; empty if accepted."""
    try:
        require_swept(bodies, passage, kinds or dict.fromkeys(bodies.names, 0), mirrors)
    except CaseError as error:
        return str(error)
    return ""


def cone(out, up):
    return INNER + out * (OUTER - INNER) * (1 - 0.3 * up), up * HEIGHT


@pytest.mark.parametrize("split", [False, True])
@pytest.mark.parametrize("columns", [8, 36])
@pytest.mark.parametrize("meridian", [None, cone, rounded])
def test_faceted_bodies_of_revolution(meridian, columns, split):
    """requirement: cylinders, cones and round rims of few facets are taken for what they are."""
    assert not refused(rotor(columns, meridian, split=split))
    assert not refused(rotor(columns, meridian, split=split, wave=0.1))
    assert not refused(rotor(columns, meridian, split=split, off=(0.3, 0.1)), about(0.3, 0.1))


def about(x, y):
    return Passage(("body",), (x, y), -4.0, spread=False)


WALLS = {
    "vanes": lambda i, j, k: (k != 1) | (i % 3 > 0) | (j == 0),
    "slot": lambda i, j, k: (i > 0) | (k < 3),
    "hole": lambda i, j, k: (i > 0) | (j != 2),
    "half": lambda i, j, k: i < 12,
    "cut": lambda i, j, k: i > 0,
}


@pytest.mark.parametrize("split", [False, True])
@pytest.mark.parametrize("shape", WALLS)
def test_walls_across_the_motion(shape, split):
    """requirement: vanes, slots, holes and sectors are refused; so in the limit of high speed."""
    bodies = rotor(keep=WALLS[shape], split=split)
    for spread in (False, True):
        fast = Passage(("body",), (0.0, 0.0), 30.0, spread)
        message = refused(bodies, fast)
        assert message.startswith("heat.advection: 'body' has a wall at ")


@pytest.mark.parametrize("split", [False, True])
def test_rotors_that_are_not_round(split):
    """requirement: 2 % off the axis, 3 % oval, tilted: refused by the name of the surface."""
    messages = [
        refused(rotor(split=split), about(0.002, 0.0)),
        refused(rotor(split=split, oval=0.03)),
        refused(rotor(split=split, tilt=0.05)),
    ]
    assert ["'rim'" in message for message in messages] == [True, True, False]
    assert all("round about its axis" in message for message in messages)


def test_materials_that_are_not_round():
    """requirement: an insert of another material; not one of the same, nor a ring of it."""
    insert = rotor(second=lambda i, j, k: (i < 3) & (j == 2))
    both = Passage(("body", "insert"), (0.0, 0.0), 30.0, spread=False)
    assert "border of materials" in refused(insert, both, {"body": 0, "insert": 1})
    assert not refused(insert, both, {"body": 0, "insert": 0})
    assert not refused(rotor(second=lambda i, j, k: j == 2), both, {"body": 0, "insert": 1})


@pytest.mark.parametrize("split", [False, True])
def test_bars(split):
    """requirement: any section along the motion; ends beyond the contact, straight or slanted."""
    for section in (None, lambda out, up: rounded(out, up)):
        for slant in (0.0, 0.3):
            assert not refused(bar(section, slant, split=split), ALONG)
    for keep in (
        lambda i, j, k: (k < 3) | (i % 2 > 0),  # rack
        lambda i, j, k: (i != 6) | (j != 2),  # hole
        lambda i, j, k: (k < 3) | (i < 6),  # step in the contact
    ):
        assert "along its motion" in refused(bar(keep=keep, split=split), ALONG)
    inside = Passage(("body",), None, 2.0, spread=False, contact=(-1.0, 1.0))
    assert "along its motion" in refused(bar(split=split), inside)


def test_planes_of_symmetry():
    """requirement: half a body is enough in the limit of high speed only."""
    strip = Passage(("strip",), None, 2.0, spread=False, contact=(0.0, 0.01))
    spread = Passage(("strip",), None, 2.0, spread=True, contact=(0.0, 0.01))
    assert "'strip_left'" in refused(flat_strip(), strip, mirrors=("strip_left",))
    assert not refused(flat_strip(), spread, mirrors=("strip_left",))


def test_sections():
    """requirement: the same in a section: a ring about its centre, a strip with plane walls."""
    ring = ("ring",)
    assert not refused(flat_ring(), Passage(ring, (0.0, 0.0), 1.0, spread=False))
    assert "'ring_rim'" in refused(flat_ring(), Passage(ring, (1e-4, 0.0), 1.0, spread=False))
    assert not refused(flat_strip(), Passage(("strip",), None, 1.0, spread=False))


def carrying(bodies, passage, degree=2, **others):
    """Conduction in a body that moves."""
    spaces = lagrange_spaces(bodies, degree)
    nothing, steel = empty_matrix(spaces), dict.fromkeys(bodies.names, STEEL)
    given = {"rim": 0.0}
    return conduction(bodies, Spatial(), spaces, steel, {}, given, nothing, passage, **others)


@pytest.mark.parametrize("degree", [1, 2])
def test_inclined_facets_lose_nothing(degree):
    """
    requirement: a round rim of flat facets: no heat of any rise is carried out, none of 1; heat
    that is even round the axis makes the temperatures of the body at rest.
    """
    bodies = rotor(24, rounded, split=True, wave=0.1)
    moving, still = carrying(bodies, TURNING, degree), carrying(bodies, None, degree)
    heat = np.where(still.fixed, 0.0, times(still.capacity, np.ones(still.spaces.owned)))
    expected = still.solve(heat)
    assert largest(moving.solve(heat) - expected) < 0.2 * largest(expected)  # 0.8 with leaks
    rise = random_rise(moving)
    carried = times(moving.advection.carried, rise)
    assert abs(total(carried)) < 1e-11 * total(np.abs(carried))
    constant = times(moving.advection.carried, np.ones(len(rise)))
    assert largest(constant) < 1e-10 * largest(carried)
    assert largest(moving.advection.outflow) == 0.0


def test_the_balance_shows_what_walls_let_out():
    """requirement: vanes carry heat off, which is no loss that the balance knows."""
    missing = []
    for keep in (None, WALLS["vanes"]):
        moving = carrying(rotor(keep=keep), TURNING)
        heat = np.where(moving.fixed, 0.0, 1.0)
        lost = sum(moving.losses(moving.solve(heat), heat))
        missing.append(abs(total(heat) - lost) / total(heat))
    assert missing[0] < 1e-9
    assert missing[1] > 0.1


def test_a_bar_with_inclined_facets_carries_heat_out_at_its_end():
    """requirement: what leaves is ``ρc v`` times the section and the rise, whatever its facets."""
    moving = carrying(bar(rounded, split=True), ALONG)
    carried = times(moving.advection.carried, np.ones(moving.spaces.owned))
    assert total(carried) == pytest.approx(total(moving.advection.outflow), rel=1e-9)
    rise = random_rise(moving)
    carried = total(times(moving.advection.carried, rise))
    out = total(moving.advection.outflow * rise)
    assert carried == pytest.approx(out, abs=1e-9 * total(np.abs(moving.advection.outflow)))

"""Case of several shoes in a drum: holders, supports, zones and advection."""

from __future__ import annotations

import pytest

import thermowear as tw
from thermowear.errors import CaseError
from thermowear.simulation.from_case import model_of

from .starter import GONE, tables

SHOES = "two-shoe-drum"


def faults(changes) -> str:
    with pytest.raises(CaseError) as error:
        tw.load(tables(SHOES, changes))
    return str(error.value)


def test_a_holder_takes_the_pivot_of_its_shoe():
    """requirement: the place of a pivot is given once; a key of the holder takes precedence."""
    one, other = model_of(tw.load(tables(SHOES))).holders
    assert one.pivot == pytest.approx((50e-3, -112e-3), rel=1e-12)
    assert other.pivot == pytest.approx((-50e-3, -112e-3), rel=1e-12)
    moved = {"holders.left_shoe.pivot": ["-60 mm", "-100 mm"]}
    _, other = model_of(tw.load(tables(SHOES, moved))).holders
    assert other.pivot == pytest.approx((-60e-3, -100e-3), rel=1e-12)


def test_linings_have_materials_of_their_own():
    """requirement: a lining has its table, or the material of its shoe."""
    case = tw.load(tables(SHOES))
    moduli = {part: case.located_material(part)[1].young_modulus for part in case.geometry.parts}
    assert moduli["left_shoe_lining"] == moduli["right_shoe_lining"] == 0.5e9
    assert moduli["left_shoe"] == 70e9
    plain = tw.load(tables(SHOES, {"bodies.left_shoe_lining": GONE}))
    assert plain.located_material("left_shoe_lining")[1].young_modulus == 70e9


def test_the_heat_of_a_contact_goes_into_the_first_face_that_is_named():
    """requirement: the partition refers to the faces as given, also with the drum first."""
    faces, others = (one.faces for one in model_of(tw.load(tables(SHOES))).interfaces)
    for between in (faces, faces[::-1]):
        contacts = {
            "right_shoe": {"between": list(between), "partition": 0.8},
            "left_shoe": {"between": list(others)},
        }
        first, other = model_of(tw.load(tables(SHOES, {"contacts": contacts}))).interfaces
        assert first.faces == between
        assert first.partition == 0.8
        assert other.partition == 0.05


def test_contacts_are_those_of_the_geometry():
    """requirement: each shoe touches the drum, which is body 2, without a table of contacts."""
    model = model_of(tw.load(tables(SHOES)))
    assert [one.name for one in model.interfaces] == ["right_shoe", "left_shoe"]
    assert [one.bodies for one in model.interfaces] == [(0, 2), (1, 2)]
    assert all(one.motion.center == (0.0, 0.0) for one in model.interfaces)
    assert all(one.motion.angular_velocity == -2.0 for one in model.interfaces)


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        (
            {"holders.left_shoe.closing_moment": "10 N m"},
            "holders.left_shoe.closing_moment: cannot be given together with other loads",
        ),
        (
            {"holders.left_shoe.free": ["z"], "holders.left_shoe.closing_moment": "10 N m"},
            'holders.left_shoe.closing_moment: needs free = ["rotation"]',
        ),
        (
            {"bodies.drum.fixed": "left_shoe_inside"},
            "bodies.drum.fixed: 'left_shoe_inside' is a surface of left_shoe",
        ),
        ({"bodies.drum_lining.like": "drum"}, "bodies.drum_lining: unknown name"),
        (
            {"bodies.left_shoe_lining.fixed": "left_shoe_side"},
            "bodies.left_shoe_lining.fixed: 'left_shoe_side' is a surface of left_shoe",
        ),
        (
            {"motions.left_shoe.velocity": "1 mm/s"},
            "heat.advection: is for one moving body that passes the others",
        ),
        (
            {"heat.advection": "resolved"},
            'bodies.drum.density: missing; needed because heat.advection is "resolved"',
        ),
        (
            {
                "heat.advection": "resolved",
                "motions.drum.history": {"time": ["0 s", "1 s"], "factor": [1, 0]},
            },
            'heat.advection: "resolved" needs a constant speed',
        ),
        (
            {"geometry.shoes.right_shoe.arc_end": "170 deg"},
            "geometry.shoes.right_shoe.pivot: lies at 155.943 deg clockwise",
        ),
        ({"wear.left_shoe.spread": "track"}, "wear.left_shoe.spread: is for rings that pass"),
    ],
)
def test_faults_name_their_keys(changes, line):
    """requirement: one line with the path of the key."""
    assert line in faults(changes)


def test_nothing_pressed_is_named():
    """requirement: a moment presses as a force does; a case without either is refused."""
    pressed = {f"holders.{shoe}.force": GONE for shoe in ("left_shoe", "right_shoe")}
    cold = pressed | {"heat": GONE}
    assert "holders: nothing is pressed" in faults(cold)
    assert tw.load(tables(SHOES, cold | {"holders.left_shoe.closing_moment": "10 N m"}))

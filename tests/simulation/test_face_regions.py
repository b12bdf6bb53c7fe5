"""Contact faces of several materials by expression of the place."""

import numpy as np
import pytest

from thermowear.case import as_plain, load
from thermowear.errors import CaseError
from thermowear.verification.cases.assembly.pad_disk_pad import FORCE, Brake, at_contact
from thermowear.verification.cases.wear.composite_face import (
    PRESSURE,
    SPEED,
    TIME,
    Composite,
)
from thermowear.verification.check import computed

STEADY = {"type": "steady"}
RUNNING_IN = {"type": "transient", "end_time": f"{TIME} s", "tolerance": 1e-3}
INNER, OUTER = 1e-13, 4e-13
"""Wear coefficients of a pad inside and outside of its middle radius [1/Pa]."""
REGIONS = {
    "upper": {"front": ("upper", "x < 30 mm"), "back": ("insert", "x > 30 mm and z < 1 mm")},
    "lower": {"front": ("lower", "0.03 m > x"), "back": ("inlay", "30 mm < x < 50 mm")},
}


def by_region(case):
    """Wear table by region."""
    law = case.tables("")["wear"]
    return {
        body: {
            "materials": {
                name: law[body]["materials"][owner] | {"where": where}
                for name, (owner, where) in REGIONS[body].items()
            }
        }
        for body in case.bodies
    }


@pytest.mark.parametrize(
    "case",
    [
        Composite("plane-strain"),
        Composite("plane-strain", bodies=("upper", "lower")),
        Composite("axisymmetric"),
        Composite("3d", "hexahedron"),
        Composite("3d", "tetrahedron", ("upper", "lower")),
    ],
)
def test_steady_state(case):
    """
    requirement: p_i = p̄ k_eff/k_i to 1e-9 with parts by expression, as with parts by cell set.
    """
    found = case.run(STEADY, wear=by_region(case))
    i, known = found.interface, case.run(STEADY).interface
    np.testing.assert_allclose(i.pressure, case.pressure(found), rtol=1e-9)
    np.testing.assert_allclose(i.pressure, known.pressure, rtol=1e-9)
    np.testing.assert_allclose(i.wear_rate_1 + i.wear_rate_2, case.effective * PRESSURE * SPEED)


def test_running_in():
    """
    requirement: the running-in by region is that by cell set, with geometry updates.
    """
    case = Composite("plane-strain")
    found, known = case.run(RUNNING_IN, wear=by_region(case)), case.run(RUNNING_IN)
    assert found.summary["geometry_updates"] >= 2
    for name in ("pressure", "wear_1"):
        ours, theirs = (getattr(result.interface, name) for result in (found, known))
        np.testing.assert_allclose(ours, theirs, rtol=1e-9)
    assert found.summary["wear_coefficient_per"] == {
        "upper.front": "pressure",
        "upper.back": "pressure",
    }


def brake(state, **pads):
    """Brake with pads of two materials, divided at their middle radius; one by default."""
    tables = Brake("floating", 9.0, elements=4).tables(state)
    law = {"per": "pressure", "velocity_exponent": 0.0}
    inner, outer = (law | {"coefficient": f"{k * SPEED} (m/s)/Pa"} for k in (INNER, OUTER))
    ring = outer | {"where": "105 mm < r < 0.13 m"}
    divided = inner | {"materials": {"ring": ring}}
    return tables | {"wear": {"update": "never", "left": divided, "right": divided} | pads}


@pytest.mark.parametrize("state", ["steady", "after running-in"])
def test_rings_on_both_sides_of_a_disk(state):
    """
    requirement: in a model of several bodies, p_i = p̄ k_eff/k_i at each contact, in the steady
    state to 1e-9, and at the end of the running-in.
    """
    tables = brake(state)
    if state != "steady":
        tables["analysis"]["end_time"] = "4e6 s"
    result = computed(load(tables))
    areas = np.pi * np.diff(np.square([0.08, 0.105, 0.13]))
    rate = FORCE * SPEED / np.sum(areas / [INNER, OUTER])
    for contact in ("left", "right"):
        i = at_contact(result, contact)
        assert (np.abs(i.x - 0.105) < 1e-9).sum() == 2
        k = np.where(i.x < 0.105 - 1e-9, INNER, OUTER)
        inside = np.abs(i.x - 0.105) > 1e-9
        accuracy = 1e-9 if state == "steady" else 2e-3
        pressure = (rate / (k * SPEED))[inside]
        np.testing.assert_allclose(i.pressure[inside], pressure, rtol=accuracy)
        np.testing.assert_allclose(i.wear_rate_1, rate, rtol=accuracy)


def test_round_trip():
    """
    requirement: a resolved case is read back to the same, with its regions as written.
    """
    case = load(brake("steady"))
    plain = as_plain(case)["wear"]["left"]["materials"]["ring"]
    assert plain["where"] == "105 mm < r < 0.13 m"
    assert load(as_plain(case)) == case


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ({"ring": "r > 200 mm"}, "materials.ring.where: no element of a contact face"),
        ({"ring": "r > 0.11 m"}, "materials.ring.where: the border of this region cuts an element"),
        (
            {"ring": "x > 105 mm", "all": "z < 1 m"},
            "materials.all.where: overlaps ring on left_bottom, near (",
        ),
        ({"ring": "r > 5"}, 'materials.ring.where: in "5": '),
        ({"ring": "r + 1 mm"}, 'materials.ring.where: "r + 1 mm" compares nothing'),
        ({"ring": "1 mm < 2 mm"}, 'materials.ring.where: "1 mm < 2 mm" names no coordinate'),
        ({"ring": "w > 2 mm"}, 'materials.ring.where: in "w": '),
        ({"ring": 3}, "materials.ring.where: found 3"),
        ({"ring": None}, "materials: 'stack' has no parts of left"),
    ],
)
def test_refused(parts, message):
    """
    requirement: empty, cut and overlapping parts, and faulty expressions, in one line with path.
    """
    law = {"coefficient": "1e-13 1/Pa", "per": "pressure"}
    materials = {name: law | {"where": where} for name, where in parts.items()}
    with pytest.raises(CaseError) as error:
        computed(load(brake("steady", left=law | {"materials": materials})))
    assert str(error.value).startswith(f"wear.left.{message}"), error.value


def test_the_rest_of_the_face_needs_a_law():
    """
    requirement: elements outside of all regions are refused where the body has no law.
    """
    law = {"coefficient": "1e-13 1/Pa", "per": "pressure", "where": "r > 105 mm"}
    with pytest.raises(CaseError, match=r"wear\.left\.coefficient: missing; the contact"):
        computed(load(brake("steady", left={"materials": {"ring": law}})))

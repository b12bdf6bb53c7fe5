"""Tube between supports: against the tube in one support, by balances and by worn volumes."""

from __future__ import annotations

import functools

import numpy as np
import pytest

import thermowear as tw

from ..case.starter import GONE, TUBE, solved, tables

SUPPORTS = "tube-between-supports"
SPEED, FORCE = 0.4e-3, 20.0
COEFFICIENTS = {"left": 1e-13, "right": 5e-14, "tube": 5e-14}
COARSE = {
    "mesh.elements": 24,
    "geometry.zone": "0.6 mm",
    "analysis": {"type": "transient", "end_time": "720 s", "tolerance": 3e-3},
}
SLIDING = {"velocity": "0.4 mm/s", "across": True}
EQUAL = {
    "geometry.supports.left": {"angle": "-90 deg"},
    "wear.left.coefficient": "5e-8 1/MPa",
    "motions": {"left": SLIDING, "right": SLIDING},
}
"""Two equal supports; they move instead of the tube, which is body 1 as in the pair."""
CLEARANCES = {"left": 0.15e-3, "right": 0.05e-3}
TIME = 720.0


@functools.cache
def pair():
    """The tube in one such support, under the same force."""
    changes = COARSE | {
        "geometry.support_arc": "90 deg",
        "load.history": GONE,
        "contact.friction": 0.0,
        "motion": {"velocity": "0.4 mm/s"},
    }
    return solved(TUBE, changes)


def one_support(angle: str):
    supports = {"only": {"angle": angle}}
    parts = {"bodies.only": {"young_modulus": "99 GPa", "poisson_ratio": 0.37}}
    parts |= {"wear.only": {"coefficient": "5e-8 1/MPa", "per": "pressure"}}
    parts |= {"holders": {"spring": {"surface": "only_rim", "force": "20 N"}}}
    parts |= {"motions": {"only": SLIDING}}
    parts["holders"]["rod"] = {"surface": "tube_bore", "free": []}
    gone = {
        f"{table}.{name}": GONE
        for table in ("bodies", "contacts", "wear")
        for name in ("left", "right")
    }
    bodies = {"bodies.tube": {"young_modulus": "99 GPa", "poisson_ratio": 0.37}}
    tabled = tables(SUPPORTS, COARSE | gone | {"geometry.supports": supports} | bodies | parts)
    tabled.pop("contacts")
    return tw.run(tw.load(tabled))


def compared(found, expected, along: str, tolerance: float) -> None:
    """Compare columns of a contact, sorted along the tangent, with those of the pair.

    Where the contact ends, pressures after hundreds of steps have ten times the error.
    """
    order, other = np.argsort(found[along]), np.argsort(expected["x_m"])
    assert expected["wear_1_m"].max() > 1e-8
    for key in ("weight_m2", "wear_1_m", "wear_2_m", "pressure_Pa"):
        allowed = tolerance * np.abs(expected[key]).max() * (10 if key == "pressure_Pa" else 1)
        np.testing.assert_allclose(
            found[key][order], expected[key][other], rtol=0, atol=allowed, err_msg=key
        )


@pytest.mark.parametrize(("angle", "along"), [("180 deg", "x_m"), ("90 deg", "y_m")])
def test_one_support_is_the_pair(angle, along):
    """requirement: pressures and depths of the tube in its support, wherever the support is."""
    found = one_support(angle)
    compared(found.columns("interface_only"), pair().columns("interface"), along, 1e-9)
    assert found.summary["contacts"]["only"]["max_pressure_Pa"] == pytest.approx(
        pair().summary["max_pressure_Pa"], rel=1e-9
    )


def test_two_equal_supports_have_the_pressures_of_the_pair():
    """requirement: each as under one alone; the other side of the tube is far away."""
    result = solved(SUPPORTS, COARSE | EQUAL)
    left, right = (result.columns(f"interface_{name}") for name in ("left", "right"))
    for side in (left, right):
        compared(side, pair().columns("interface"), "y_m", 1e-9)
    forces = [result.summary["contacts"][name]["normal_force_N"] for name in ("left", "right")]
    assert forces == pytest.approx([FORCE, FORCE], rel=1e-9)


def along(columns, clearance: float, share: float) -> np.ndarray:
    """Part of the normal along the line of the supports, with the share of the support's wear.

    The common face is the tube's where the support alone wears, and the reverse.
    """
    side = np.sign(columns["x_m"][0])
    x = columns["x_m"] + side * (1.0 - share) * clearance
    return abs(x) / np.hypot(x, columns["y_m"])


def test_unequal_supports_carry_one_force_and_wear_by_their_laws():
    """requirement: forces to 1e-9; V = k F s of each face, along the line of the supports."""
    result = solved(SUPPORTS, COARSE)
    worn = dict.fromkeys(COEFFICIENTS, 0.0)
    for name in ("left", "right"):
        i = result.columns(f"interface_{name}")
        share = COEFFICIENTS[name] / (COEFFICIENTS[name] + COEFFICIENTS["tube"])
        weight = i["weight_m2"] * along(i, CLEARANCES[name], share)
        assert weight @ i["pressure_Pa"] == pytest.approx(FORCE, rel=1e-6)
        slid = SPEED * TIME
        for body, key in ((name, "wear_2_m"), ("tube", "wear_1_m")):
            volume = weight @ i[key]
            known = COEFFICIENTS[body] * FORCE * slid
            assert volume == pytest.approx(known, rel=1e-6, abs=0.0)
            worn[body] += i["weight_m2"] @ i[key]
        assert result.summary["contacts"][name]["normal_force_N"] == pytest.approx(FORCE, rel=1e-9)
    for body, volume in worn.items():
        found = result.summary["bodies"][body]["wear_volume_m3"]
        assert found == pytest.approx(volume, rel=1e-9, abs=0.0)

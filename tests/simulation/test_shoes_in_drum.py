"""Leading and trailing shoe in one drum, by the long-shoe law and by balances."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest

import thermowear as tw
from thermowear.errors import CaseError, ComputationError
from thermowear.verification.cases.assembly.two_shoes import long_shoe

from ..case.starter import GONE, tables

SHOES, PAIR = "two-shoe-drum", "drum-brake"
COARSE = {"mesh.elements": 16, "mesh.degree": 2}
COLD = COARSE | {"heat": GONE}
SENSES = {"right_shoe": "-0.2 rad/s", "left_shoe": "0.2 rad/s"}
"""Angular velocity of the drum by the leading shoe."""


@functools.cache
def steady(leading: str, hot: bool = False):
    """Case and result of the starter on a coarse mesh."""
    changes = (COARSE if hot else COLD) | {"motions.drum.angular_velocity": SENSES[leading]}
    case = tw.load(tables(SHOES, changes))
    return case, tw.run(case)


def torques(result) -> dict[str, float]:
    return {name: one["friction_torque_Nm"] for name, one in result.summary["contacts"].items()}


@pytest.mark.parametrize("hot", [False, True])
def test_shoes_exchange_their_roles_with_the_sense_of_rotation(hot):
    """requirement: two equal shoes: torques, pressures and temperatures are mirrored."""
    (_, one), (_, other) = steady("right_shoe", hot), steady("left_shoe", hot)
    for shoe, opposite in (("right_shoe", "left_shoe"), ("left_shoe", "right_shoe")):
        assert torques(other)[opposite] == pytest.approx(torques(one)[shoe], rel=1e-9)
        found, mirrored = one.columns(f"interface_{shoe}"), other.columns(f"interface_{opposite}")
        order, mirror = np.argsort(found["y_m"]), np.argsort(mirrored["y_m"])
        np.testing.assert_allclose(mirrored["x_m"][mirror], -found["x_m"][order], atol=1e-12)
        for key in ("pressure_Pa", "temperature_1_K") if hot else ("pressure_Pa",):
            scale = np.abs(found[key]).max()
            np.testing.assert_allclose(
                mirrored[key][mirror], found[key][order], rtol=0, atol=1e-7 * scale
            )


@pytest.mark.parametrize("leading", SENSES)
def test_pressures_are_those_of_the_long_shoe_law(leading):
    """requirement: p = p_a sin θ, θ from the pivot; 366 N m and 162 N m."""
    case, result = steady(leading)
    for shoe, found in torques(result).items():
        law, largest = long_shoe(case, shoe, shoe == leading)
        assert found == pytest.approx(law.torque(largest), rel=1e-4)
        assert found == pytest.approx(365.8 if shoe == leading else 161.9, rel=1e-3)
        i = result.columns(f"interface_{shoe}")
        x, y = case.geometry.shoes[shoe].pivot
        sine = (x * i["y_m"] - y * i["x_m"]) / np.hypot(i["x_m"], i["y_m"]) / math.hypot(x, y)
        np.testing.assert_allclose(i["pressure_Pa"], largest * abs(sine), atol=2e-3 * largest)


@pytest.mark.parametrize("leading", SENSES)
def test_pins_carry_the_torque(leading):
    """requirement: the cylinder pushes both shoes apart, so the pins alone resist the drum."""
    case, result = steady(leading)
    about_centre = 0.0
    for shoe, holder in result.summary["holders"].items():
        x, y = case.geometry.shoes[shoe].pivot
        about_centre += x * holder["guide_force_z_N"] - y * holder["guide_force_N"]
    sense = 1.0 if leading == "right_shoe" else -1.0
    total = sum(torques(result).values())
    assert about_centre == pytest.approx(sense * total, rel=1e-6)  # normals of the mesh's arcs


@pytest.mark.parametrize("shoe", SENSES)
def test_a_moment_acts_as_the_force_at_its_arm(shoe):
    """requirement: 2279.063 N at 212 mm; positive closes the contact on either side."""
    moment = {f"holders.{shoe}.closing_moment": "483.161356 N m"}
    for key in ("force", "direction", "point"):
        moment |= {f"holders.{shoe}.{key}": GONE}
    result = tw.run(tw.load(tables(SHOES, COLD | moment)))
    _, expected = steady("right_shoe")
    assert torques(result) == pytest.approx(torques(expected), rel=1e-9)


def test_a_force_that_lifts_a_shoe_has_no_steady_state():
    """requirement: an error with the reason, not a pressure."""
    lifted = tw.load(tables(SHOES, COLD | {"holders.left_shoe.direction": [1, 0]}))
    with pytest.raises((CaseError, ComputationError)):
        tw.run(lifted)


def pair_and_one_shoe(**tables_of_both):
    """Results of a shoe in a drum as a pair, and as the only shoe of an assembly."""
    pair = tables(PAIR, COARSE | tables_of_both)
    geometry = dict(pair["geometry"])
    place = {key: geometry.pop(key) for key in ("arc_start", "arc_end", "pivot")}
    bodies = dict(pair["bodies"])
    bodies["shoe_lining"] = bodies.pop("lining")
    bodies["drum"] = bodies["drum"] | {"fixed": "drum_rim"}
    moment = pair["load"]["moment"]
    holder = {"surface": "shoe_inside", "free": ["rotation"], "closing_moment": moment}
    one = {key: pair[key] for key in pair.keys() - {"load", "motion", "holder"}}
    one |= {
        "geometry": geometry | {"type": "shoes-in-drum", "shoes": {"shoe": place}},
        "bodies": bodies,
        "holders": {"brake": holder},
        "motions": {"drum": pair["motion"]},
    }
    return tw.run(tw.load(pair)), tw.run(tw.load(one))


HEAT = {
    f"bodies.{part}.{key}": value
    for part, conductivity in (("shoe", 180), ("lining", 1.5), ("drum", 50))
    for key, value in (("conductivity", f"{conductivity} W/(m K)"), ("expansion", "1.5e-5 1/K"))
} | {
    "motion.angular_velocity": "-0.2 rad/s",
    "heat": {
        "advection": "spread",
        "conductance": "1e4 W/(m^2 K)",
        "cooling": {"drum_rim": "300 W/(m^2 K)", "shoe_inside": "100 W/(m^2 K)"},
    },
}


@pytest.mark.parametrize(
    "changes",
    [
        {},
        HEAT,
        HEAT
        | {
            "heat.advection": "resolved",
            "bodies.drum.density": "7200 kg/m^3",
            "bodies.drum.specific_heat": "460 J/(kg K)",
        },
        HEAT | {"analysis": {"type": "transient", "end_time": "20 h"}},
    ],
    ids=["cold", "hot", "slow", "running-in"],
)
def test_one_shoe_is_the_pair(changes):
    """requirement: the same shoe as a pair of bodies: pressures, shape and temperatures."""
    pair, one = pair_and_one_shoe(**changes)
    expected, found = pair.columns("interface"), one.columns("interface_shoe")
    for key in ("x_m", "pressure_Pa", "shape_m", "wear_1_m"):
        scale = np.abs(expected[key]).max()
        np.testing.assert_allclose(
            found[key], expected[key], rtol=0, atol=1e-9 * scale, err_msg=key
        )
    if "heat" in changes:
        for key in ("temperature_1_K", "temperature_2_K"):
            np.testing.assert_allclose(found[key], expected[key], rtol=1e-10, err_msg=key)
            assert expected[key].min() > 295.0  # the surroundings are at 293 K

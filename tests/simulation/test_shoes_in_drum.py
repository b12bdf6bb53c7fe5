"""Leading and trailing shoe in one drum, by the long-shoe law and by balances."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest
from scipy.optimize import brentq

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


def turned(name: str, clockwise: float) -> dict:
    """Tables of a starter with shoes, turned about the axis of the drum [deg]."""
    case = tables(name, COARSE | {"motions.drum.angular_velocity": SENSES["right_shoe"]})
    c, s = math.cos(math.radians(clockwise)), math.sin(math.radians(clockwise))

    def moved(x: float, y: float) -> list[float]:
        return [c * x + s * y, c * y - s * x]

    def place(given: list[str]) -> list[str]:
        return [f"{value!r} mm" for value in moved(*(float(v.removesuffix(" mm")) for v in given))]

    for shoe in case["geometry"]["shoes"].values():
        for key in ("arc_start", "arc_end"):
            shoe[key] = f"{float(shoe[key].removesuffix(' deg')) + clockwise!r} deg"
        shoe["pivot"] = place(shoe["pivot"])
    for holder in case["holders"].values():
        holder |= {"direction": moved(*holder["direction"]), "point": place(holder["point"])}
    return case


def test_a_brake_turned_in_the_frame_is_the_same():
    """requirement: pressures, temperatures, shapes and torques do not depend on the axes."""
    _, expected = steady("right_shoe", True)
    found = tw.run(tw.load(turned(SHOES, 35.0)))
    for name, torque in torques(expected).items():
        assert torques(found)[name] == pytest.approx(torque, rel=1e-8)
    for name in ("pressure", "temperature_1", "temperature_2", "shape"):
        ours, theirs = getattr(found.interface, name), getattr(expected.interface, name)
        scale = 1e-8 * np.abs(theirs).max()
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=scale, err_msg=name)
    for name, body in expected.summary["bodies"].items():
        ours = found.summary["bodies"][name]["contact_heat_W"]
        assert ours == pytest.approx(body["contact_heat_W"], rel=1e-8)


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


TRACK = COLD | {
    "wear.right_shoe": {"coefficient": "1e-7 1/MPa", "per": "pressure"},
    "wear.left_shoe": {"coefficient": "1e-7 1/MPa", "per": "pressure"},
    "wear.drum": {"coefficient": "4e-8 1/MPa", "per": "pressure", "spread": "track"},
    "motions.drum.angular_velocity": "-0.2 rad/s",
}
"""Shoes that wear in place, and the drum evenly all round."""


def shoes_and_worn_drum(case) -> tuple[float, dict[str, tuple[float, float]]]:
    """Wear rate of the drum [m/s], and torque and largest pressure of each shoe.

    Where a shoe presses, ``k_1 p v + S = Ω a sin θ``, with the rotation Ω that the moment of its
    force needs, and ``S = k_2 v / 2 π Σ ∫ p dθ`` over both shoes.
    """
    k_1, k_2, speed, mu = 1e-13, 4e-14, 0.2 * 0.15, 0.32
    θ = (np.arange(20000) + 0.5) / 20000 * np.radians(126.0)
    dθ = θ[1] - θ[0]
    laws = {shoe: long_shoe(case, shoe, shoe == "right_shoe") for shoe in case.holders}

    def pressure(shoe: str, even: float) -> np.ndarray:
        law, largest = laws[shoe]
        arm = law.pivot_distance * np.sin(θ)
        turned = law.radius - law.pivot_distance * np.cos(θ)
        wanted = largest * law.actuating_moment(1.0)

        def found(Ω):
            return np.maximum((Ω * arm - even) / (k_1 * speed), 0.0)

        def excess(Ω):
            moment = found(Ω) @ (arm + law.friction * turned) * dθ * law.width * law.radius
            return moment / wanted - 1.0

        typical = k_1 * speed * largest / law.pivot_distance
        return found(brentq(excess, 0.5 * typical, 10 * typical, xtol=1e-14 * typical))

    def unlike(even):
        return even - k_2 * speed / (2 * np.pi) * sum(pressure(s, even).sum() * dθ for s in laws)

    even = brentq(unlike, 0.0, k_2 * speed * 1e6, xtol=1e-22)
    each = {shoe: pressure(shoe, even) for shoe in laws}
    torque = mu * case.geometry.thickness * 0.15**2 * dθ
    return even, {shoe: (torque * p.sum(), p.max()) for shoe, p in each.items()}


def test_both_shoes_wear_the_whole_drum():
    """requirement: the drum wears by the sum of both shoes, evenly; pressures by closed forms."""
    case = tw.load(tables(SHOES, TRACK | {"mesh.elements": 32, "mesh.degree": 3}))
    even, each = shoes_and_worn_drum(case)
    result = tw.run(case)
    for shoe, (torque, largest) in each.items():
        found = result.summary["contacts"][shoe]
        assert found["friction_torque_Nm"] == pytest.approx(torque, rel=5e-5)
        assert found["max_pressure_Pa"] == pytest.approx(largest, rel=1e-4)
        rate = result.columns(f"interface_{shoe}")["wear_rate_2_m_per_s"]
        np.testing.assert_allclose(rate, even, rtol=1e-5, atol=0.0)


def test_the_worn_volume_of_the_drum_is_that_of_its_circumference():
    """requirement: a running-in wears both shoes' parts of the drum by one depth."""
    analysis = {"type": "transient", "end_time": "20 h", "tolerance": 1e-3}
    result = tw.run(tw.load(tables(SHOES, TRACK | {"analysis": analysis})))
    depths = [result.columns(f"interface_{shoe}")["wear_2_m"] for shoe in SENSES]
    depth = depths[0][0]
    assert depth > 1e-6
    np.testing.assert_allclose(np.concatenate(depths), depth, rtol=1e-9)
    volume = result.summary["bodies"]["drum"]["wear_volume_m3"]
    assert volume == pytest.approx(depth * 2 * np.pi * 0.15 * 0.032, rel=1e-9)


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

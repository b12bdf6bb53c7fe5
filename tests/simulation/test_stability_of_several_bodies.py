"""Thermoelastic stability of several contacts: half models, pairs, a layer between half-planes."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

import thermowear as tw
from thermowear.case import load
from thermowear.errors import CaseError
from thermowear.model.analyses import StaticAnalysis
from thermowear.reference.instability import LayerBetweenInsulators
from thermowear.simulation.analyses.run import run
from thermowear.simulation.from_case import model_of
from thermowear.verification.cases.assembly.pad_disk_pad import Brake

from ..case.starter import tables

SPEED, STABILITY = 20.0, {"type": "stability"}


def brake(disk, speed=SPEED, **changes):
    """Result of a disk between two pads, or of one half."""
    case = Brake(disk, heated=True, elements=6).tables("steady") | {"analysis": STABILITY}
    case["motions"] = {"disk": {"angular_velocity": f"{speed!r} rad/s"}}
    return tw.run(load(case | changes))


def modes_at(result, contact):
    """Columns of the modes at a contact."""
    return result.columns(f"mode_{contact}")


@pytest.fixture(scope="module")
def half():
    return brake("half")


@pytest.mark.parametrize("disk", ["floating", "clamped"])
def test_symmetric_modes_are_those_of_the_half_model(half, disk):
    """requirement: critical speeds to 1e-7, static ones to 1e-9; shapes alike at both."""
    found = brake(disk)
    keys = [key for key in half.summary if key.startswith(("critical_speed_f", "growth_rate"))]
    assert len(keys) == 4
    for key in keys:
        assert found.summary[key] == pytest.approx(half.summary[key], rel=1e-7), key
    expected = half.summary["static_speed_factors"]
    np.testing.assert_allclose(found.summary["static_speed_factors"], expected, rtol=1e-9)
    left, right = (modes_at(found, side) for side in ("left", "right"))
    for one in (right, modes_at(half, "left")):
        np.testing.assert_allclose(left["pressure"], one["pressure"], atol=1e-5)
    critical = found.summary["contacts"]["right"]["critical_angular_velocity_with_wear_rad_per_s"]
    factor = found.summary["critical_speed_factor_with_wear"]
    assert critical == pytest.approx(factor * SPEED, rel=1e-12)


def test_rates_at_the_critical_speed_vanish():
    """requirement: of two unequal pads what grows beyond the speed found decays below."""
    factor = brake("clamped", wear={}).summary["critical_speed_factor"]
    below, above = (
        brake("clamped", part * factor * SPEED, wear={}).summary["growth_rate_per_s"]
        for part in (0.98, 1.02)
    )
    assert below < 0.0 < above


def test_a_pair_as_one_of_several():
    """requirement: one contact with a name has the numbers of the pair."""
    case = load(tables("disk-brake-stability", {"mesh": {"degree": 3, "elements": 6}}))
    model, analysis = model_of(case), StaticAnalysis("stability")
    named = replace(model, interfaces=(replace(model.interface, name="pad-disk"),))
    pair, one = (run(each, analysis).summary for each in (model, named))
    for key in ("critical_speed_factor", "critical_speed_factor_with_wear", "growth_rate_per_s"):
        assert one[key] == pytest.approx(pair[key], rel=1e-9)
    for key in ("critical_angular_velocity_rad_per_s", "critical_speed_with_wear_m_per_s"):
        assert one["contacts"]["pad-disk"][key] == pytest.approx(pair[key], rel=1e-9)


WAVE, THICKNESS, SOFT, FRICTION = 0.02, 0.0064, 1e-14, 0.3
E, NU, EXPANSION, CONDUCTIVITY = 2.1e11, 0.3, 1.2e-5, 50.0
HALF_PLANES = {"rigid": (1e20, 0.0), "elastic": (1e11, 0.2)}


def material(modulus, ratio, conductivity, expansion, name):
    """Material of a quarter of a wave, from its crest to where it vanishes."""
    return {
        "young_modulus": f"{modulus} Pa",
        "poisson_ratio": ratio,
        "conductivity": f"{conductivity} W/(m K)",
        "expansion": f"{expansion} 1/K",
        "density": "1000 kg/m^3",
        "specific_heat": "3700 J/(kg K)",
        "symmetry": f"{name}_inside",
        "rollers": f"{name}_outside",
    }


def layer(half_planes):
    """Layer that slides across the section between two insulators."""
    insulator, cold = HALF_PLANES[half_planes], "20 degC"
    layers = {"upper": 1.5 * WAVE, "layer": THICKNESS, "lower": 1.5 * WAVE}
    x = ["0 mm", f"{WAVE / 4} m"]
    return {
        "model": "plane-strain",
        "geometry": {
            "type": "stack",
            "thickness": "10 mm",
            "layers": {name: {"x": x, "height": f"{h} m"} for name, h in layers.items()},
        },
        "mesh": {"degree": 5, "elements": 5, "grading": 0.5},
        "bodies": {
            "upper": material(*insulator, 1e5, 1e-12, "upper"),
            "layer": material(E, NU, CONDUCTIVITY, EXPANSION, "layer"),
            "lower": material(*insulator, 1e5, 1e-12, "lower"),
        },
        "contact": {"friction": FRICTION, "compliance": f"{SOFT} m/Pa"},
        "contacts": {
            "upper": {"between": ["upper_bottom", "layer_top"], "partition": 0.0},
            "lower": {"between": ["lower_top", "layer_bottom"], "partition": 0.0},
        },
        "holders": {
            "upper": {"surface": "upper_top", "approach": "1 um"},
            "lower": {"surface": "lower_bottom", "approach": "1 um"},
            "layer": {"surface": "layer_outside", "free": []},
        },
        "motions": {"layer": {"velocity": "1 m/s", "across": True}},
        "heat": {
            "conductance": "1e-4 W/(m^2 K)",
            "ambient": cold,
            "temperature": dict.fromkeys(("layer_outside", "upper_top", "lower_bottom"), cold),
        },
        "analysis": STABILITY,
    }


@pytest.mark.parametrize("half_planes", HALF_PLANES)
def test_a_layer_between_two_half_planes(half_planes):
    """requirement: symmetric and antisymmetric modes of one and of three quarter waves.

    The layer of the contacts adds its compliance to that of the half-planes.
    """
    modulus, ratio = HALF_PLANES[half_planes]
    known = []
    for quarters in (1, 3):
        soft = (1 - ratio**2) / modulus + SOFT * pi * quarters / WAVE
        steel = E, NU, EXPANSION, CONDUCTIVITY, FRICTION
        exact = LayerBetweenInsulators(WAVE / quarters, THICKNESS, *steel, soft)
        known += [exact.symmetric, exact.antisymmetric]
    result = tw.run(load(layer(half_planes)))
    summary = result.summary
    np.testing.assert_allclose(summary["static_speed_factors"], sorted(known), rtol=2e-6)
    assert summary["critical_speed_factor"] == pytest.approx(known[0], rel=2e-6)
    assert summary["contacts"]["lower"]["critical_speed_m_per_s"] == pytest.approx(
        known[0], rel=2e-6
    )
    upper, lower = (modes_at(result, side) for side in ("upper", "lower"))
    for number, sign in ((2, 1.0), (3, -1.0)):  # behind the mode that grows at the given speed
        one, other = (modes["pressure"][modes["mode"] == number] for modes in (upper, lower))
        x = upper["x_m"][upper["mode"] == number]
        np.testing.assert_allclose(one, sign * other, atol=1e-4)
        np.testing.assert_allclose(one * one[0], np.cos(2 * pi * x / WAVE) * one[0] ** 2, atol=1e-3)


def test_thick_layers_are_half_planes():
    """requirement: the closed form of a conductor on an insulator, in the limit."""
    from thermowear.reference.instability import ConductorOnInsulator

    thick = LayerBetweenInsulators(WAVE, 10 * WAVE, E, NU, EXPANSION, CONDUCTIVITY, FRICTION)
    modulus = E / (1 - NU**2)
    one = ConductorOnInsulator(WAVE, modulus, NU, EXPANSION, CONDUCTIVITY, FRICTION)
    assert thick.symmetric == pytest.approx(one.critical_speed, rel=1e-12)
    assert thick.antisymmetric == pytest.approx(one.critical_speed, rel=1e-12)
    thin = replace(thick, thickness=1e-3 * WAVE)
    assert thin.symmetric < 0.01 * one.critical_speed < one.critical_speed < thin.antisymmetric


HISTORY = {"time": ["0 s", "1 s"], "force": ["1 N", "2 N"]}


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"heat": None}, "heat: missing; required in a stability analysis"),
        ({"motions": {}}, "motions: missing; "),
        ({"contact": {"friction": 0.0}}, "contacts: have no friction"),
        (
            {"holders": {"left": {"surface": "left_top", "history": HISTORY}}},
            "holders.left.history: requires a transient analysis, not stability",
        ),
        ({"contact": {"friction": "0.3 + v/(1 m/s)"}}, "contacts.left.friction: is not constant"),
    ],
)
def test_faults(changes, line):
    """requirement: in one line each, with the path of the key."""
    case = Brake("clamped", heated=True).tables("steady") | {"analysis": STABILITY} | changes
    if changes.get("heat", 0) is None:
        del case["heat"]
    with pytest.raises(CaseError) as caught:
        load(case)
    assert any(text.strip().startswith(line) for text in str(caught.value).splitlines())

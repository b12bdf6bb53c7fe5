"""Heat of pressed bodies that do not slide, and heat through their surfaces."""

from math import inf, pi

import numpy as np
import pytest

from thermowear.reference.heat import contact_temperatures

from ..case.starter import GONE, solved

BLOCKS, RING, BRAKE, BOX = "stacked-blocks", "annular-punch", "disk-brake", "rectangular-punch"
COLD, HOT = 293.15, 373.15
LENGTHS, CONDUCTIVITIES = (0.01, 0.02), (50.0, 15.0)
COARSE = {"mesh.degree": 2, "mesh.elements": 3}
REST = COARSE | {"motion": GONE, "wear": GONE, "analysis": {"type": "initial"}}
WARM = REST | {"heat.temperature.upper_top": "100 degC"}
FLUX = 1e4
LAWS = {
    "constant": ({}, 1e4),
    "perfect": ({"heat.conductance": GONE}, inf),
    "table": (
        {
            "heat.conductance": {
                "type": "table",
                "pressure": ["0 MPa", "10 MPa"],
                "conductance": ["0 W/(m^2 K)", "6e3 W/(m^2 K)"],
            }
        },
        3e3,
    ),
    "pressure": (
        {
            "heat.conductance": {"type": "pressure", "coefficient": "2e4 1/m"},
            "bodies.upper.hardness": "2 GPa",
            "bodies.lower.hardness": "3 GPa",
        },
        2e4 * (1500 / 65) * 5e6 / 2.4e9,
    ),
}


def assert_slabs(result, ends, heat, conductance, friction_heat=0.0):
    """Temperatures and fluxes of both faces are those of slabs in series."""
    known, fluxes = contact_temperatures(
        LENGTHS, CONDUCTIVITIES, ends, friction_heat, 0.5, conductance
    )
    i, summary = result.interface, result.summary
    for body, found in enumerate((i.temperature_1, i.temperature_2)):
        np.testing.assert_allclose(found, known[body], rtol=0, atol=1e-7)
    for body, found in enumerate((i.heat_flux_1, i.heat_flux_2)):
        np.testing.assert_allclose(found, fluxes[body], rtol=1e-7, atol=1e-4)
    assert summary["contact_heat_1_W"] == pytest.approx(fluxes[0] * 1e-4, rel=1e-7)
    assert summary["contact_heat_2_W"] == pytest.approx(fluxes[1] * 1e-4, rel=1e-7)
    assert summary["heat_balance_relative_error"] < 1e-10
    assert summary.get("prescribed_heat_W") == heat


@pytest.mark.parametrize("law", LAWS)
def test_heat_crosses_a_pressed_joint(law):
    """
    requirement: conduction across a joint at rest, by any conductance law: resistances in series.
    """
    changes, conductance = LAWS[law]
    result = solved(BLOCKS, WARM | changes)
    assert_slabs(result, (HOT, COLD), None, conductance)
    assert result.summary["friction_power_W"] == result.summary["friction_force_N"] == 0.0


@pytest.mark.parametrize("method", ["penalty", "nitsche"])
def test_every_method_conducts_at_rest(method):
    """requirement: conduction at rest by all three contact methods."""
    assert_slabs(solved(BLOCKS, WARM | {"contact.method": method}), (HOT, COLD), None, 1e4)


def test_faces_apart_conduct_across_their_gap():
    """requirement: pulled apart by cold, at rest: what the gap conductance lets through."""
    apart = {"load": {"approach": "1 um"}, "heat.gap_conductance": "500 W/(m^2 K)"}
    cold = {"heat.temperature.lower_bottom": "-80 degC"}
    assert_slabs(solved(BLOCKS, REST | apart | cold), (COLD, COLD - 100), None, 500.0)


@pytest.mark.parametrize("kind", ["flux", "power"])
def test_heat_through_a_surface_goes_down_the_column(kind):
    """
    requirement: a given flux, or its power, leaves through the other end: T = q (L2/k2 + 1/h).
    """
    given = {"flux": f"{FLUX} W/m^2", "power": f"{FLUX * 1e-4} W"}[kind]
    changes = {"heat.temperature.upper_top": GONE, f"heat.{kind}": {"upper_top": given}}
    result = solved(BLOCKS, REST | changes)
    far = COLD + FLUX * (LENGTHS[0] / CONDUCTIVITIES[0] + LENGTHS[1] / CONDUCTIVITIES[1] + 1e-4)
    assert_slabs(result, (far, COLD), pytest.approx(FLUX * 1e-4), 1e4)
    assert result.fields.temperature.max() == pytest.approx(far, abs=1e-5)


def test_heat_can_be_drawn_out_beside_friction():
    """requirement: negative fluxes cool; friction heat and fluxes add up in one balance."""
    drawn = {"heat.temperature.upper_top": GONE, "heat.flux": {"upper_top": f"{-FLUX} W/m^2"}}
    result = solved(BLOCKS, COARSE | drawn)
    heat = 0.2 * 5e6 * 0.1
    i, summary = result.interface, result.summary
    # all the friction heat but what is drawn out at the top goes down
    np.testing.assert_allclose(i.heat_flux_2, heat - FLUX, rtol=1e-8)
    np.testing.assert_allclose(i.heat_flux_1, FLUX, rtol=1e-8)
    np.testing.assert_allclose(i.temperature_2, COLD + (heat - FLUX) * 0.02 / 15, atol=1e-7)
    assert summary["friction_power_W"] == pytest.approx(heat * 1e-4)
    assert summary["prescribed_heat_W"] == pytest.approx(-FLUX * 1e-4)
    assert summary["heat_balance_relative_error"] < 1e-10


def test_smooth_bodies_that_wear_may_be_heated_otherwise():
    """requirement: sliding without friction makes no heat, and wears by the pressure."""
    smooth = {"contact.friction": 0.0, "wear.upper.per": "pressure"}
    result = solved(BLOCKS, COARSE | smooth | {"heat.temperature.upper_top": "100 degC"})
    assert_slabs(result, (HOT, COLD), None, 1e4)
    assert result.summary["rigid_wear_velocity_m_per_s"] == pytest.approx(1e-14 * 5e6 * 0.1)


def test_conductivity_that_changes():
    """
    requirement: a flux through k(T): by Kirchhoff's integral, T falls as 1 - sqrt(1 - 2 a q L/k).
    """
    half = {"at": ["20 degC", "1020 degC"], "factor": [1.0, 0.5]}
    changes = {
        "heat.temperature.upper_top": GONE,
        "heat.flux": {"upper_top": "1e5 W/m^2"},
        "bodies.lower.conductivity_factor": half,
    }
    result = solved(BLOCKS, REST | changes)
    a = 0.5e-3  # of the conductivity, per kelvin
    expected = (1 - np.sqrt(1 - 2 * a * 1e5 * 0.02 / 15)) / a
    np.testing.assert_allclose(result.interface.temperature_2 - COLD, expected, rtol=1e-8)
    assert result.summary["heat_balance_relative_error"] < 1e-9


def test_powers_are_those_of_the_whole_ring():
    """requirement: axisymmetric: 200 W are 200 W, a flux counts π (r2² - r1²); all crosses."""
    for kind, given, heat in (
        ("power", "200 W", 200.0),
        ("flux", "1e4 W/m^2", 1e4 * pi * (0.12**2 - 0.02**2)),
    ):
        cooled = {"heat.cooling": {"plate_bottom": "2000 W/(m^2 K)"}}
        result = solved(RING, REST | cooled | {f"heat.{kind}": {"punch_top": given}})
        assert result.summary["prescribed_heat_W"] == pytest.approx(heat, rel=1e-12)
        assert result.summary["contact_heat_2_W"] == pytest.approx(heat, rel=1e-9)
        assert result.summary["heat_balance_relative_error"] < 1e-10


def test_a_disk_is_heated_all_round():
    """requirement: under pads of a sector, a flux counts on the whole disk, as cooling does."""
    rest = pi * (0.08**2 - 0.05**2 + 0.135**2 - 0.13**2)
    for kind, given, heat in (("power", "10 W", 10.0), ("flux", "1e3 W/m^2", 1e3 * rest)):
        result = solved(BRAKE, COARSE | {f"heat.{kind}": {"disk_rest": given}})
        assert result.summary["prescribed_heat_W"] == pytest.approx(heat, rel=1e-9)
        assert result.summary["heat_balance_relative_error"] < 1e-9


def test_in_space():
    """requirement: the same in 3d: all the power crosses the joint of a punch on a block."""
    materials = {"conductivity": "50 W/(m K)", "expansion": "1.2e-5 1/K"}
    changes = {f"bodies.punch.{key}": value for key, value in materials.items()}
    heat = {
        "conductance": "1e4 W/(m^2 K)",
        "power": {"punch_top": "20 W"},
        "cooling": {"block_bottom": "500 W/(m^2 K)"},
    }
    small = {"mesh.elements": 2, "heat": heat, "holder": GONE, "load": {"mean_pressure": "5 MPa"}}
    result = solved(BOX, REST | changes | small)
    assert result.summary["prescribed_heat_W"] == pytest.approx(20.0, rel=1e-12)
    assert result.summary["contact_heat_2_W"] == pytest.approx(20.0, rel=1e-9)
    i = result.interface
    jump = i.temperature_1 - i.temperature_2
    pressed = i.pressure > 0
    np.testing.assert_allclose(jump[pressed] * 1e4, i.heat_flux_2[pressed], rtol=1e-6)
    assert result.summary["heat_balance_relative_error"] < 1e-10


SIDES = {f"heat.temperature.{s}": "140 degC" for s in ("upper_side", "lower_side")}
ALL_ROUND = SIDES | {f"heat.temperature.{s}": "140 degC" for s in ("upper_top", "lower_bottom")}
WARM_SIDES = 413.15
STORING = {
    f"bodies.{body}.{key}": value
    for body in ("upper", "lower")
    for key, value in (("density", "7800 kg/m^3"), ("specific_heat", "470 J/(kg K)"))
}
TIMED = {
    "heat.transient": True,
    "heat.initial": "140 degC",
    "analysis": {"type": "transient", "end_time": "2 s", "tolerance": 1e-4},
}


@pytest.mark.parametrize("law", ["constant", "perfect"])
@pytest.mark.parametrize(("degree", "timed"), [(1, False), (2, False), (8, False), (2, True)])
def test_surfaces_at_a_temperature_may_end_at_the_contact(degree, law, timed):
    """requirement: all sides at 140 degC: so are the bodies, by any degree and conductance."""
    changes = LAWS[law][0] | ALL_ROUND | {"mesh.degree": degree, "mesh.elements": 4}
    if timed:
        changes = STORING | TIMED | changes
    result = solved(BLOCKS, REST | changes)
    i = result.interface
    assert not result.stopped
    for temperature in (i.temperature_1, i.temperature_2):
        np.testing.assert_allclose(temperature, WARM_SIDES, rtol=0.0, atol=1e-7)
    np.testing.assert_allclose(result.fields.temperature, WARM_SIDES, rtol=1e-6)
    assert result.summary["heat_balance_relative_error"] < 1e-6


def test_warm_bodies_whose_conductivity_changes():
    """requirement: heat balances where none flows, to what Newton's method leaves."""
    half = {"at": ["20 degC", "1020 degC"], "factor": [1.0, 0.5]}
    result = solved(BLOCKS, REST | ALL_ROUND | {"bodies.lower.conductivity_factor": half})
    np.testing.assert_allclose(result.interface.temperature_2, WARM_SIDES, rtol=0.0, atol=1e-7)
    assert result.summary["heat_balance_relative_error"] < 1e-7


def test_warm_sides_between_cold_ends():
    """
    requirement: halves of a bar, sides warm, ends cold: the series of Fourier in the middle plane,
    at any conductance, as no heat crosses it.
    """
    equal = {"geometry.lower_height": "10 mm", "bodies.lower.conductivity": "50 W/(m K)"}
    fine = {"mesh.degree": 6, "mesh.elements": 8}
    for law in ("constant", "perfect"):
        i = solved(BLOCKS, REST | LAWS[law][0] | SIDES | equal | fine).interface
        middle, n = i.x - 0.005, np.arange(1, 80, 2)[:, None]
        sign = 4 / (n * pi) * (-1.0) ** ((n - 1) // 2)
        exact = sign * np.cosh(n * pi * middle / 0.02) / np.cosh(n * pi * 0.005 / 0.02)
        inside = np.abs(middle) < 0.0045  # the series converges slowly at the warm sides
        for temperature in (i.temperature_1, i.temperature_2):
            expected = COLD + (WARM_SIDES - COLD) * exact.sum(axis=0)
            np.testing.assert_allclose(temperature[inside], expected[inside], rtol=0.0, atol=0.05)


def test_a_sliding_block_with_sides_at_a_temperature():
    """requirement: friction heat leaves through the sides and ends; the balance closes."""
    result = solved(BLOCKS, COARSE | dict.fromkeys(SIDES, "60 degC"))
    assert result.summary["friction_power_W"] == pytest.approx(10.0)
    assert result.summary["heat_balance_relative_error"] < 1e-10
    assert result.fields.temperature.min() > COLD - 1e-3


@pytest.mark.parametrize("solver", ["direct", "multigrid"])
@pytest.mark.parametrize("conductance", ["1e4 W/(m^2 K)", GONE])
def test_sides_at_a_temperature_in_space(solver, conductance):
    """requirement: the same in 3d, also where bodies are solved for each state of the contact."""
    materials = {"conductivity": "50 W/(m K)", "expansion": "1.2e-5 1/K"}
    changes = {f"bodies.punch.{key}": value for key, value in materials.items()}
    surfaces = "punch_sides", "block_sides", "block_top", "punch_top", "block_bottom"
    heat = {"temperature": dict.fromkeys(surfaces, "140 degC")}
    if conductance is not GONE:
        heat["conductance"] = conductance
    small = {"mesh.elements": 2, "mesh.solver": solver, "heat": heat, "holder": GONE}
    result = solved(BOX, REST | changes | small | {"load": {"mean_pressure": "5 MPa"}})
    i = result.interface
    for temperature in (i.temperature_1, i.temperature_2):
        np.testing.assert_allclose(temperature, WARM_SIDES, rtol=0.0, atol=1e-6)
    np.testing.assert_allclose(result.fields.temperature, WARM_SIDES, rtol=1e-6)

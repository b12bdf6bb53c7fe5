"""The steady state of the annular punch against tables and closed forms."""

import itertools

import numpy as np
import pytest

import thermowear as tw
from thermowear.reference import annular_punch as reference

from ..conftest import HOT, at, cold_tables, wear_law

FORCE = 50e6 * np.pi * (0.12**2 - 0.02**2)


def steady(b, speed, *overrides):
    source = HOT if speed else cold_tables()
    return tw.run(tw.load(source, (*wear_law(b), *overrides)))


def shape_at(interface, radii=reference.RADII):
    """Shape against r = 70 mm [mm]."""
    values = at(interface, radii, interface.shape)
    return 1e3 * (values - at(interface, [0.07], interface.shape))


def test_balances(hot_steady):
    """requirement: heat and forces balance to 1e-9; friction power in closed form."""
    summary = hot_steady.summary
    assert summary["heat_balance_relative_error"] < 1e-9
    assert summary["equilibrium_relative_error"] < 1e-9
    power = 0.1 * reference.uniform_wear_torque(FORCE, 0.25, 0.02, 0.12)
    assert summary["friction_power_W"] == pytest.approx(power, rel=1e-6)
    i = hot_steady.interface
    np.testing.assert_allclose(
        i.heat_flux_1 + i.heat_flux_2, 0.25 * i.pressure * 0.1 * i.x, rtol=1e-10
    )
    assert summary["wear_dissipation_W"] == pytest.approx(
        FORCE * summary["rigid_wear_velocity_m_per_s"], rel=1e-10
    )


def test_pressure_knows_nothing_of_stiffness_and_heat(hot_steady):
    """requirement: the steady pressure depends on neither E, heat nor expansion; the shape does."""
    other = steady(
        1.0,
        0.1,
        'bodies.punch.young_modulus="70 GPa"',
        "mesh.degree=3",
        'bodies.punch.expansion="2e-5 1/K"',
    )
    for interface in (other.interface, hot_steady.interface):
        exact = reference.steady_pressure(interface.x, FORCE, 0.02, 0.12, 1.0)
        np.testing.assert_allclose(interface.pressure, exact, rtol=1e-9)
    assert np.abs(shape_at(other.interface) - shape_at(hot_steady.interface)).max() > 0.01


def test_heat_turns_the_shape_round(hot_steady):
    """requirement: high inside when cold, high outside when hot."""
    cold = shape_at(steady(1.0, 0.0, "mesh.degree=4").interface)
    hot = shape_at(hot_steady.interface)
    assert cold[1] > 0 > cold[-2]
    assert hot[-2] > hot[1] > 0


CONVERGENCE = {2: 4e-4, 3: 1.6e-4, 4: 7e-5, 6: 2.2e-5, 8: 7e-6}
"""Largest error of the hot worn shape inside, relative to its range, by degree."""


def test_low_degrees_converge(hot_steady):
    """requirement: the error falls from degree 2 to 4, against degree 8."""
    assert_converge((2, 3, 4), hot_steady.interface)


@pytest.mark.slow
def test_convergence_in_degree():
    """requirement: the error falls with every degree from 2 to 8, see `CONVERGENCE`."""
    assert_converge(CONVERGENCE, steady(1.0, 0.1, "mesh.degree=10").interface)


def assert_converge(degrees, best):
    scale = np.ptp(best.shape) * 1e3
    errors = {}
    for degree in degrees:
        found = shape_at(steady(1.0, 0.1, f"mesh.degree={degree}").interface)
        errors[degree] = float(np.abs(found - shape_at(best))[1:-1].max() / scale)
    print("degree, error:", {k: f"{v:.1e}" for k, v in errors.items()})
    values = list(errors.values())
    assert all(a > b for a, b in itertools.pairwise(values)), errors
    assert all(error <= CONVERGENCE[d] for d, error in errors.items()), errors


def test_both_bodies_wear():
    """requirement: two wearing bodies share the rate; the pressure stays the same."""
    tables = cold_tables()
    tables["wear"]["plate"] = dict(tables["wear"]["punch"]) | {"coefficient": "1e-7 1/MPa"}
    result = tw.run(tw.load(tables, ("mesh.degree=3",)))
    i = result.interface
    np.testing.assert_allclose(i.wear_rate_1, 2 * i.wear_rate_2, rtol=1e-12)
    velocity = result.summary["rigid_wear_velocity_m_per_s"]
    np.testing.assert_allclose(i.wear_rate_1 + i.wear_rate_2, velocity, rtol=1e-12)
    exact = reference.steady_pressure(i.x, FORCE, 0.02, 0.12, 1.0)
    np.testing.assert_allclose(i.pressure, exact, rtol=1e-9)


def test_units_do_not_matter():
    """requirement: the case in mm, N and MPa or in SI gives the same result."""
    tables = cold_tables()
    si = tw.run(tw.load(tables, ("mesh.degree=3",)))
    geometry = tables["geometry"]
    for key, value in geometry.items():
        if value.endswith("mm"):
            geometry[key] = f"{float(value[:-2]) / 1000!r} m"
    tables["bodies"]["punch"]["young_modulus"] = "2e5 N/mm^2"
    tables["wear"]["punch"]["coefficient"] = "2e-13 1/Pa"
    other = tw.run(tw.load(tables, ("mesh.degree=3",)))
    np.testing.assert_allclose(other.interface.shape, si.interface.shape, atol=1e-10 * 4e-5)


def test_given_temperature_hotter_than_the_contact():
    """requirement: the highest temperature is that of the bodies; heat balances with it."""
    import tomllib

    tables = tomllib.loads(HOT.read_text(encoding="utf-8"))
    tables["heat"]["cooling"] = {"punch_top": "2000 W/(m^2 K)"}
    tables["heat"]["temperature"] = {"plate_bottom": "300 degC"}
    result = tw.run(tw.load(tables, ("mesh.degree=4",)))
    assert result.summary["max_temperature_K"] == pytest.approx(573.15, rel=1e-9)
    assert result.interface.temperature_2.max() < 573.0
    assert result.summary["heat_balance_relative_error"] < 1e-9
    into_punch = result.interface.weight @ result.interface.heat_flux_1
    assert into_punch > result.summary["friction_power_W"]  # heat comes through from the plate

"""Bodies that carry heat along, or are so fast that it is spread along their way."""

import numpy as np
import pytest

from thermowear.output.console import print_summary
from thermowear.output.progress import Terminal
from thermowear.verification.cases.heat.moving_band import passed, surface
from thermowear.verification.check import run_starter

from ..conftest import DEMOS
from ..test_parallel import pytestmark as needs_mpirun
from ..test_parallel import summaries

DISK = "block-on-disk-turning"
RADIUS, BORE, THICKNESS, COOLING = 0.02, 0.008, 0.01, 2000.0
CONDUCTIVITY, DIFFUSIVITY, AMBIENT = 50.0, 50.0 / 7800 / 460, 293.15
UNCOOLED = 'heat.cooling.disk_rim="1e-9 W/(m^2 K)"'


def turning(peclet, *overrides):
    """The disk at a Péclet number of radius and rim speed; rises of the faces over the power."""
    speed = peclet * DIFFUSIVITY / RADIUS**2
    result = run_starter(DISK, f'motion.angular_velocity="{speed} rad/s"', UNCOOLED, *overrides)
    rises = np.array([result.interface.temperature_1, result.interface.temperature_2]) - AMBIENT
    return result, rises / result.summary["friction_power_W"]


@pytest.mark.parametrize(
    "peclet",
    [
        10,
        1000,
        pytest.param(100, marks=pytest.mark.slow),
        pytest.param(5000, marks=pytest.mark.slow),
    ],
)
def test_coarse_meshes_do(peclet):
    """requirement: largest temperatures of both faces within 0.1 % of those of a finer mesh."""
    _, coarse = turning(peclet, "mesh.degree=3", "mesh.elements=8")
    result, fine = turning(peclet)
    np.testing.assert_allclose(coarse.max(axis=1), fine.max(axis=1), rtol=1e-3)
    cells = result.summary["max_cell_peclet_number"]
    assert cells == pytest.approx(peclet * 0.0194, rel=0.02)
    assert result.summary["heat_advection"] == ("stabilised" if cells > 1 else "resolved")
    assert result.summary["heat_balance_relative_error"] < 1e-9


@pytest.mark.slow
def test_heat_spread_is_the_limit_of_fast_rotation():
    """requirement: the mean temperatures of both faces come nearer like 1/√Pe."""
    _, even = turning(1000, 'heat.advection="spread"')
    distances = []
    for peclet in (1250, 5000, 20000):
        result, rises = turning(peclet)
        weights = result.interface.weight
        distances.append((rises - even) @ weights / weights.sum() / even.max())
    ratios = np.array(distances[:-1]) / np.array(distances[1:])
    np.testing.assert_allclose(ratios, 2.0, rtol=0.03)
    assert np.all(np.array(distances[-1]) < 5e-3)


def test_a_disk_in_which_heat_is_spread():
    """requirement: the radial solution of a disk heated all round, as round as its cells are."""
    result, _ = turning(1000, 'heat.advection="spread"')
    interface, summary = result.interface, result.summary
    power = interface.weight @ interface.heat_flux_2
    drop = 1 / (COOLING * BORE) + np.log(RADIUS / BORE) / CONDUCTIVITY
    rise = interface.temperature_2 - AMBIENT
    assert np.ptp(rise) < 1e-9 * rise.max()
    assert rise.mean() == pytest.approx(power * drop / (2 * np.pi * THICKNESS), rel=1e-6)
    assert summary["heat_advection"] == "spread"
    assert summary["max_cell_peclet_number"] is None
    assert summary["heat_carried_out_W"] is None
    assert summary["heat_cooled_W"] == pytest.approx(summary["friction_power_W"], rel=1e-9)


@pytest.mark.parametrize("degree", [2, 5])
def test_a_fast_strip_does_not_oscillate(degree):
    """requirement: L = 1000, whatever the mesh: no dips, and nothing is lost on the way."""
    result = passed(1000.0, None, f"mesh.degree={degree}")
    summary = result.summary
    assert summary["heat_advection"] == "stabilised"
    lost = summary["heat_cooled_W"] + summary["heat_carried_out_W"]
    assert lost == pytest.approx(summary["friction_power_W"], rel=1e-9)
    x, rise = surface(result)
    assert rise.min() > -5e-3 * rise.max()
    assert np.diff(rise[x < -1e-3]).min() > -5e-3 * rise.max()


def test_a_strip_that_stands_still_in_the_model():
    """requirement: the summary says so; without a body that passes it says nothing."""
    summary = run_starter("punch-on-strip", "mesh.degree=2").summary
    assert summary["heat_advection"] == "none"
    assert summary["heat_carried_out_W"] is None
    assert summary["heat_cooled_W"] == pytest.approx(summary["friction_power_W"], rel=1e-9)
    assert "heat_advection" not in run_starter("annular-punch", "mesh.degree=2").summary


def test_the_console_says_how_heat_is_carried(capsys):
    """requirement: resolved or stabilised, by which cell Péclet number, and what leaves."""
    summary = passed(100.0, None, "mesh.degree=2").summary
    print_summary(Terminal(width=120), summary, {})
    shown = capsys.readouterr().out
    assert f"stabilised, cell Péclet number up to {summary['max_cell_peclet_number']:.3g}" in shown
    assert f"{summary['heat_carried_out_W']:.6g} W" in shown


@needs_mpirun
@pytest.mark.slow
@pytest.mark.parametrize("advection", ["resolved", "spread"])
def test_two_ranks_give_the_serial_numbers(tmp_path, advection):
    """requirement: every number of the summary to 1e-8, also where a rank has no unknowns."""
    overrides = (f"heat.advection={advection}", "mesh.degree=3")
    (serial, _), (parallel, _) = summaries(
        tmp_path, DEMOS / "block_on_disk_turning.toml", *overrides
    )
    noise = {"heat_balance_relative_error", "equilibrium_relative_error"}
    for key, expected in serial.items():
        if isinstance(expected, float) and key not in noise:
            assert parallel[key] == pytest.approx(expected, rel=1e-8), key
    assert parallel["heat_balance_relative_error"] < 1e-9

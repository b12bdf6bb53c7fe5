"""Sweeps: what variants share is made once, and no number differs from a run of its own."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

import thermowear as tw
from thermowear.bulk.solvers.direct import DirectSolver
from thermowear.simulation.analyses.run import Series, groups
from thermowear.simulation.from_case import analysis_of, model_of
from thermowear.simulation.system.setup_cache import inputs

from ..conftest import DEMOS

BLOCK = DEMOS / "block_on_disk.toml"
SMALL = ("mesh.degree=3", "mesh.elements=6")
RUNNING_IN = 'analysis={type="transient", end_time="1e4 s"}'
STORING = (
    'bodies.block.density="7800 kg/m^3"',
    'bodies.block.specific_heat="460 J/(kg K)"',
)


def block(*changes: str, base=SMALL):
    return tw.load(BLOCK, (*base, *changes))


def run_in(series, case):
    return series.run(model_of(case), analysis_of(case))


def grouped(cases):
    return groups([model_of(case) for case in cases])


@pytest.fixture
def factors(monkeypatch):
    """Counts factorisations."""
    made = []
    original = DirectSolver.__init__

    def counted(self, *given, **more):
        made.append(1)
        original(self, *given, **more)

    monkeypatch.setattr(DirectSolver, "__init__", counted)
    return made


def same(result, other) -> None:
    """All numbers of two results are the same, but for rounding."""
    for field in fields(result.interface):
        one, two = getattr(result.interface, field.name), getattr(other.interface, field.name)
        largest = np.nanmax(np.abs(two), initial=0.0)
        np.testing.assert_allclose(one, two, rtol=1e-9, atol=1e-9 * largest, err_msg=field.name)
    for name, value in other.summary.items():
        if isinstance(value, float) and "error" not in name:
            found = result.summary[name]
            assert found == pytest.approx(value, rel=1e-8, abs=1e-300), name


LIGHT = [
    ('load.force="3 kN"',),
    ("contact.friction=0.1",),
    ('wear.block={coefficient="1e-7 1/MPa^2", pressure_exponent=2.0}',),
    ('motion.angular_velocity="-0.8 rad/s"',),
    ('heat.conductance="1e3 W/(m^2 K)"',),
    ("heat.partition=0.9",),
    ("contact.friction=0.5", RUNNING_IN),
    ('analysis.type="initial"',),
]


@pytest.mark.parametrize("changes", LIGHT, ids=lambda changes: changes[-1][:25])
def test_what_needs_no_new_factor(changes, factors):
    """
    requirement: loads, frictions, wear laws, speeds, analyses, conductance and partition reuse
    every factor, and give the numbers of a run of their own.
    """
    first, second = block(), block(*changes)
    assert grouped([first, second]) == [[0, 1]]
    series = Series()
    run_in(series, first)
    assert len(factors) == 4  # elasticity and conduction of either body
    result = run_in(series, second)
    assert len(factors) == 4
    same(result, tw.run(second))


def slow(change):
    return pytest.param(change, marks=pytest.mark.slow)


@pytest.mark.parametrize(
    "change",
    ['heat.cooling.block_top="500 W/(m^2 K)"', 'bodies.disk={like="block"}']
    + [slow('heat.ambient="50 degC"'), slow('heat.temperature={disk_rim="80 degC"}')],
)
def test_cooling_needs_new_conduction_only(change, factors):
    """
    requirement: cooling and given temperatures keep the elastic bodies.
    """
    first, second = block(RUNNING_IN), block(RUNNING_IN, change)
    assert grouped([first, second]) == [[0, 1]]
    series = Series()
    run_in(series, first)
    result = run_in(series, second)
    assert len(factors) == 4 + 2 * (first.heat != second.heat)
    same(result, tw.run(second))


@pytest.mark.parametrize(
    "change",
    ['bodies.block.young_modulus="100 GPa"', "contact.pressure_degree=1", slow("mesh.elements=5")]
    + [slow('geometry.block_height="10 mm"')],
)
def test_what_shares_nothing(change, factors):
    """
    requirement: whatever else is swept is computed anew, in a group of its own.
    """
    first, second = block(RUNNING_IN), block(RUNNING_IN, change)
    assert grouped([first, second]) == [[0], [1]]
    series = Series()
    run_in(series, first)
    result = run_in(series, second)
    assert len(factors) == 8
    same(result, tw.run(second))


def test_expansion_needs_no_new_factor(factors):
    """
    requirement: expansion keeps the factors of elasticity and conduction, and gives the numbers of
    a run of its own, in a group of its own as the response to temperatures is computed anew.
    """
    change = 'bodies.block.expansion="2e-5 1/K"'
    first, second = block(RUNNING_IN), block(RUNNING_IN, change)
    assert grouped([first, second]) == [[0], [1]]
    series = Series()
    before = run_in(series, first)
    result = run_in(series, second)
    assert len(factors) == 4
    same(result, tw.run(second))
    assert result.summary["shape_range_m"] != before.summary["shape_range_m"]


@pytest.mark.parametrize(
    "change",
    [
        'bodies.block.expansion="2e-5 1/K"',
        'bodies.block.expansion_factor={at=["20 degC", "60 degC"], factor=[1.0, 3.0]}',
        None,
    ],
    ids=["expansion", "factor", "no factor"],
)
def test_expansions_that_depend_on_temperature(change):
    """
    requirement: the forces of temperature-dependent expansions are those of each case of a series.
    """
    table = '{at=["20 degC", "60 degC"], factor=[1.0, 2.0]}'
    varying = f"bodies.block.expansion_factor={table}"
    first, second = block(varying), block(*([varying, change] if change else []))
    series = Series()
    before = run_in(series, first)
    result = run_in(series, second)
    same(result, tw.run(second))
    assert result.summary["shape_range_m"] != before.summary["shape_range_m"]


def test_a_mesh_that_follows_the_contact_is_not_shared():
    """
    requirement: variants with meshes of their own are not mixed up.
    """
    path = DEMOS / "cylinder_on_block.toml"
    base = ("mesh.degree=2", "contact.positioning=false")
    cases = [tw.load(path, (*base, f'load.approach="{δ} mm"')) for δ in (0.01, 0.05)]
    assert grouped(cases) == [[0], [1]]
    series = Series()
    for case in cases:
        same(run_in(series, case), tw.run(case))
    positioned = [tw.load(path, ("contact.positioning=true",)) for _ in range(2)]
    assert grouped(positioned) == [[0], [1]]


def test_those_that_share_more_are_neighbours():
    """
    requirement: within a group conduction is made once for each cooling, whatever the order.
    """
    coolings = ["500 W/(m^2 K)", "900 W/(m^2 K)"]
    cases = [
        block(f'load.force="{force} kN"', f'heat.cooling.block_top="{h}"', f"mesh.degree={degree}")
        for degree in (2, 3)
        for force in (1, 2)
        for h in coolings
    ]
    assert grouped(cases) == [[0, 2, 1, 3], [4, 6, 5, 7]]


def test_equal_stiffnesses_are_neighbours(factors):
    """
    requirement: groups that differ in expansion follow each other, whatever the order: each
    stiffness is factorised once.
    """
    cases = [
        block(
            RUNNING_IN,
            f'bodies.block.expansion="{expansion} 1/K"',
            f'bodies.block.young_modulus="{modulus} GPa"',
        )
        for expansion in ("1e-5", "2e-5")
        for modulus in (100, 200)
    ]
    order = grouped(cases)
    assert order == [[0], [2], [1], [3]]
    series = Series()
    for (number,) in order:
        run_in(series, cases[number])
    assert len(factors) == 2 * 4


def test_speed_needs_new_conduction_where_the_disk_carries_heat():
    """
    requirement: motion enters the conduction only where heat.advection is "resolved".
    """
    speeds = [f'motion.angular_velocity="{speed} rad/s"' for speed in (0.1, 0.2)]
    for advection, shared in (("none", True), ("resolved", False)):
        one, two = (
            inputs(model_of(block(speed, f'heat.advection="{advection}"', *STORING)))
            for speed in speeds
        )
        assert one.elasticity == two.elasticity
        assert (one.conduction == two.conduction) == shared


def test_a_variant_that_fails_leaves_the_next_one_alone():
    """
    requirement: after a failure the parts at hand are still those of the cases before.
    """
    path = DEMOS / "pivoted_block.toml"
    base = ("mesh.degree=2", "mesh.elements=4")
    against = ('motion.velocity="50 mm/s"', "contact.friction=9.0")
    good, locked = tw.load(path, base), tw.load(path, (*base, *against))
    series = Series()
    before = run_in(series, good)
    with pytest.raises(tw.ComputationError):
        run_in(series, locked)
    same(run_in(series, good), before)


def test_heat_changes_the_shape_and_not_the_pressure():
    """
    requirement: the conclusion of the papers; the faster the disk, the more heat, the more shape.
    """
    speeds = ["1e-6 rad/s", "0.3 rad/s", "0.6 rad/s", "1.2 rad/s"]
    runs = tw.sweep(block(), {"motion.angular_velocity": speeds})
    assert [values["motion.angular_velocity"] for values, _ in runs] == speeds
    pressures = np.array([result.interface.pressure for _, result in runs])
    shapes = np.array([result.interface.shape for _, result in runs])
    assert np.ptp(pressures, axis=0).max() < 1e-9 * pressures.max()
    cold, *hot = shapes - shapes.mean(axis=1, keepdims=True)
    bent = [np.ptp(shape - cold) for shape in hot]
    np.testing.assert_allclose(bent, np.array([0.3, 0.6, 1.2]) * bent[0] / 0.3, rtol=1e-4)
    assert bent[-1] > 0.5 * np.ptp(cold)

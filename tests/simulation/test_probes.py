"""Temperatures at the probes of a model."""

import sys
from pathlib import Path

from mpi4py import MPI

import numpy as np
import pytest

import thermowear as tw
from thermowear.reference.heat import contact_temperatures

from ..case.starter import solved
from ..conftest import DEMOS
from ..test_parallel import same_on_two_ranks

BLOCKS = "stacked-blocks"
COLD = 293.15
HEAT = 0.2 * 5e6 * 0.1
AT = {"above": (0.0031, 0.0042), "below": (0.0077, -0.0133), "on_top": (0.0, 0.01)}
PROBES = {f"probes.{name}": {"point": [f"{x!r} m", f"{y!r} m"]} for name, (x, y) in AT.items()}
IN_TIME = (
    "heat.transient=true",
    *(
        f'bodies.{body}.{key}="{value}"'
        for body in ("upper", "lower")
        for key, value in (("density", "7800 kg/m^3"), ("specific_heat", "500 J/kg/K"))
    ),
    "analysis.type=transient",
    "analysis.end_time=2 s",
    'analysis.output_times=["1 s"]',
    "mesh.degree=3",
    "mesh.elements=4",
    'probes.above.point=["3.1 mm", "4.2 mm"]',
    'probes.below.point=["7.7 mm", "-13.3 mm"]',
    'probes.face.point=["5 mm", "0 mm"]',
    "probes.face.body=lower",
)


def in_time(*more):
    return tw.run(tw.load(DEMOS / "stacked_blocks.toml", (*IN_TIME, *more)))


def columns(result):
    """Temperatures at the probes, shape (n_steps, n_probes)."""
    return np.array([row.temperature for row in result.probe_history]).reshape(-1, 3)


def test_a_linear_profile():
    """requirement: temperatures inside both blocks, and on their ends, to 1e-9 of their range."""
    result = solved(BLOCKS, PROBES)
    (upper, lower), _ = contact_temperatures(
        (0.01, 0.02), (50.0, 15.0), (COLD, COLD), HEAT, 0.5, 1e4
    )
    expected = {
        "above": upper + (COLD - upper) * 0.42,
        "below": lower + (COLD - lower) * 0.665,
        "on_top": COLD,
    }
    found = result.summary["probes"]
    assert list(found) == list(expected)
    for name, numbers in found.items():
        error = abs(numbers["temperature_K"] - expected[name])
        assert error < 1e-9 * (max(upper, lower) - COLD)


def test_rows_in_time():
    """requirement: one row per probe and step; the last ones agree with the summary."""
    result = in_time()
    times = [row.time for row in result.history]
    assert [row.time for row in result.probe_history] == list(np.repeat(times, 3))
    assert [row.probe for row in result.probe_history[:3]] == [1, 2, 3]
    found = columns(result)
    assert found[0] == pytest.approx(COLD, rel=1e-12)
    assert list(found[-1]) == [
        numbers["temperature_K"] for numbers in result.summary["probes"].values()
    ]
    face = [row.mean_temperature_2 for row in result.heat]
    np.testing.assert_allclose(found[:, 2], face, rtol=1e-9)
    assert np.all(np.diff(found[:, 0]) > -1e-5)
    assert found[-1, 0] > COLD + 1.0
    assert "probes" in result.tables()


def test_quasi_steady_heat():
    """requirement: temperatures at each step also without stored heat."""
    steady = ("heat.transient=false", "analysis.end_time=1 s")
    found = columns(in_time(*steady))
    assert len(found) > 2
    np.testing.assert_allclose(found, np.tile(found[-1], (len(found), 1)), rtol=1e-6)
    assert found[-1].min() > COLD + 1.0


def test_points_in_curved_cells():
    """requirement: temperatures of the fields of a round disk, sampled by dolfinx, to 1e-9."""
    case, small = DEMOS / "block_on_disk.toml", ("mesh.degree=3", "mesh.elements=4")
    fields = tw.run(tw.load(case, small)).fields
    of_disk = np.flatnonzero(fields.body == 2)
    hottest = of_disk[np.argsort(fields.temperature[of_disk].max(axis=1))[::-1]]
    chosen = [(cell, 5) for cell in hottest[[0, 1, 7]]]
    points = [
        f"probes.p{k}={{point=['{x!r} m', '{y!r} m'], body='disk'}}"
        for k, (x, y) in enumerate(fields.points[at][:2].tolist() for at in chosen)
    ]
    found = tw.run(tw.load(case, (*small, *points))).summary["probes"].values()
    expected = [fields.temperature[at] for at in chosen]
    assert [each["temperature_K"] for each in found] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        (['probes.a.point=["50 mm", "0 mm"]'], r"probes\.a\.point: .* lies outside all bodies"),
        (
            ['probes.a.point=["1 mm", "5 mm"]', "probes.a.body=lower"],
            r"probes\.a\.point: .* lies outside the body 'lower'",
        ),
        (['probes.a.point=["5 mm", "0 mm"]'], r"probes\.a: .* lies in lower and upper; give"),
        (['probes.a.point=["5 mm"]'], r"probes\.a\.point: found 1 coordinates"),
        (['probes.a.point=["5 mm", "0 mm"]', "probes.a.body=x"], r"probes\.a\.body: unknown body"),
    ],
)
def test_wrong_probes(overrides, words):
    """requirement: a line with the path of the key."""
    with pytest.raises(tw.CaseError, match=words):
        tw.run(tw.load(DEMOS / "stacked_blocks.toml", overrides))


def test_a_probe_needs_heat():
    """requirement: refused when the case is read."""
    point = 'probes.a.point=["100 mm", "10 mm"]'
    with pytest.raises(tw.CaseError, match=r"probes\.a: needs temperatures"):
        tw.load(DEMOS / "annular_punch_running_in.toml", [point])


def test_a_probe_is_worn_off():
    """requirement: NaN once the meshes have followed the wear beyond the point."""
    small = ("mesh.degree=3", "mesh.elements=3", "analysis.output_times=[]")
    points = (
        'probes.near.point=["70 mm", "1 mm"]',
        'probes.far.point=["70 mm", "40 mm"]',
        "analysis.end_time=40 h",
    )
    result = tw.run(tw.load(DEMOS / "annular_punch_deep.toml", (*small, *points)))
    assert result.summary["geometry_updates"] > 1
    near, far = np.array([row.temperature for row in result.probe_history]).reshape(-1, 2).T
    assert np.isfinite(far).all()
    assert np.isfinite(near[:2]).all()
    assert np.isnan(near[-1])
    assert result.summary["probes"]["near"]["temperature_K"] is None


def of_disk():
    """Temperatures at probes in the block and in the disk."""
    points = (
        "probes.block={point=['0.1 mm', '25 mm']}",
        "probes.rim={point=['-1 mm', '19 mm']}",
        "probes.deep={point=['10 mm', '5 mm'], body='disk'}",
    )
    small = ("mesh.degree=3", "mesh.elements=4", "heat.advection=none")
    found = tw.run(tw.load(DEMOS / "block_on_disk.toml", (*small, *points)))
    return np.array([each["temperature_K"] for each in found.summary["probes"].values()])


def test_several_ranks(tmp_path):
    """requirement: the same temperatures on two ranks."""
    same_on_two_ranks("tests.simulation.test_probes", tmp_path, {"temperature": of_disk()})


if __name__ == "__main__":
    np.savez(Path(sys.argv[1]) / f"found_{MPI.COMM_WORLD.rank}.npz", temperature=of_disk())

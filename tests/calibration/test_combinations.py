"""Parameters that depths cannot tell apart, and measurements that do."""

import numpy as np
import pytest

import thermowear as tw
from thermowear.verification.check import starter

FLAT = (
    'analysis={type="transient", end_time="100 s"}',
    "mesh.degree=1",
    "mesh.elements=2",
    "calibrate.tolerance=1e-6",
)
K = 'start="1e-8 1/MPa", lower="1e-10 1/MPa", upper="1e-6 1/MPa", scale="log"'
FRICTION = (
    f'calibrate.parameters.k={{key="wear.upper.coefficient", {K}}}',
    'calibrate.parameters.mu={key="contact.friction", start=0.2, lower=0.05, upper=0.9, '
    'scale="log"}',
)
EXPONENT = (
    'wear.upper.per="pressure"',
    'calibrate.parameters.k={start=1e-8, lower=1e-10, upper=1e-6, scale="log"}',
    "calibrate.parameters.b={start=1.1, lower=0.5, upper=3.0}",
    'calibrate.set={"wear.upper.coefficient"="{k} 1/MPa^{b}", '
    '"wear.upper.pressure_exponent"="{b}"}',
)
TIMES = np.array([40.0, 70.0, 100.0])


def calibrated(path, keys, depths, *, loads=(), distances=False):
    """Calibration of two blocks under uniform pressure by exact depths, under each load [µm]."""
    files, along = {}, "sliding_distance [m]" if distances else "time [s]"
    for k, found in enumerate(depths):
        rows = (
            f"{place!r}, {depth!r}, {0.05 * depth!r}"
            for place, depth in zip(
                map(float, 0.1 * TIMES if distances else TIMES), found, strict=True
            )
        )
        name = f"depth{k}"
        files[name] = path / f"{name}.csv"
        head = f"{along}, max_wear_1 [um], deviation [um]"
        files[name].write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    observations = [
        f'calibrate.observations.depth{k}.set={{"load.mean_pressure"="{load} MPa"}}'
        for k, load in enumerate(loads)
    ]
    case = starter("stacked-blocks", *FLAT, *keys, *observations, without=("heat",))
    return tw.calibrate(case, files)


def exact(coefficient, pressure, exponent=1.0):
    """Depths ``k p^b s`` [µm]."""
    return [float(1e6 * coefficient * pressure**exponent * 0.1 * time) for time in TIMES]


def test_friction_and_coefficient(tmp_path):
    """requirement: depths determine `k · mu^1.00`, and a force or torque would settle it."""
    found = calibrated(tmp_path, FRICTION, [exact(2e-8 * 0.3, 5.0)])
    (combination,) = found.identifiability.combinations
    assert combination.text == "k · mu^1.00"
    assert combination.value(found.fit.values) == pytest.approx(6e-9, rel=1e-6, abs=0.0)
    assert not np.isfinite(list(found.standard_errors.values())).any()
    assert any("friction_force" in one.text for one in found.suggestions)
    assert "do not determine" in found.notes()[0]


def test_exponent_by_one_load_and_by_two(tmp_path):
    """requirement: one pressure determines `k · p^b` with p in MPa, two determine both."""
    depths = [exact(2e-8, pressure, 1.4) for pressure in (5.0, 20.0)]
    found = calibrated(tmp_path, EXPONENT, depths[:1])
    (combination,) = found.identifiability.combinations
    assert combination.text == "k · 5^b"
    assert any("load.mean_pressure" in one.text for one in found.suggestions)
    found = calibrated(tmp_path, EXPONENT, depths, loads=(5.0, 20.0))
    assert found.identifiability.identified
    assert found.fit.values == pytest.approx([2e-8, 1.4], rel=1e-6, abs=0.0)
    assert found.suggestions == ()


def test_distances_are_times(tmp_path):
    """requirement: measurements at sliding distances give the same as at the times of them."""
    depths = [exact(2e-8 * 0.2, 5.0)]
    one, two = (
        calibrated(tmp_path, FRICTION[:1], depths, distances=along) for along in (False, True)
    )
    assert two.fit.values == pytest.approx(one.fit.values, rel=1e-9, abs=0.0)
    assert one.fit.values == pytest.approx([2e-8], rel=1e-6, abs=0.0)
    assert two.runs == one.runs + 1  # the first run finds the times


def test_distance_at_the_end_needs_no_run_for_its_time(tmp_path):
    """requirement: depths at the end of the run, by its distance: no more runs than by its time."""
    data, runs = tmp_path / "depth.csv", []
    for place in ("time [s], 100", "sliding_distance [m], 10"):
        along, _, where = place.partition(", ")
        depth = exact(2e-8 * 0.2, 5.0)[-1]
        text = f"{along}, max_wear_1 [um], deviation [um]\n{where}, {depth!r}, 0.01\n"
        data.write_text(text, encoding="utf-8")
        case = starter("stacked-blocks", *FLAT, FRICTION[0], without=("heat",))
        runs.append(tw.calibrate(case, data).runs)
    assert runs[0] == runs[1]

"""MPI: results independent of the number of ranks, and errors reported once."""

import json
import os
import shutil
import subprocess
import sys

import numpy as np
import pytest
import tomli_w

from thermowear.app.cli import main

from .conftest import COLD_RUNNING_IN, DEMOS, HOT
from .scripting import on_ranks
from .simulation.geometry_update.test_outer_loop import STRIP

pytestmark = pytest.mark.skipif(shutil.which("mpirun") is None, reason="needs mpirun")

ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def thermowear(ranks, *arguments, module="thermowear", timeout=300):
    """Run the program, or another module, on some ranks, for some seconds at most."""
    command = [sys.executable, "-m", module, *map(str, arguments)]
    if ranks > 1:
        command = ["mpirun", "--oversubscribe", "-n", str(ranks), *command]
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("PMIX", "PRTE_"))}
    return subprocess.run(
        command,
        capture_output=True,
        text=True,
        check=False,
        env=environment | ROOT,
        timeout=timeout,
    )


def same_on_two_ranks(module, folder, expected, *arguments, rtol=1e-8, timeout=300):
    """Values by name that a module saves on each of two ranks, against serial ones.

    Differences are relative to the largest value of the same name.
    """
    done = thermowear(2, *arguments, folder, module=module, timeout=timeout)
    assert done.returncode == 0, done.stderr
    for rank in (0, 1):
        parallel = np.load(folder / f"found_{rank}.npz")
        for name, values in expected.items():
            atol = rtol * np.fmax.reduce(np.abs(values).ravel(), initial=0.0)  # NaN left out
            np.testing.assert_allclose(parallel[name], values, rtol=0.0, atol=atol, err_msg=name)


def summaries(tmp_path, case, *overrides):
    found = []
    for ranks in (1, 2):
        folder = tmp_path / f"on{ranks}"
        words = ["run", case, "-o", folder, "--no-pictures"]
        words += [f"--set={text}" for text in overrides]
        if ranks == 1:  # here, without a process of its own
            assert main([*map(str, words)]) == 0
        else:
            done = thermowear(ranks, *words)
            assert done.returncode == 0, done.stderr
        found.append((json.loads((folder / "summary.json").read_text()), folder))
    return found


def slow(*values):
    return pytest.param(*values, marks=pytest.mark.slow)


@pytest.mark.parametrize(
    ("case", "overrides"),
    [
        (HOT, ["mesh.degree=4"]),
        slow(COLD_RUNNING_IN, ["mesh.degree=6"]),
        slow(COLD_RUNNING_IN, ["mesh.degree=3", "mesh.bodies.plate.elements=7"]),
        slow(DEMOS / "cylinder_on_block.toml", ["contact.method=nitsche"]),
        (
            DEMOS / "cylinder_stick_slip.toml",
            ["contact.method=nitsche", "mesh={degree=2, elements=16}", "analysis.increments=1"],
        ),
        slow(
            DEMOS / "sphere_on_block_coated.toml",
            ["mesh.elements=20", "analysis.end_time=100 s", "analysis.output_times=['1 s']"],
        ),
        slow(DEMOS / "cylinder_stick_slip.toml", ["mesh.degree=2", "analysis.increments=4"]),
        slow(
            DEMOS / "sphere_fretting.toml",
            ["mesh.elements=4", "analysis.increments=2", "wear.cycles=10"]
            + ["analysis.output_times=['0.0625 s']"],
        ),
        slow(DEMOS / "disk_brake_stability.toml", ["mesh.degree=4"]),
        slow(DEMOS / "disk_brake_stop.toml", ["mesh.degree=3", "analysis.end_time=6 s"]),
    ],
)
def test_two_ranks_give_the_serial_numbers(tmp_path, case, overrides):
    """requirement: every number of the summary to 1e-8 of the serial run."""
    (serial, folder), (parallel, other) = summaries(tmp_path, case, *overrides)
    noise = {"seconds", "heat_balance_relative_error", "equilibrium_relative_error"}
    for key in serial.keys() - noise - {"bodies"}:
        expected = serial[key]
        if serial["model"] == "3d" and key.endswith("_error_estimate_relative"):
            continue  # by smoothing steps on the cells of each rank
        if key in ("contact_zones_m", "static_speed_factors", "layer_volumes_1_m3"):
            np.testing.assert_allclose(parallel[key], expected, rtol=1e-8)
            continue
        if isinstance(expected, float):
            # a force that vanishes by symmetry is rounding of the load
            noise_of_load = 1e-12 * serial["normal_force_N"] if "_force_" in key else 0.0
            expected = pytest.approx(expected, rel=1e-8, abs=noise_of_load)
            # differences of numbers near to each other, relative to them
            if key == "distance_from_steady" or key.endswith("_error_estimate_relative"):
                expected = pytest.approx(serial[key], abs=1e-8)
            if key.startswith("growth_rate"):  # what is left of heating and wear
                rates = [abs(serial[k]) for k in serial if k.startswith("growth_rate")]
                expected = pytest.approx(serial[key], abs=1e-8 * max(rates))
        assert parallel[key] == expected, key
    assert parallel["equilibrium_relative_error"] < 1e-9
    for name, body in serial["bodies"].items():
        for key, value in body.items():
            if key.endswith("relative_error"):
                assert parallel["bodies"][name][key] < 1e-9
            else:
                assert parallel["bodies"][name][key] == pytest.approx(value, rel=1e-8), key
    assert json.loads((other / "run.json").read_text())["ranks"] == 2
    assert {f.name for f in folder.iterdir()} == {f.name for f in other.iterdir()}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run", HOT, "--set", "bodies.punch.poisson_ratio=0.5"], "bodies.punch.poisson_ratio"),
        slow(["run", "missing.toml"], "missing.toml"),
        slow(["run", HOT, "--sett", "mesh.degree=2"], "--sett"),
        slow(["run", HOT, "-o", "/proc/nowhere", "--set=mesh.degree=2"], "-o /proc/nowhere"),
    ],
)
def test_an_error_ends_all_ranks_with_one_message(tmp_path, arguments, message):
    """requirement: invalid case or unwritable folder: exit code 1, one message, no deadlock."""
    done = thermowear(2, *arguments)
    assert done.returncode == 1
    assert done.stderr.count(message) == 1
    assert "Traceback" not in done.stderr


def test_a_body_worn_through_is_told_alike(tmp_path):
    """requirement: time and place, of several that wear alike the same one; the run succeeds."""
    case, told = tmp_path / "case.toml", []
    case.write_text(tomli_w.dumps(STRIP | {"mesh": {"degree": 2, "elements": 3, "grading": 0.5}}))
    for ranks in (1, 2):
        folder = tmp_path / f"on{ranks}"
        words = ("run", case, "-o", folder, "--no-pictures", '--set=wear.update="never"')
        done = thermowear(ranks, *words)
        assert done.returncode == 0, done.stderr
        told += [line for line in done.stdout.splitlines() if "worn through" in line]
    assert len(told) == 2
    assert told[0] == told[1]


def test_a_model_in_python_on_a_distributed_mesh(tmp_path):
    """requirement: two ranks give the interface and the fields of the serial model to 1e-8."""
    same_on_two_ranks("tests.scripting.on_ranks", tmp_path, on_ranks.computed(), "steady")


def test_a_state_is_saved_on_two_ranks(tmp_path):
    """requirement: continued from its file a running-in is bit by bit the same on each rank."""
    done = thermowear(2, "saved", tmp_path, module="tests.scripting.on_ranks")
    assert done.returncode == 0, done.stderr
    first, second = (np.load(tmp_path / f"found_{rank}.npz") for rank in (0, 1))
    assert first["state"].max() > 0.0
    assert all(np.array_equal(first["state"], other) for other in (first["read"], second["read"]))


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        ("empty", "Body 'plate': has no cells"),
        ("bent", "must lie in a plane z = const"),
        ("unsendable", "local object"),
    ],
)
def test_a_fault_of_one_rank_is_raised_on_all(tmp_path, fault, message):
    """requirement: no deadlock; each rank raises the error that rank 0 finds."""
    done = thermowear(2, fault, tmp_path, module="tests.scripting.on_ranks")
    assert done.returncode == 0, done.stderr
    assert all(message in (tmp_path / f"fault_{rank}.txt").read_text() for rank in (0, 1))


@pytest.mark.slow
def test_the_rank_that_speaks_is_waited_for():
    """requirement: one message, also if other ranks find the error much earlier."""
    late = f'[ "$OMPI_COMM_WORLD_RANK" = 1 ] || sleep 2; exec {sys.executable} -m thermowear "$@"'
    command = ["mpirun", "--oversubscribe", "-n", "2", "sh", "-c", late, "sh", "run", HOT, "--sett"]
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("PMIX", "PRTE_"))}
    done = subprocess.run(
        list(map(str, command)),
        capture_output=True,
        text=True,
        check=False,
        env=environment | ROOT,
        timeout=100,
    )
    assert done.returncode == 1
    assert done.stderr.count("--sett") == 1


@pytest.mark.slow
def test_a_failed_computation_ends_all_ranks(tmp_path):
    """requirement: exit code 2 and a readable run.json."""
    done = thermowear(
        2,
        "run",
        HOT,
        "-o",
        tmp_path / "out",
        "--no-pictures",
        "--set=mesh.degree=2",
        '--set=motion.angular_velocity="1000 rad/s"',
        "--set=analysis.type=initial",
    )
    assert done.returncode == 2
    assert done.stderr.count("instability") == 1
    assert json.loads((tmp_path / "out" / "run.json").read_text())["status"] == "failed"


def test_rows_are_shared_by_the_ranks():
    """requirement: each rank computes some rows, all have all of them, and an error on one rank is
    raised on all.
    """
    done = thermowear(2, module="tests.rows_on_ranks")
    assert done.returncode == 0, done.stderr

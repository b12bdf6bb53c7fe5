"""Ctrl-C in the middle of a run."""

import json
import signal
import subprocess
import sys
import time

import pytest

from thermowear.output import tables
from thermowear.output.quantities import HISTORY, INTERFACE

from .conftest import COLD_RUNNING_IN


def test_a_reader_that_goes_away_does_not_end_the_run(tmp_path):
    """requirement: ``thermowear run … | head`` computes to the end."""
    command = (
        f"{sys.executable} -m thermowear run {COLD_RUNNING_IN} -o {tmp_path}/out --no-pictures"
    )
    command += " --set mesh.degree=2 | true; exit ${PIPESTATUS[0]}"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert json.loads((tmp_path / "out" / "run.json").read_text())["status"] == "done"


@pytest.mark.parametrize(
    "number", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.slow)]
)
def test_interrupted_run_leaves_readable_results(tmp_path, number):
    """requirement: what was computed before Ctrl-C is there, complete and consistent."""
    folder = tmp_path / "out"
    process = subprocess.Popen(
        [sys.executable, "-m", "thermowear", "run", str(COLD_RUNNING_IN), "-o", str(folder)]
        + ["--no-pictures", "--set=mesh.degree=4", "--set=analysis.tolerance=1e-9"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        # where the tests themselves run in the background, Ctrl-C is ignored and that is inherited
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    history = folder / "history.csv"
    deadline = time.monotonic() + 120
    while not (history.exists() and history.read_text().count("\n") > 10):
        assert process.poll() is None, process.stderr.read()
        assert time.monotonic() < deadline
        time.sleep(0.05)
    process.send_signal(number)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert said.strip() == "error: interrupted"
    assert json.loads((folder / "run.json").read_text())["status"] == "interrupted"
    rows = tables.read(history, HISTORY)
    summary = json.loads((folder / "summary.json").read_text())
    interface = tables.read(folder / "interface.csv", INTERFACE)
    assert summary["time_s"] == pytest.approx(rows["time"][-1], rel=1e-12)
    assert 0 < summary["time_s"] < 200
    volume = interface["weight"] @ interface["wear_1"]
    assert volume == pytest.approx(rows["wear_volume_1"][-1], rel=1e-12, abs=0.0)
    assert (folder / "fields.vtu").stat().st_size > 1000

"""Ctrl-C in the middle of a run."""

import itertools
import json
import signal
import subprocess
import sys
import time

import pytest

import thermowear as tw
from thermowear.app.cli import main
from thermowear.app.session import Recorder
from thermowear.errors import ComputationError, UnwritableError
from thermowear.output import tables
from thermowear.output.folder import ResultsFolder
from thermowear.simulation import Observer
from thermowear.simulation.runtime.history import AnalysisHistory

from ..conftest import COLD_RUNNING_IN

SMALL = ("mesh.degree=2", "mesh.elements=4", "analysis.end_time=20 s", "analysis.output_times=[]")
SHORT = [f"--set={change}" for change in SMALL]
TWO = ["sweep", str(COLD_RUNNING_IN), *SHORT, "--over", "contact.friction=0.25,0.3"]


@pytest.fixture
def after_the_last_step(heeds_ctrl_c, monkeypatch):
    """Ctrl-C while the state at the end of a run is saved: no step comes after it."""
    sent = []

    def interrupted(original):
        def checkpoint(self, saved):
            original(self, saved)
            if saved.progress.time == pytest.approx(20.0) and not sent:
                sent.append(saved.progress.time)
                signal.raise_signal(signal.SIGINT)

        return checkpoint

    handler = signal.getsignal(signal.SIGTERM)
    for kind in (Observer, Recorder):
        monkeypatch.setattr(kind, "checkpoint", interrupted(kind.checkpoint))
    yield
    signal.signal(signal.SIGTERM, handler)
    assert sent


@pytest.fixture
def beside_a_failure(heeds_ctrl_c, monkeypatch):
    """Return a function: Ctrl-C, and then an error, when a state has been kept so many times."""
    handler, count = signal.getsignal(signal.SIGTERM), itertools.count(1)

    def make(number, error):
        def save_if_due(self):
            if next(count) == number:
                signal.raise_signal(signal.SIGINT)
                raise error

        monkeypatch.setattr(AnalysisHistory, "save_if_due", save_if_due)

    yield make
    signal.signal(signal.SIGTERM, handler)


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
    """requirement: results up to Ctrl-C are complete and consistent."""
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
    rows = tables.read(history)
    summary = json.loads((folder / "summary.json").read_text())
    interface = tables.read(folder / "interface.csv")
    assert summary["time_s"] == pytest.approx(rows["time"][-1], rel=1e-12)
    assert 0 < summary["time_s"] < 200
    volume = interface["weight"] @ interface["wear_1"]
    assert volume == pytest.approx(rows["wear_volume_1"][-1], rel=1e-12, abs=0.0)
    assert (folder / "fields.vtu").stat().st_size > 1000


def status(folder):
    return json.loads((folder / "run.json").read_text())["status"]


def test_ctrl_c_after_the_last_step_of_a_run(after_the_last_step, tmp_path, capsys):
    """requirement: a requested stop is not lost: complete results, exit code 130."""
    words = ["run", str(COLD_RUNNING_IN), *SHORT, "-o", str(tmp_path / "r"), "--no-pictures"]
    assert main(words) == 130
    assert capsys.readouterr().err == "error: interrupted\n"
    assert status(tmp_path / "r") == "interrupted"
    assert json.loads((tmp_path / "r" / "summary.json").read_text())["time_s"] == 20.0
    assert main([*words, "--resume"]) == 0
    assert status(tmp_path / "r") == "done"


def test_ctrl_c_after_the_last_step_of_a_variant(after_the_last_step, tmp_path):
    """requirement: no further variant begins, and the exit code is 130."""
    folder = tmp_path / "s"
    assert main([*TWO, "-o", str(folder), "--processes", "1", "--no-pictures"]) == 130
    assert status(folder) == status(folder / "001") == "interrupted"
    assert json.loads((folder / "001" / "summary.json").read_text())["time_s"] == 20.0
    assert not (folder / "002").exists()


def test_ctrl_c_after_the_last_step_of_a_variant_in_python(after_the_last_step):
    """requirement: `tw.sweep` does not start the next variant."""
    with pytest.raises(KeyboardInterrupt):
        tw.sweep(tw.load(COLD_RUNNING_IN, SMALL), {"contact.friction": [0.25, 0.3]})


def test_ctrl_c_after_the_last_step_of_a_coarser_run(after_the_last_step, tmp_path, monkeypatch):
    """requirement: `--accuracy` does not start the finer discretisation."""
    folder = tmp_path / "r"
    words = ["run", str(COLD_RUNNING_IN), *SHORT, "-o", str(folder), "--no-pictures", "--accuracy"]
    monkeypatch.setattr(Recorder, "checkpoint", lambda *_: None)  # the run itself passes
    assert main(words) == 130
    assert status(folder) == "interrupted"


@pytest.mark.parametrize(
    ("step", "error"),
    [(1, UnwritableError("no room")), (3, ComputationError("no answer"))],
    ids=["nothing to keep", "kept"],
)
def test_ctrl_c_beside_an_error(beside_a_failure, tmp_path, capsys, step, error):
    """requirement: both are kept: the sweep ends, and the failure is reported."""
    folder = tmp_path / "s"
    beside_a_failure(step, error)
    assert main([*TWO, "-o", str(folder), "--processes", "1", "--no-pictures"]) == 130
    run = json.loads((folder / "001" / "run.json").read_text())
    assert run["status"] == "interrupted"
    assert run["message"] == f"interrupted; the computation had failed: {error}"
    assert not (folder / "002").exists()


def test_ctrl_c_where_the_folder_cannot_be_closed(after_the_last_step, tmp_path, monkeypatch):
    """requirement: an interrupt ends the sweep also on a full disk."""
    folder, close = tmp_path / "s", ResultsFolder.close

    def fail(self, *words):
        close(self, *words)
        raise OSError("no room")

    monkeypatch.setattr(ResultsFolder, "close", fail)
    assert main([*TWO, "-o", str(folder), "--processes", "1", "--no-pictures"]) == 130
    assert not (folder / "002").exists()


WHILE_IMPORTING = """
import importlib.abc
import signal
import sys

signal.signal(signal.SIGINT, signal.default_int_handler)


class Interrupted(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name == "thermowear.app.cli":
            signal.raise_signal(signal.SIGINT)


sys.meta_path.insert(0, Interrupted())
from thermowear.__main__ import run

sys.exit(run())
"""


def test_ctrl_c_while_the_program_is_imported():
    """requirement: exit code 130 and one line, no traceback."""
    command = [sys.executable, "-c", WHILE_IMPORTING]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (130, "error: interrupted\n")


LONG = {
    "library": "hashlib.pbkdf2_hmac('sha256', b'', b'', 2 * 10**9)",  # Python cannot end it
    "step": "[None for _ in iter(int, 1)]",
}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("long", LONG)
def test_a_long_step_is_interrupted(tmp_path, long, number):
    """requirement: one signal ends a run in the middle of a step, also in a call of a library that
    takes hours: exit code 130, and a record that says so.
    """
    program = f"""
import hashlib, sys
from thermowear import interrupts
from thermowear.app.cli import main
from thermowear.simulation import time_loop
interrupts._PATIENCE = 0.5
def hanging(*_, **__):
    print("hangs", flush=True)
    {LONG[long]}
time_loop._Steps.next = hanging
sys.exit(main({["run", str(COLD_RUNNING_IN), "-o", f"{tmp_path}/out", "--no-pictures", *SHORT]}))
"""
    process = subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    while "hangs" not in process.stdout.readline():
        assert process.poll() is None, process.stderr.read()
    process.send_signal(number)
    _, said = process.communicate(timeout=60)
    assert (process.returncode, said.strip()) == (130, "error: interrupted")
    assert status(tmp_path / "out") == "interrupted"

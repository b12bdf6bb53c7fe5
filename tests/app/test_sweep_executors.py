"""Sweeps that are killed and go on, on MPI ranks and on workers of Dask."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import thermowear as tw
from thermowear.app.batch.pool import ProcessPool
from thermowear.app.cli import main
from thermowear.output.variants.folder import JOURNAL

from ..conftest import DEMOS

LEVER = DEMOS / "pivoted_block.toml"
SMALL = ("--set", "mesh.degree=2", "--set", "mesh.elements=3", "--no-pictures")
LOCKED = ("--set", 'motion.velocity="50 mm/s"')
OVER = ("--over", "contact.friction=0.1,9.0,0.2,0.3,0.15,0.25", "--over", "load.force=1 kN,2 kN")
"""Twelve variants, of which two have no equilibrium."""
WORDS = (str(LEVER), *SMALL, *LOCKED, *OVER)
pytestmark = pytest.mark.usefixtures("in_folder")


def rows(folder) -> list[dict[str, str]]:
    with (Path(folder) / "sweep.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def same(one, other) -> None:
    """Tables of two sweeps are equal, but for the time they took."""
    assert len(one) == len(other)
    for a, b in zip(one, other, strict=True):
        assert a.keys() == b.keys()
        for name in a.keys() - {"seconds"}:
            try:
                numbers = float(a[name]), float(b[name])
            except ValueError:
                assert a[name] == b[name]
                continue
            tiny = 1e-9 if name.endswith(("error", "relative")) else 0.0
            np.testing.assert_allclose(*numbers, rtol=1e-7, atol=tiny, err_msg=name)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Table of the sweep that is not interrupted."""
    folder = tmp_path_factory.mktemp("whole") / "s"
    assert main(["sweep", *WORDS, "-o", str(folder)]) == 2
    table = rows(folder)
    assert [row["status"] for row in table].count("done") == 10
    return table


def journal(folder) -> list[str]:
    path = Path(folder) / JOURNAL
    return path.read_text().splitlines() if path.exists() else []


def start(*words):
    return subprocess.Popen(
        [sys.executable, "-m", "thermowear", "sweep", *words],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )


def kill_after(process, folder, count):
    """Kill a sweep and its workers once some more variants have ended."""
    known, deadline = len(journal(folder)), time.monotonic() + 120
    while len(journal(folder)) < known + count and process.poll() is None:
        assert time.monotonic() < deadline
        time.sleep(0.01)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()


@pytest.mark.parametrize("processes", ["1", pytest.param("2", marks=pytest.mark.slow)])
def test_a_killed_sweep_goes_on(processes, whole):
    """requirement F6: killed twice and resumed, its table is that of one that was not."""
    words = [*WORDS, "-o", "s", "--processes", processes]
    kill_after(start(*words), "s", 2)
    kill_after(start(*words, "--resume"), "s", 2)
    known = len(journal("s"))
    assert known >= 2
    with Path("s", JOURNAL).open("a") as file:
        file.write('{"variant": 1')  # a line that was being written
    assert main(["sweep", *words, "--resume"]) == 2
    same(rows("s"), whole)
    assert len(journal("s")) <= 14
    before = journal("s")
    assert main(["sweep", *words, "--resume"]) == 2
    assert journal("s") == before


def test_only_the_same_sweep_is_resumed(capsys):
    """requirement: a sweep whose case or values have changed is not mixed with an earlier one."""
    words = ["sweep", str(LEVER), *SMALL, "--over", "contact.friction=0.1,0.2", "-o", "s"]
    assert main([*words, "--resume"]) == 0
    assert main([*words[:-3], "contact.friction=0.1,0.3", "-o", "s", "--resume"]) == 1
    assert "differ from those of the sweep in s" in capsys.readouterr().err
    assert json.loads(Path("s/run.json").read_text())["status"] == "done"


def test_ranks(whole):
    """requirement F6: `mpirun -n 3` gives the table of one process, and its exit code."""
    command = ["mpirun", "-n", "3", sys.executable, "-m", "thermowear", "sweep", *WORDS]
    done = subprocess.run(
        [*command, "-o", "s", "--executor", "mpi"], capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 2, done.stderr
    assert "2 of 12 variants failed" in done.stderr
    same(rows("s"), whole)


def test_workers_of_dask(whole):
    """requirement F6: workers of Dask give the table of one process."""
    pytest.importorskip("distributed")
    done = subprocess.run(
        [sys.executable, "-m", "thermowear", "sweep", *WORDS, "-o", "s"]
        + ["--executor", "dask", "--processes", "2"],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 2, done.stderr
    same(rows("s"), whole)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--scheduler", "tcp://localhost:1"], "--scheduler: needs --executor dask"),
        (["--executor", "mpi", "--processes", "2"], "chosen by mpirun"),
        (["--executor", "dask", "--scheduler", "x", "--processes", "2"], "where the scheduler"),
        (["--executor", "mpi"], "start it by mpirun"),
        (["--executor", "threads"], "--executor"),
        (["--resume", "--overwrite"], "--overwrite"),
    ],
)
def test_a_wrong_choice_of_workers(words, said, capsys):
    """requirement: contradicting options end in one line."""
    assert main(["sweep", *WORDS, *words, "-o", "s"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
    assert not Path("s").exists()


def test_a_scheduler_file_that_never_comes(capsys, monkeypatch):
    """requirement: a wrong name of the scheduler's file ends in one line."""
    pytest.importorskip("distributed")
    monkeypatch.setattr("thermowear.app.batch.executors._START", 0.2)
    words = ["--executor", "dask", "--scheduler", "none.json"]
    assert main(["sweep", *WORDS, *words, "-o", "s"]) == 1
    assert "--scheduler none.json: no such file" in capsys.readouterr().err


def test_any_executor_from_python():
    """requirement: `tw.sweep` takes any executor of `concurrent.futures`."""
    case = tw.load(LEVER, ("mesh.degree=2", "mesh.elements=3", 'motion.velocity="50 mm/s"'))
    over = {"contact.friction": [0.1, 9.0, 0.2]}
    expected = tw.sweep(case, over)
    with ProcessPool(2) as processes, ThreadPoolExecutor(1) as threads:
        for executor in (processes, threads):
            found = tw.sweep(case, over, executor, workers=2)
            assert [values for values, _ in found] == [values for values, _ in expected]
            for (_, one), (_, other) in zip(found, expected, strict=True):
                if isinstance(other, tw.ComputationError):
                    assert isinstance(one, tw.ComputationError)
                    assert str(one) == str(other)
                else:
                    np.testing.assert_allclose(
                        one.interface.pressure, other.interface.pressure, rtol=1e-9
                    )

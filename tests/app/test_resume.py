"""Runs that are killed, interrupted or out of disk, and go on with --resume."""

import csv
import io
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
from contextlib import redirect_stderr, redirect_stdout
from types import SimpleNamespace

import numpy as np
import pytest

from thermowear.app.cli import main
from thermowear.output.tables import read

from ..conftest import COLD_RUNNING_IN, DEMOS, HOT

EVERY_STEP = "analysis.checkpoint_every=1e-9 s"
CASES = {
    "cold": (COLD_RUNNING_IN, "mesh.degree=4", "analysis.tolerance=1e-6"),
    "hot": (
        HOT,
        "mesh.degree=4",
        'analysis={type="transient", end_time="50 s", output_times=["5 s"], tolerance=1e-8}',
    ),
    "heat": (DEMOS / "disk_brake_stop.toml", "mesh.degree=3", "analysis.end_time=6 s"),
    "fretting": (
        DEMOS / "tube_in_support.toml",
        "mesh.elements=24",
        "analysis.cycles=20000",
        'analysis.output_times=["700 s"]',
    ),
    "reciprocating": (
        DEMOS / "punch_on_strip_reciprocating.toml",
        "mesh.degree=2",
        "analysis.positions=6",
        "analysis.tolerance=1e-5",
    ),
    "moved meshes": (
        DEMOS / "annular_punch_deep.toml",
        "mesh.degree=4",
        "mesh.elements=4",
        "analysis.end_time=20 h",
        "analysis.output_times=[]",
    ),
}
MOMENTS = random.Random(6)


def arguments(name, folder, *more):
    case, *overrides = CASES[name]
    chosen = [case, "-o", folder, "--no-pictures", *(f"--set={text}" for text in overrides), *more]
    return ["run", *map(str, chosen)]


def command(name, folder, *more):
    return [sys.executable, "-m", "thermowear", *arguments(name, folder, *more)]


def completed(name, folder, *more):
    """Run in this process, with its console output."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        code = main(arguments(name, folder, *more))
    return SimpleNamespace(returncode=code, stdout=out.getvalue(), stderr=err.getvalue())


def started(name, folder, *more):
    """Run in a separate process."""
    return subprocess.Popen(
        command(name, folder, *more),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        # where the tests themselves run in the background, Ctrl-C is ignored and that is inherited
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )


def wait_for(path, process, rows=0):
    """Wait until a file exists with a given number of lines."""
    deadline = time.monotonic() + 120
    while not (path.exists() and path.read_text(errors="replace").count("\n") >= rows):
        assert process.poll() is None, process.stderr.read()
        assert time.monotonic() < deadline
        time.sleep(0.002)


def tables(folder):
    """Header and numbers of all tables of a folder by name."""
    found = {}
    for path in sorted(folder.glob("*.csv")):
        with path.open(newline="") as file:
            header, *rows = csv.reader(file)
        found[path.name] = header, np.array([[float(cell) for cell in row] for row in rows])
    return found


def assert_the_same(folder, whole):
    ours, theirs = tables(folder), tables(whole)
    assert ours.keys() == theirs.keys()
    for name, (header, expected) in theirs.items():
        assert ours[name][0] == header
        np.testing.assert_allclose(ours[name][1], expected, rtol=1e-12, atol=0.0, err_msg=name)
    assert {path.name for path in folder.iterdir()} == {path.name for path in whole.iterdir()}


@pytest.fixture(scope="module")
def uninterrupted(tmp_path_factory):
    """Folders of runs that nothing came in between of, and their seconds, by name."""
    found = {}

    def run(name):
        if name not in found:
            folder, begin = tmp_path_factory.mktemp("whole") / name, time.monotonic()
            done = completed(name, folder)
            assert done.returncode == 0, done.stderr
            found[name] = folder, time.monotonic() - begin
        return found[name]

    return run


def killed(name, folder, after, *more):
    """Kill a run so many seconds after its folder is there; what is left is readable."""
    process = started(name, folder, *more)
    wait_for(folder / "run.json", process)
    time.sleep(after)
    process.kill()
    process.communicate()
    assert json.loads((folder / "run.json").read_text())["status"] in ("running", "done")
    checkpoint_time(folder)
    for path in folder.glob("*.csv"):
        columns = {len(line.split(",")) for line in path.read_text().splitlines()}
        assert len(columns) == 1, path


def checkpoint_time(folder):
    """Read without the program: plain arrays and JSON; None where there is none [s]."""
    path = folder / "checkpoint.npz"
    if not path.exists():
        return None
    with np.load(path, allow_pickle=False) as file:
        assert all(file[key].dtype != object for key in file)
        return json.loads(str(file["about"]))["time"]


def assert_resumes(name, folder, whole, *more):
    """Check that a resumed run ends with the results of the uninterrupted one."""
    done = completed(name, folder, "--resume", *more)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert json.loads((folder / "run.json").read_text())["status"] == "done"
    assert_the_same(folder, whole)
    return done


def kill_and_resume(name, folder, uninterrupted, times):
    """Kill a run some times at random moments, each time going on, then let it end."""
    (whole, seconds), resume = uninterrupted(name), ()
    for _ in range(times):
        killed(name, folder, MOMENTS.uniform(0.0, seconds), f"--set={EVERY_STEP}", *resume)
        resume = ("--resume",)
    assert_resumes(name, folder, whole)


@pytest.mark.parametrize(
    "name",
    ["cold", *(pytest.param(n, marks=pytest.mark.slow) for n in ("moved meshes", "fretting"))],
)
def test_a_killed_run_goes_on_to_the_same_result(name, uninterrupted, tmp_path):
    """requirement: kill -9, then --resume: every table the same to 1e-12."""
    kill_and_resume(name, tmp_path / name, uninterrupted, times=1)


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in CASES if name != "cold"])
def test_random_moments(name, uninterrupted, tmp_path):
    """requirement: killed at any time; four times per analysis, every other one twice."""
    for number in range(4):
        folder = tmp_path / str(number)
        kill_and_resume(name, folder, uninterrupted, times=1 + number % 2)
        shutil.rmtree(folder)


@pytest.mark.slow
def test_killed_while_writing_the_checkpoint(uninterrupted, tmp_path):
    """requirement: a valid checkpoint exists at any time."""
    whole, _ = uninterrupted("cold")
    folder, resume = tmp_path / "cold", ()
    for _ in range(2):
        process = started("cold", folder, f"--set={EVERY_STEP}", *resume)
        rows = 0 if resume else 5
        wait_for(folder / "history.csv", process, rows)
        wait_for(folder / ".checkpoint.npz.part", process)
        process.kill()
        process.communicate()
        assert checkpoint_time(folder) is not None
        resume = ("--resume",)
    assert_resumes("cold", folder, whole)


def test_ctrl_c_leaves_a_checkpoint_of_the_last_step(uninterrupted, tmp_path):
    """requirement: no step is computed twice; run.json records the restart."""
    whole, _ = uninterrupted("cold")
    folder = tmp_path / "cold"
    process = started("cold", folder)
    wait_for(folder / "history.csv", process, rows=20)
    process.send_signal(signal.SIGINT)
    process.communicate()
    assert process.returncode == 130
    time_reached = checkpoint_time(folder)
    last = tables(folder)["history.csv"][1][-1, 0]
    assert time_reached == pytest.approx(last, rel=1e-14)
    done = assert_resumes("cold", folder, whole)
    assert f"resumed from {time_reached:g} s" in done.stdout
    run = json.loads((folder / "run.json").read_text())
    assert [resume["from_s"] for resume in run["resumes"]] == [time_reached]


def test_a_full_disk_ends_the_run_and_keeps_the_last_checkpoint(uninterrupted, tmp_path):
    """requirement: exit code 2 with reason; resumed with free disk space to the same result."""
    whole, _ = uninterrupted("cold")
    room = (whole / "checkpoint.npz").stat().st_size - 2000
    folder = tmp_path / "cold"
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (room, hard))  # of each file
    try:
        done = completed("cold", folder, f"--set={EVERY_STEP}")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert done.returncode == 2
    assert "results cannot be written" in done.stderr
    assert "--resume" in done.stderr
    assert "Traceback" not in done.stderr
    assert not (folder / ".checkpoint.npz.part").exists()
    assert json.loads((folder / "run.json").read_text())["status"] == "failed"
    reached = checkpoint_time(folder)
    assert 0.0 < reached < 200.0
    assert_resumes("cold", folder, whole)


def test_a_row_that_was_not_written_to_its_end_is_written_again(uninterrupted, tmp_path):
    """requirement: incomplete rows, and rows beyond the checkpoint, are discarded."""
    whole, _ = uninterrupted("cold")
    folder = tmp_path / "cold"
    assert completed("cold", folder, "--set=analysis.max_steps=20").returncode == 2
    columns = (folder / "history.csv").read_text().partition("\n")[0].count(",") + 1
    with (folder / "history.csv").open("a") as file:
        file.write(f"{','.join(map(str, range(1, columns + 1)))}\n0.1,2.")
    (folder / "summary.json").unlink()
    assert len(read(folder / "history.csv")["time"]) == 22
    assert_resumes("cold", folder, whole)


@pytest.mark.slow
def test_killed_before_anything_was_computed(uninterrupted, tmp_path):
    """requirement: the run starts from the beginning."""
    whole, _ = uninterrupted("cold")
    folder = tmp_path / "cold"
    killed("cold", folder, 0.0)
    (folder / "checkpoint.npz").unlink(missing_ok=True)
    assert "from the beginning" in assert_resumes("cold", folder, whole).stdout


def test_nothing_to_resume(uninterrupted, tmp_path):
    """requirement: a finished run prints a message; a missing run is an error."""
    whole, _ = uninterrupted("cold")
    before = {path: path.stat().st_mtime_ns for path in whole.iterdir()}
    done = completed("cold", whole, "--resume")
    assert (done.returncode, done.stderr) == (0, "")
    assert "nothing is left to compute" in done.stdout
    assert {path: path.stat().st_mtime_ns for path in whole.iterdir()} == before
    for folder in (tmp_path / "missing", tmp_path):
        done = completed("cold", folder, "--resume")
        assert done.returncode == 1
        assert done.stderr == f"error: -o {folder}: there is no run to resume\n"
    assert not (tmp_path / "missing").exists()
    done = completed("cold", whole, "--resume", "--overwrite")
    assert done.returncode == 1
    assert "--overwrite" in done.stderr


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        (["contact.friction=0.3"], "contact.friction was 0.25, is now 0.3;"),
        (["wear.punch.coefficient=1e-7 1/MPa"], "wear.punch.coefficient was 2e-07 1/MPa"),
        (["mesh.degree=3", "analysis.tolerance=1e-3"], "mesh.degree was 4, is now 3, "),
        (["mesh.degree=3", "analysis.tolerance=1e-3"], ", analysis.tolerance differs too;"),
        (["analysis.output_times=['5 s', '20 s']"], "analysis.output_times was ('1.0 s', "),
        (["analysis.end_time=100 s"], "analysis.end_time was 200.0 s, is now 100.0 s"),
        (["analysis={type='steady'}"], "analysis.type was transient, is now steady"),
    ],
)
def test_other_physics_are_refused(changes, named, uninterrupted):
    """requirement: the first changed key is named with both values; the folder is unchanged."""
    whole, _ = uninterrupted("cold")
    before = {path: path.stat().st_mtime_ns for path in whole.iterdir()}
    done = completed("cold", whole, "--resume", *(f"--set={text}" for text in changes))
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1
    assert named in done.stderr
    assert {path: path.stat().st_mtime_ns for path in whole.iterdir()} == before


def test_the_end_may_be_later(uninterrupted, tmp_path):
    """requirement: title, max_steps, frames, later end and output times may change."""
    whole, _ = uninterrupted("cold")
    folder = shutil.copytree(whole, tmp_path / "cold")
    times = ["1 s", "5 s", "20 s", "50 s", "100 s", "250 s"]
    changes = [f"analysis.output_times={times}", "title=Longer", "analysis.end_time=300 s"]
    changes += ["analysis.frames=1000", "analysis.max_steps=5000"]
    done = completed("cold", folder, "--resume", *(f"--set={text}" for text in changes))
    assert done.returncode == 0, done.stderr
    assert (folder / "interface_250.csv").exists()
    ours, theirs = (tables(place)["history.csv"][1] for place in (folder, whole))
    np.testing.assert_array_equal(ours[: len(theirs)], theirs)
    assert ours[-1, 0] == 300.0
    assert (folder / "frames" / "frames.pvd").is_file()


def test_two_runs_in_one_folder_are_refused(tmp_path):
    """requirement: a run in progress is not disturbed."""
    folder = tmp_path / "cold"
    slow = f"--set={EVERY_STEP}", "--set=analysis.tolerance=1e-9"
    process = started("cold", folder, *slow)
    try:
        wait_for(folder / "history.csv", process, rows=5)
        for more in ("--resume", "--overwrite"):
            done = completed("cold", folder, *slow, more)
            assert done.returncode == 1
            assert "in use by another run" in done.stderr
        assert process.poll() is None
    finally:
        process.kill()
        process.communicate()


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("mpirun") is None, reason="needs mpirun")
def test_two_ranks_go_on_with_their_parts(tmp_path):
    """requirement: nodal fields of each rank; another number of ranks is refused."""
    root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    clean = {k: v for k, v in os.environ.items() if not k.startswith(("PMIX", "PRTE_"))} | root

    def on(ranks, folder, *more):
        launched = [
            "mpirun",
            "--oversubscribe",
            "-n",
            str(ranks),
            *command("heat", folder, *short, *more),
        ]
        return subprocess.run(
            launched, capture_output=True, text=True, check=False, env=clean, timeout=300
        )

    short = "--set=mesh.degree=2", "--set=analysis.end_time=0.5 s", "--set=analysis.output_times=[]"
    whole, folder = tmp_path / "whole", tmp_path / "stopped"
    assert on(2, whole).returncode == 0
    assert on(2, folder, "--set=analysis.max_steps=8").returncode == 2
    refused = completed("heat", folder, *short, "--resume")
    assert refused.returncode == 1
    assert "written by 2 processes" in refused.stderr
    done = on(2, folder, "--resume")
    assert done.returncode == 0, done.stderr
    ours, theirs = tables(folder), tables(whole)
    assert ours.keys() == theirs.keys()
    for name, (header, expected) in theirs.items():
        for column, values in enumerate(expected.T):
            allowed = 1e-12 if header[column].startswith("balance") else 1e-8 * np.abs(values).max()
            np.testing.assert_allclose(ours[name][1][:, column], values, rtol=0, atol=allowed)

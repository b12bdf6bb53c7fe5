"""Command `sweep`: exit codes, results, processes."""

from __future__ import annotations

import csv
import json
import math
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import thermowear as tw
from thermowear.app.cli import main
from thermowear.output import tables
from thermowear.output.folder import ResultsFolder

from ..conftest import COLD_RUNNING_IN, DEMOS

BLOCK = str(DEMOS / "block_on_disk.toml")
LEVER = str(DEMOS / "pivoted_block.toml")
SMALL = ("--set", "mesh.degree=2", "--set", "mesh.elements=3")
LOADS = ("--over", "load.force=1 kN,2 kN")


pytestmark = pytest.mark.usefixtures("in_folder")


def table(path) -> list[dict[str, str]]:
    with (Path(path) / "sweep.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def done_variants(folder) -> set[str]:
    """Degrees of the variants that were computed so far."""
    if not (folder / "sweep.csv").exists():
        return set()
    return {row["mesh.degree"] for row in table(folder) if row["status"] == "done"}


def test_a_sweep_leaves_its_files(capsys):
    """
    requirement: a table, two pictures, and for each variant the files of a run without fields.
    """
    frictions = ("--over", "contact.friction=0.1,0.3")
    assert main(["sweep", BLOCK, *SMALL, *LOADS, *frictions]) == 0
    path = Path("results/block_on_disk-sweep")
    names = {"sweep.csv", "shapes.png", "sweep.png", "run.json", "variants.jsonl"}
    names |= {"001", "002", "003", "004"}
    assert {entry.name for entry in path.iterdir()} == names
    assert {entry.name for entry in (path / "003").iterdir()} == {
        "interface.csv",
        "profile.csv",
        "summary.json",
        "run.json",
        "case.resolved.toml",
    }
    assert json.loads((path / "run.json").read_text())["status"] == "done"
    assert "4/4" in capsys.readouterr().out
    rows = table(path)
    assert [row["load.force_N"] for row in rows] == ["1000", "1000", "2000", "2000"]
    for row in rows:
        summary = json.loads((path / f"{int(row['variant']):03d}" / "summary.json").read_text())
        assert float(row["max_temperature_K"]) == pytest.approx(summary["max_temperature_K"])
        friction = float(row["contact.friction"])
        assert summary["friction"] == friction
        # pressure and friction, at right angles everywhere, balance the load and the guide
        carried = math.hypot(float(row["load.force_N"]), summary["guide_force_N"])
        resultant = summary["normal_force_N"] * math.hypot(1.0, friction)
        assert resultant == pytest.approx(carried, rel=1e-12)
    resolved = tw.load(path / "004" / "case.resolved.toml")
    assert (resolved.load.force, resolved.contact.friction) == (2000.0, 0.3)


def test_processes_do_not_change_the_numbers():
    """
    requirement: variants that share nothing are computed in parallel with equal results.
    """
    over = ("--over", "mesh.elements=2,3", "--over", "contact.friction=0.1,0.2")
    for processes in ("1", "2"):
        words = ["sweep", BLOCK, *SMALL[:2], *over, "--processes", processes, "--no-pictures"]
        assert main([*words, "-o", processes]) == 0
    for number in range(1, 5):
        one, two = (
            tables.read(Path(processes) / f"{number:03d}" / "interface.csv")
            for processes in ("1", "2")
        )
        for name, values in one.items():
            largest = np.nanmax(np.abs(values), initial=0.0)
            np.testing.assert_allclose(two[name], values, rtol=1e-9, atol=1e-9 * largest)
    assert not Path("1/shapes.png").exists()


def test_one_variant_fails(capsys):
    """
    requirement: a failed variant does not affect others; its row has the reason; exit code 2.
    """
    locked = ("--set", 'motion.velocity="50 mm/s"', "--over", "contact.friction=0.1,9.0,0.2")
    assert main(["sweep", LEVER, *SMALL, *locked, "-o", "s"]) == 2
    printed = capsys.readouterr()
    (line,) = printed.err.splitlines()
    assert line.startswith("error: 1 of 3 variants failed; variant 2 (contact.friction=9.0): ")
    first, second, third = table("s")
    assert (first["status"], third["status"]) == ("done", "done")
    assert second["status"].startswith("failed: ")
    assert second["max_pressure_Pa"] == "nan"
    assert json.loads(Path("s/run.json").read_text())["status"] == "failed"
    assert json.loads(Path("s/002/run.json").read_text())["status"] == "failed"
    assert Path("s/shapes.png").is_file()


@pytest.mark.parametrize("broken", ["describe", "finish", "_write_run"])
def test_a_full_disk_ends_a_sweep_and_fails_no_variant(broken, monkeypatch, capsys):
    """requirement: it stops at the first write that fails; --resume computes what is left."""
    words = ["sweep", LEVER, *SMALL, "--over", "contact.friction=0.1,0.2,0.3", "-o", "s"]
    words += ["--processes", "1", "--no-pictures"]
    works = getattr(ResultsFolder, broken)

    def fails(self, *given, **more):
        works(self, *given, **more)
        if self.path.name == "002":
            raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(ResultsFolder, broken, fails)
        assert main(words) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "No space left on device; mend this, then --resume" in line
    assert [row["status"] for row in table("s")] == ["done", "not computed", "not computed"]
    assert not Path("s/003").exists()
    assert main([*words, "--resume"]) == 0
    assert [row["status"] for row in table("s")] == ["done"] * 3


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--over", "load.force=1 kN,-2 kN"], "variant 2 (load.force=-2 kN): load.force: "),
        (["--over", "load.force=1 kN,2 kN", "--set", "mesh.degree=0"], "mesh.degree: "),
        (["--over", "load.forces=1 kN"], "load.forces: unknown key"),
        (["--over", "load.force"], "must be KEY=V1,V2,..."),
        ([*LOADS, *LOADS], "twice"),
        ([*LOADS, "--processes", "0"], "--processes"),
        ([], "--over"),
    ],
)
def test_a_wrong_sweep_computes_nothing(words, said, capsys):
    """
    requirement: all variants are validated before computing; exit code 1, no traceback.
    """
    assert main(["sweep", BLOCK, *words]) == 1
    printed = capsys.readouterr()
    assert printed.out == ""
    (line,) = printed.err.splitlines()
    assert line.startswith("error: ")
    assert said in line
    assert list(Path().iterdir()) == []


def test_results_are_not_overwritten(capsys):
    """
    requirement: existing results remain without --overwrite.
    """
    words = ["sweep", BLOCK, *SMALL, *LOADS, "-o", "s", "--no-pictures"]
    assert main(words) == 0
    before = Path("s/sweep.csv").read_bytes()
    assert main(words) == 1
    assert "--overwrite" in capsys.readouterr().err
    assert Path("s/sweep.csv").read_bytes() == before
    assert main([*words, "--overwrite"]) == 0
    assert main(["run", BLOCK, *SMALL, "-o", "s/001"]) == 1


def test_the_pictures_again():
    """
    requirement: `plot` draws the pictures of a sweep again.
    """
    assert main(["sweep", BLOCK, *SMALL, *LOADS, "-o", "s"]) == 0
    for name in ("shapes.png", "sweep.png"):
        Path("s", name).unlink()
    assert main(["plot", "s"]) == 0
    assert Path("s/shapes.png").is_file()
    assert Path("s/sweep.png").is_file()


def test_a_sweep_is_not_for_many_ranks(monkeypatch, capsys):
    """
    requirement: started by a launcher with several processes: an error with a remedy.
    """
    monkeypatch.setenv("OMPI_COMM_WORLD_SIZE", "2")
    monkeypatch.setattr("thermowear.app.cli._is_reporting_rank", lambda: True)
    assert main(["sweep", BLOCK, *LOADS]) == 1
    assert "--processes" in capsys.readouterr().err


@pytest.mark.parametrize("processes", ["1", pytest.param("2", marks=pytest.mark.slow)])
def test_ctrl_c_keeps_what_is_done(tmp_path, processes):
    """
    requirement: Ctrl-C leaves a readable table of the variants that were computed; exit code 130.
    """
    folder = tmp_path / "s"
    words = ["sweep", str(COLD_RUNNING_IN), "--over", "mesh.degree=1,6,7,8", "-o", str(folder)]
    process = subprocess.Popen(
        [sys.executable, "-m", "thermowear", *words, "--set=analysis.tolerance=1e-8"]
        + ["--processes", processes],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # where the tests themselves run in the background, Ctrl-C is ignored and that is inherited
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    deadline = time.monotonic() + 120
    while not (done := done_variants(folder)):  # of two processes, either may be the first
        assert process.poll() is None, process.stderr.read()
        assert time.monotonic() < deadline
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=100)
    assert process.returncode == 130
    assert said.strip() == "error: interrupted"
    assert json.loads((folder / "run.json").read_text())["status"] == "interrupted"
    assert done_variants(folder) >= done
    assert table(folder)[3]["status"] in ("not computed", "interrupted")
    assert (folder / "shapes.png").is_file()


def test_from_python():
    """
    requirement: `tw.sweep` returns values and results or errors in order.
    """
    tables_of_law = [
        {"coefficient": "1e-7 1/MPa"},
        {"coefficient": "1e-7 1/MPa^2", "pressure_exponent": 2.0},
    ]
    case = tw.load(BLOCK, ("mesh.degree=2", "mesh.elements=3"))
    found = tw.sweep(case, {"load.force": ["1 kN", "2 kN"], "wear.block": tables_of_law})
    assert [values["load.force"] for values, _ in found] == ["1 kN", "1 kN", "2 kN", "2 kN"]
    assert [values["wear.block"] for values, _ in found] == tables_of_law * 2
    peaks = [result.summary["max_pressure_Pa"] for _, result in found]
    np.testing.assert_allclose(peaks[2:], 2 * np.array(peaks[:2]), rtol=1e-8)
    assert peaks[0] != pytest.approx(peaks[1], rel=1e-3)
    locked = tw.load(LEVER, ("mesh.degree=2", "mesh.elements=3", 'motion.velocity="50 mm/s"'))
    (_, good), (_, bad) = tw.sweep(locked, {"contact.friction": [0.1, 9.0]})
    assert good.interface.pressure.max() > 0
    assert isinstance(bad, tw.ComputationError)
    with pytest.raises(tw.CaseError, match="variant 2"):
        tw.sweep(case, {"mesh.degree": [1, 99]})

"""Command `study`: files, resume, failures, pictures, report."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import matplotlib.image as mpimg
import numpy as np
import pytest

from thermowear.app.cli import main
from thermowear.output.study import StudyFolder
from thermowear.output.variants.folder import JOURNAL

from ...conftest import DEMOS
from .cases import BOTH, PRESSURE, record, ring, rows, written

pytestmark = pytest.mark.usefixtures("in_folder")
ALONE = ("--processes", "1")


def test_a_study_leaves_its_files(capsys):
    """requirement: tables, pictures, a record, and a line for each main output on the console."""
    assert main(["study", written(ring(BOTH, samples=8, indices=True)), *ALONE]) == 0
    folder = Path("results/ring-study")
    names = {"run.json", JOURNAL, "study.csv", "case.resolved.toml", "quantiles.csv", "sobol.csv"}
    names |= {"tornado.csv", "bands_interface.csv"}
    pictures = {"distributions.png", "tornado.png", "sobol.png", "bands.png"}
    assert {path.name for path in folder.iterdir()} == names | pictures
    table = rows(folder / "study.csv")
    assert len(table) == 5 + 4 * 8
    assert {row["status"] for row in table} == {"done"}
    assert [row["part"] for row in table[:3]] == ["medians", "low load.mean_pressure"] + [
        "low contact.friction"
    ]
    assert float(table[0]["load.mean_pressure_Pa"]) == pytest.approx(50e6)
    quantiles = {row["output"]: row for row in rows(folder / "quantiles.csv")}
    assert quantiles["max_pressure_Pa"]["count"] == "16"
    assert "seconds" not in quantiles
    torque = [r for r in rows(folder / "tornado.csv") if r["output"] == "friction_torque_Nm"]
    assert [r["input"] for r in torque] == ["load.mean_pressure_Pa", "contact.friction"]
    assert float(torque[1]["input_high"]) == pytest.approx(0.385)
    assert float(torque[1]["output_at_high"]) > float(torque[1]["output_at_low"])
    for name in pictures:
        pixels = mpimg.imread(folder / name)
        assert min(pixels.shape[:2]) > 200
        assert np.ptp(pixels) > 0.5
    said = capsys.readouterr().out
    assert "37/37" in said
    assert "friction torque [kN m]" in said
    assert record(folder)["study"]["base"] == 8


def test_pictures_and_report_are_made_again():
    """requirement: `plot` and `report` need the files of the folder only."""
    tables = ring(BOTH, hot=True, samples=8)
    assert main(["study", written(tables), *ALONE, "--no-pictures", "-o", "s"]) == 0
    assert not list(Path("s").glob("*.png"))
    assert main(["plot", "s"]) == 0
    names = {path.name for path in Path("s").glob("*.png")}
    assert names == {"distributions.png", "tornado.png", "bands.png"}
    assert main(["report", "s"]) == 0
    page = Path("s/report.html").read_text("utf-8")
    assert page.count("data:image/png") == 3
    assert "Median and 95 % interval" in page
    assert "peak-to-valley of the worn shape" in page
    before = Path("s/tornado.csv").read_bytes()
    assert main(["study", "ring.toml", *ALONE, "--no-pictures", "-o", "s", "--overwrite"]) == 0
    assert Path("s/tornado.csv").read_bytes() == before
    assert not Path("s/report.html").exists()


def lever(samples: int) -> str:
    """Pivoted block that has no equilibrium for some coefficients of friction."""
    import tomllib

    tables = tomllib.loads((DEMOS / "pivoted_block.toml").read_text("utf-8"))
    tables["mesh"] = {"degree": 2, "elements": 3}
    tables["motion"] = {"velocity": "50 mm/s"}
    wide = {"distribution": "uniform", "lower": 0.1, "upper": 9.0}
    return written(tables | {"study": {"inputs": {"contact.friction": wide}, "samples": samples}})


def test_damaged_tables(capsys):
    """requirement: a file that was cut, or lost its rows, is named in one line."""
    assert main(["study", written(ring(BOTH, samples=4, indices=True)), *ALONE]) == 0
    folder = Path("results/ring-study")
    for name in ("study.csv", "quantiles.csv", "tornado.csv", "sobol.csv", "bands_interface.csv"):
        whole = (folder / name).read_bytes()
        cut = whole[: whole.rindex(b",")]
        for damaged in (cut, b"\xff", whole.splitlines()[0] if name.startswith("bands") else cut):
            (folder / name).write_bytes(damaged)
            capsys.readouterr()
            assert main(["plot", str(folder)]) == 1
            (line,) = capsys.readouterr().err.splitlines()
            assert line.startswith("error: ")
        (folder / name).write_bytes(whole)
    (folder / "bands_mine.csv").write_text("a\n1\n", encoding="utf-8")
    assert main(["plot", str(folder)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "bands_mine.csv: is no table of bands" in line


def test_failed_variants_are_rows(capsys):
    """requirement: failed variants are told and counted, exit code 2, as those of a sweep."""
    assert main(["study", lever(16), *ALONE, "--no-pictures", "-o", "s"]) == 2
    table = rows("s/study.csv")
    failed = [row for row in table if row["status"].startswith("failed: ")]
    assert 0 < len(failed) < len(table)
    assert all(row["max_pressure_Pa"] == "nan" for row in failed)
    counted = {row["output"]: row for row in rows("s/quantiles.csv")}["max_pressure_Pa"]
    in_sample = [row for row in failed if row["part"] == "sample"]
    assert int(counted["failed"]) == len(in_sample)
    assert int(counted["count"]) == 16 - len(in_sample)
    printed, told = capsys.readouterr(), f"{len(failed)} of 19 variants failed; variant "
    assert f"note: {told}" in printed.out
    assert printed.err.startswith(f"error: {told}")
    assert record("s")["status"] == "done"


def journal() -> list[str]:
    path = Path("s") / JOURNAL
    lines = path.read_text().splitlines() if path.exists() else []
    return [line for line in lines if line.endswith("}")]  # but one that is being written


def test_a_killed_study_goes_on():
    """requirement: killed and resumed, its tables are those of one that was not."""
    case = written(ring(BOTH, samples=32))
    words = ["study", case, "--no-pictures", *ALONE]
    assert main([*words, "-o", "whole"]) == 0
    process = subprocess.Popen(
        [sys.executable, "-m", "thermowear", *words, "-o", "s"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    deadline = time.monotonic() + 120
    while len(journal()) < 5 and process.poll() is None:
        assert time.monotonic() < deadline
        time.sleep(0.005)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    before = [json.loads(line) for line in journal()]
    assert len(before) >= 5
    assert main([*words, "-o", "s", "--resume"]) == 0
    again = [json.loads(line) for line in journal()]
    assert again[: len(before) - 1] == before[:-1]
    for name in ("quantiles.csv", "tornado.csv", "bands_interface.csv"):
        for one, other in zip(rows(f"s/{name}"), rows(f"whole/{name}"), strict=True):
            for key in one:
                try:
                    numbers = float(one[key]), float(other[key])
                except ValueError:
                    assert one[key] == other[key]
                    continue
                largest = 1e-9 * abs(numbers[1]) + 1e-20
                assert numbers[0] == pytest.approx(numbers[1], rel=1e-6, abs=largest), (name, key)
    assert main(["study", case, *ALONE, "-o", "s", "--resume", "--set", "study.samples=16"]) == 1


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "study.inputs: missing; needs a distribution"),
        (("--calibration", "nothing"), "--calibration nothing: contains no readable"),
        (("--set", "study.samples=1"), "study.samples: "),
    ],
)
def test_error_lines(words, said, capsys):
    """requirement: one line on what is missing."""
    assert main(["study", written(ring({})), *words]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("error: ")
    assert said in line


def test_indices_need_two_inputs(capsys):
    """requirement: Sobol indices of a single input are refused."""
    case = written(ring({"load.mean_pressure": PRESSURE}))
    assert main(["study", case, "--indices"]) == 1
    assert "two inputs at least" in capsys.readouterr().err


def test_curves_of_the_journal_are_exact(tmp_path):
    """requirement: curves are restored from the journal as they were."""
    curves = {"history": {"time": np.array([0.0, 0.1], np.float32)}}
    given = (["part"], [["sample"], ["sample"]], {"model": "axisymmetric"}, {}, "sum")
    folder = StudyFolder(tmp_path / "s", *given)
    folder.add(1, "done", {"a": 1.0, "b": float("nan")}, curves, 0.1)
    folder.close("interrupted", "", 1.0)
    again = StudyFolder(tmp_path / "s", *given, resume=True)
    assert again.ended == {1: "done"}
    np.testing.assert_array_equal(again.curves[1]["history"]["time"], curves["history"]["time"])
    assert np.isnan(again.ends[1].numbers["b"])

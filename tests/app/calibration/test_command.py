"""Command `calibrate`: files, pictures, exit codes."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import matplotlib.image as mpimg
import numpy as np
import pytest
import tomli_w
from matplotlib.figure import Figure

import thermowear as tw
from thermowear.app.cli import main
from thermowear.errors import UnwritableError
from thermowear.output.calibration import CalibrationFolder, draw_calibration

from .rings import FRICTION, WEAR, K, tables, truth, volumes

pytestmark = pytest.mark.usefixtures("in_folder")


def write_case(**calibrate):
    """Case file in the current folder."""
    Path("ring.toml").write_text(tomli_w.dumps(tables(**calibrate)), encoding="utf-8")
    return "ring.toml"


def test_files_of_a_calibration(capsys):
    """requirement: record, observations, calibrated case, pictures and report."""
    volumes(Path("scar.csv"), truth(), 0.02)
    case = write_case(parameters={"k": WEAR}, observations={"scar": {}})
    assert main(["calibrate", case, "--data", "scar.csv", "-o", "c"]) == 0
    printed = capsys.readouterr().out
    assert "k " in printed
    assert "5 observations" in printed
    names = {path.name for path in Path("c").iterdir()}
    assert names == {
        *("calibration.json", "observations.csv", "case.calibrated.toml", "case.resolved.toml"),
        *("run.json", "fit.png", "residuals.png", "parameters.png", "report.html"),
    }
    record = json.loads(Path("c/calibration.json").read_text())
    own = record["parameters"]["k"]
    assert own["unit"] == "1/MPa"
    assert own["interval"][0] < K < own["interval"][1]
    assert own["value"] == pytest.approx(np.exp(own["internal"]))
    assert record["covariance"][0][0] == pytest.approx(own["standard_error"] ** 2)
    calibrated = tw.load("c/case.calibrated.toml")
    assert calibrated.calibrate is None
    found = calibrated.wear["punch"].coefficient_si()
    assert found == pytest.approx(1e-6 * own["value"], rel=1e-12)
    with Path("c/observations.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["time_s"]) for row in rows] == [5.0, 12.0, 20.0, 33.0, 50.0]
    for row in rows:
        assert row["quantity"] == "wear_volume_1_m3"
        low, middle, high = (float(row[name]) for name in ("lower", "predicted", "upper"))
        assert low < middle < high
    assert json.loads(Path("c/run.json").read_text())["status"] == "done"
    page = Path("c/report.html").read_text()
    assert "Correlation of the parameters" in page
    assert "data:image/png" in page


def test_the_legend_tells_the_level_of_the_band(monkeypatch):
    """requirement: the band of the predictions is that of `calibrate.confidence`."""
    volumes(Path("scar.csv"), truth(), 0.02)
    case = write_case(parameters={"k": WEAR}, confidence="80 %")
    assert main(["calibrate", case, "--data", "scar.csv", "-o", "c", "--no-pictures"]) == 0
    told = []
    monkeypatch.setattr(Figure, "legend", lambda figure, handles, words, **_: told.extend(words))
    draw_calibration(Path("c"))
    assert "predicted, with 80 % band" in told
    with Path("c/observations.csv").open(newline="") as file:
        row = next(csv.DictReader(file))
    own = json.loads(Path("c/calibration.json").read_text())["parameters"]["k"]
    reach = np.log(own["interval"][1] / own["value"])
    assert reach == pytest.approx(1.2815516 * own["standard_error"], rel=1e-6)
    half = float(row["upper"]) - float(row["predicted"])
    assert half == pytest.approx(reach * float(row["predicted"]), rel=0.05)  # V ~ k


def test_pictures_again_and_never_over_others(capsys):
    """requirement: `plot` and `report` work on the folder; nothing is overwritten unasked."""
    volumes(Path("scar.csv"), truth(), 0.02)
    case = write_case(parameters={"k": WEAR, "mu": FRICTION})
    words = ["calibrate", case, "--data", "scar=scar.csv", "-o", "c", "--no-pictures"]
    assert main(words) == 0
    said = capsys.readouterr().out
    assert "k · mu^1.00" in said
    assert not Path("c/fit.png").exists()
    assert main(words) == 1
    assert "--overwrite" in capsys.readouterr().err
    Path("c/own.txt").write_text("mine")
    assert main([*words, "--overwrite"]) == 0
    assert Path("c/own.txt").read_text() == "mine"
    assert main(["plot", "c"]) == 0
    assert "determine none of them" in capsys.readouterr().err
    assert mpimg.imread("c/fit.png")[..., :3].std() > 0.01
    assert main(["report", "c"]) == 0
    assert "not determined" not in Path("c/report.html").read_text().partition("</h1>")[0]
    before = Path("c/calibration.json").read_text()
    assert main([*words, "--overwrite", "--set", "calibrate.confidence=2"]) == 1
    assert main([*words[:3], "scar=none.csv", *words[4:], "--overwrite"]) == 1
    assert "cannot be read" in capsys.readouterr().err
    assert Path("c/calibration.json").read_text() == before
    Path("d").mkdir()
    Path("d/fit.png").write_text("a picture")
    assert main(["calibrate", case, "--data", "scar.csv", "-o", "d", "--overwrite"]) == 1
    assert "not a folder of a calibration" in capsys.readouterr().err


def result(folder):
    """Record of a calibration but for its duration, and its observations."""
    record = json.loads(Path(folder, "calibration.json").read_text())
    return record | {"seconds": None}, Path(folder, "observations.csv").read_bytes()


def test_a_stopped_search_goes_on(monkeypatch, capsys):
    """requirement: stopped and resumed, the results are those of one that was not, bit for bit."""
    volumes(Path("scar.csv"), truth(), 0.02)
    case = write_case(parameters={"k": WEAR, "mu": FRICTION})
    words = ["calibrate", case, "--data", "scar.csv", "--no-pictures"]
    add, count = CalibrationFolder.add, {"whole": 0, "c": 0}

    def counted(self, *outcome):
        add(self, *outcome)
        count[self.path.name] += 1
        if count["c"] == 5:
            raise UnwritableError("no room")

    monkeypatch.setattr(CalibrationFolder, "add", counted)
    assert main([*words, "-o", "whole"]) == 0
    assert main([*words, "-o", "c"]) == 2
    assert "no room; mend this, then --resume" in capsys.readouterr().err
    journal = Path("c/runs.jsonl")
    assert len(journal.read_text().splitlines()) == 5
    with journal.open("a") as file:
        file.write('{"key": "cut off')
    assert main([*words, "-o", "c", "--resume"]) == 0
    assert result("c") == result("whole")
    assert count["c"] == count["whole"]
    assert {p.name for p in Path("c").iterdir()} == {p.name for p in Path("whole").iterdir()}
    capsys.readouterr()
    assert main([*words, "-o", "c", "--resume"]) == 0
    assert "nothing is left to compute" in capsys.readouterr().out
    assert main([*words, "-o", "c", "--resume", "--set", "calibrate.confidence=0.9"]) == 1


@pytest.mark.parametrize("damaged", ["{}", '{"key": 3, "status": "done"}', "[]"])
def test_a_damaged_journal_of_a_search(damaged, capsys):
    """requirement: one line with the file and the line."""
    volumes(Path("scar.csv"), truth(), 0.02)
    words = ["calibrate", write_case(parameters={"k": WEAR}), "--data", "scar.csv", "-o", "c"]
    assert main([*words, "--set", "analysis.max_steps=2"]) == 2
    Path("c/runs.jsonl").write_text(f"{damaged}\n")
    capsys.readouterr()
    assert main([*words, "--set", "analysis.max_steps=2", "--resume"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "runs.jsonl, line 1: is damaged" in line


DAMAGED = {
    "observations.csv": (
        *("", "observation,quantity,observed\nscar,wear_volume_1_m3,1\n", "a;b\n1;2\n"),
        lambda text: text[: len(text) // 2],
        lambda text: text.replace(",", ",x", 9),
    ),
    "calibration.json": (
        *("1", "null", "{}", "[]", '{"confidence": 0.95, "parameters": {"k": {}}}'),
        lambda text: text.replace('"scale": "log"', '"scale": 1'),
        lambda text: text.replace('"confidence": 0.95', '"confidence": null'),
        lambda text: text.replace('"notes": [', '"notes": [1, '),
        lambda text: text.replace('"parameters": {', '"parameters": {}, "others": {'),
    ),
    "case.resolved.toml": ("title =",),
    "summary.json": ("1", "null"),
}


def test_damaged_folders(capsys):
    """requirement: `plot` and `report` of damaged files: the file or folder in one line."""
    volumes(Path("scar.csv"), truth(), 0.02)
    case = write_case(parameters={"k": WEAR})
    assert main(["calibrate", case, "--data", "scar.csv", "-o", "c", "--no-pictures"]) == 0
    for name, contents in DAMAGED.items():
        path = Path("c", name)
        whole = path.read_text() if path.is_file() else None
        for content in contents:
            path.write_text(content if isinstance(content, str) else content(whole))
            assert path.read_text() != whole, (name, content)
            for command in ("plot", "report"):
                capsys.readouterr()
                code, told = main([command, "c"]), capsys.readouterr().err.splitlines()
                read = command == "report" or name in ("observations.csv", "calibration.json")
                if read and name != "summary.json":  # others have none
                    assert code == 1, (name, content, command)
                    assert len(told) == 1
                    assert told[0].startswith("error: ")
        path.unlink() if whole is None else path.write_text(whole)
    Path("r").mkdir()
    for content in ("1", "null", "[]"):  # of a run
        Path("r/summary.json").write_text(content)
        for command in ("plot", "report"):
            assert main([command, "r"]) == 1
            (line,) = capsys.readouterr().err.splitlines()
            assert line.startswith("error: ")


def test_plan(capsys):
    """requirement: `--plan` prints the errors to be expected, of each measurement alone, too."""
    volumes(Path("scar.csv"), truth())
    torque = "time [s], friction_torque_deviation [N m]\n20, 300\n"
    Path("torque.csv").write_text(torque)
    case = write_case(parameters={"k": WEAR, "mu": FRICTION})
    data = ["--data", "scar.csv", "--data", "torque.csv"]
    assert main(["calibrate", case, *data, "--plan", "-o", "p"]) == 0
    said = capsys.readouterr().out
    assert "only scar" in said
    assert "not determined" in said
    record = json.loads(Path("p/calibration.json").read_text())
    assert record["planned"]
    assert record["standard_errors_alone"]["scar"]["k"] is None
    assert record["parameters"]["mu"]["standard_error"] > 0.0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--data", "none.csv"], "cannot be read"),
        (["--data", "a=scar.csv", "--data", "a=scar.csv"], "a is given twice"),
        ([], "observations: missing"),
        (["--set", "calibrate.parameters.k.start='1 1/MPa'", "--data", "scar.csv"], "start"),
    ],
)
def test_wrong_commands(words, said, capsys):
    """requirement: exit code 1 and one line."""
    volumes(Path("scar.csv"), truth())
    case = write_case(parameters={"k": WEAR})
    assert main(["calibrate", case, *words, "-o", "c", "--no-pictures"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
    assert not Path("c").exists()


def test_a_failed_calibration_says_so(capsys):
    """requirement: exit code 2, and the reason in the record of the run."""
    volumes(Path("scar.csv"), truth())
    case = write_case(parameters={"k": WEAR})
    words = ["calibrate", case, "--data", "scar.csv", "-o", "c", "--set", "analysis.max_steps=2"]
    assert main(words) == 2
    assert "first values failed" in capsys.readouterr().err
    assert json.loads(Path("c/run.json").read_text())["status"] == "failed"

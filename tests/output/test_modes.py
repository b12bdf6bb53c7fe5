"""Files and console output of a stability analysis."""

import json

import matplotlib.image as mpimg
import numpy as np
import pytest
import tomli_w

from thermowear.app.cli import main
from thermowear.output import tables
from thermowear.verification.cases.assembly.pad_disk_pad import Brake

from ..case.starter import tables as case_tables

DISK, BLOCKS = "disk-brake-stability", "stacked-blocks"


def run(tmp_path, capsys, name, changes, *options):
    file, folder = tmp_path / "case.toml", tmp_path / "results"
    file.write_bytes(tomli_w.dumps(case_tables(name, changes)).encode())
    assert main(["run", str(file), "-o", str(folder), *options]) == 0
    return folder, " ".join(capsys.readouterr().out.split())


def drawn(path):
    image = mpimg.imread(path)[..., :3]
    return (np.abs(image - image[0, 0]).max(axis=2) > 0.05).mean()


@pytest.mark.usefixtures("bodies_not_drawn")
def test_swinging_bands(tmp_path, capsys):
    """requirement: critical speeds are printed, modes are in mode.csv and drawn."""
    folder, said = run(tmp_path, capsys, DISK, {"mesh.degree": 3, "mesh.elements": 6})
    summary = json.loads((folder / "summary.json").read_text())
    modes = tables.read(folder / "mode.csv")
    first = modes["mode"] == 1
    for column, key in (
        ("frequency", "critical_frequency_with_wear_rad_per_s"),
        ("speed_factor", "critical_speed_factor_with_wear"),
    ):
        assert modes[column][first][0] == pytest.approx(summary[key], rel=1e-12)
        assert summary[key] > 0
    size = np.hypot(modes["pressure"], modes["pressure_imaginary"])
    for number in np.unique(modes["mode"]):
        assert size[modes["mode"] == number].max() == pytest.approx(1.0)
    assert not modes["pressure_imaginary"][~first].any()
    speed = summary["critical_angular_velocity_with_wear_rad_per_s"]
    part = 1 / summary["critical_speed_factor_with_wear"]
    critical = f"{speed:.4g} rad/s; this case: {part:.3g} times the critical speed"
    assert f"critical speed with wear {critical}" in said
    assert "pressure perturbations decay" in said
    assert "oscillatory with period" in said
    assert drawn(folder / "mode.png") > 0.01
    assert main(["report", str(folder)]) == 0
    assert "Pressure perturbations" in (folder / "report.html").read_text()


def test_growing_waves(tmp_path, capsys):
    """requirement: beyond the critical speed the growth rate is printed."""
    storing = {"density": "7800 kg/m^3", "specific_heat": "460 J/(kg K)"}
    changes = {f"bodies.{b}.{k}": v for b in ("upper", "lower") for k, v in storing.items()}
    changes |= {"analysis": {"type": "stability"}, "mesh.degree": 2}
    folder, said = run(tmp_path, capsys, BLOCKS, changes, "--no-pictures")
    summary = json.loads((folder / "summary.json").read_text())
    modes = tables.read(folder / "mode.csv")
    assert modes["growth_rate"][0] == pytest.approx(summary["growth_rate_per_s"], rel=1e-12)
    assert modes["growth_rate"][0] > 0
    assert modes["speed_factor"][0] == 1.0
    time_constant = f"{1 / summary['growth_rate_per_s']:.4g} s"
    assert f"pressure perturbations grow with time constant {time_constant}" in said
    assert "mm/s; this case:" in said


@pytest.mark.usefixtures("bodies_not_drawn")
def test_modes_of_two_contacts(tmp_path, capsys):
    """requirement: a table and a picture for each contact, normalised together; in the report."""
    case = Brake("clamped", 9.0, heated=True, elements=4).tables("steady")
    case |= {"analysis": {"type": "stability"}}
    file, folder = tmp_path / "case.toml", tmp_path / "results"
    file.write_bytes(tomli_w.dumps(case).encode())
    assert main(["run", str(file), "-o", str(folder)]) == 0
    assert "times the critical speeds" in " ".join(capsys.readouterr().out.split())
    summary = json.loads((folder / "summary.json").read_text())
    each = [tables.read(folder / f"mode_{side}.csv") for side in ("left", "right")]
    contacts = [summary["contacts"][side] for side in ("left", "right")]
    assert not (folder / "mode.csv").exists()
    for modes, side in zip(each, ("left", "right"), strict=True):
        points = tables.read(folder / f"interface_{side}.csv")
        for number in np.unique(modes["mode"]):
            np.testing.assert_array_equal(modes["s"][modes["mode"] == number], points["s"])
        assert drawn(folder / f"mode_{side}.png") > 0.01
    sizes = [np.hypot(modes["pressure"], modes["pressure_imaginary"]) for modes in each]
    for number in np.unique(each[0]["mode"]):
        pairs = zip(each, sizes, strict=True)
        largest = [size[modes["mode"] == number].max() for modes, size in pairs]
        assert max(largest) == pytest.approx(1.0, rel=1e-9)
        assert min(largest) < 1.0
    known = {contact["critical_angular_velocity_rad_per_s"] for contact in contacts}
    assert known == {summary["critical_speed_factor"] * 0.5}
    assert main(["report", str(folder)]) == 0
    page = (folder / "report.html").read_text()
    assert "Contact right: pressure perturbations" in page

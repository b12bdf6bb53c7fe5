"""Tables of the results folder."""

import json
import resource

import meshio
import numpy as np
import pytest

from thermowear.app.cli import main
from thermowear.output import tables
from thermowear.results import HistoryRow
from thermowear.results.quantity import table_of

from ..conftest import COLD_RUNNING_IN


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("run") / "out"
    arguments = [
        "run",
        str(COLD_RUNNING_IN),
        "-o",
        str(path),
        "--no-pictures",
        "--set=mesh.degree=2",
        "--set=mesh.elements=4",
        "--set=analysis.end_time=2 s",
        '--set=analysis.output_times=["0.5 s", "1 s"]',
    ]
    assert main(arguments) == 0
    return path


def test_columns_are_those_of_the_contract(folder):
    """requirement: other programs rely on these headers."""
    head = (folder / "interface.csv").read_text().splitlines()[0]
    assert head == (
        "x_m,y_m,z_m,s_m,weight_m2,pressure_Pa,gap_m,shape_m,wear_1_m,wear_2_m,wear_rate_1_m_per_s,"
        "wear_rate_2_m_per_s,temperature_1_K,temperature_2_K,heat_flux_1_W_per_m2,"
        "heat_flux_2_W_per_m2"
    )
    head = (folder / "history.csv").read_text().splitlines()[0]
    assert head == (
        "time_s,sliding_distance_m,max_pressure_Pa,contact_area_m2,wear_volume_1_m3,"
        "wear_volume_2_m3,max_temperature_K,approach_m,step_s,error,max_wear_1_m,max_wear_2_m,"
        "friction_power_W,friction_force_N,friction_torque_Nm"
    )


def test_files_agree_with_each_other(folder):
    """requirement: summary, tables and fields are consistent."""
    names = {path.name for path in folder.iterdir()}
    assert names == {
        "summary.json",
        "run.json",
        "case.resolved.toml",
        "interface.csv",
        "interface_0.5.csv",
        "interface_1.csv",
        "profile.csv",
        "history.csv",
        "checkpoint.npz",
        "fields.vtu",
    }
    summary = json.loads((folder / "summary.json").read_text())
    interface = tables.read(folder / "interface.csv")
    history = tables.read(folder / "history.csv")
    assert interface["weight"] @ interface["pressure"] == pytest.approx(summary["normal_force_N"])
    assert summary["normal_force_N"] == pytest.approx(50e6 * np.pi * (0.12**2 - 0.02**2), rel=1e-12)
    assert len(interface["x"]) == summary["contact_points"]
    assert len(history["time"]) == summary["steps"] + 1
    assert history["wear_volume_1"][-1] == pytest.approx(
        summary["wear_volume_1_m3"], rel=1e-12, abs=0.0
    )
    assert np.ptp(interface["shape"]) == pytest.approx(summary["shape_range_m"], rel=1e-12, abs=0.0)
    assert json.loads((folder / "run.json").read_text())["status"] == "done"
    assert sum(summary["seconds"].values()) > 0
    middle = tables.read(folder / "interface_0.5.csv")
    assert 0 < middle["wear_1"].max() < interface["wear_1"].max()


def test_contracted_summary_keys(folder):
    """requirement: the summary has at least these keys for any analysis."""
    summary = json.loads((folder / "summary.json").read_text())
    for key in [
        "analysis",
        "model",
        "method",
        "dofs_displacement",
        "dofs_temperature",
        "contact_points",
        "normal_force_N",
        "friction_force_N",
        "friction_torque_Nm",
        "max_pressure_Pa",
        "mean_pressure_Pa",
        "min_pressure_Pa",
        "contact_area_m2",
        "shape_range_m",
        "max_temperature_K",
        "friction_power_W",
        "heat_balance_relative_error",
        "equilibrium_relative_error",
        "rigid_wear_velocity_m_per_s",
        "wear_dissipation_W",
        "wear_volume_1_m3",
        "wear_volume_2_m3",
        "steps",
        "seconds",
    ]:
        assert key in summary, key


def test_fields_cover_both_bodies(folder):
    """requirement: meshio reads fields.vtu; punch above plate, displaced by the load."""
    mesh = meshio.read(folder / "fields.vtu")
    body = mesh.cell_data["body"][0]
    height = mesh.points[mesh.cells[0].data].mean(axis=1)[:, 1]
    assert set(body) == {1, 2}
    assert np.all((body == 1) == (height > 0))
    assert np.all(mesh.point_data["von_mises_Pa"] >= 0)
    down = mesh.point_data["displacement_m"][:, 1]
    assert down[mesh.points[:, 1] > 0.0499].max() < 0
    assert np.abs(down[mesh.points[:, 1] < -0.0999]).max() < 1e-9


def test_columns_of_other_versions(tmp_path):
    """requirement: unknown columns are read by their headers; the order of columns is free; a
    missing one is named where it is needed."""
    (tmp_path / "interface_0.5.csv").write_text("pressure_Pa,film_m,x_m\n1e6,2e-7,0.5\n")
    data = tables.read(tmp_path / "interface_0.5.csv")
    assert list(data) == ["pressure", "film_m", "x"]
    assert data.drawn("x") == pytest.approx([500.0])
    assert data.drawn("film_m") == pytest.approx([0.2])
    assert data.quantities["film_m"].axis == "film [µm]"
    assert data.quantities["gap"].axis == "gap [µm]"
    with pytest.raises(tables.MissingColumnError, match=r"interface_0\.5\.csv has no column gap_m"):
        _ = data["gap"]


def test_a_row_that_the_disk_does_not_take_leaves_no_trace(tmp_path):
    """requirement: tables remain valid on a full disk, and continue afterwards."""
    path = tmp_path / "history.csv"
    rows = [HistoryRow(*np.full(15, value).tolist()) for value in (1 / 3, 2 / 3, 4 / 3)]
    writer = tables.RowWriter(tmp_path, table_of(HistoryRow), rows[:1])
    whole = path.read_bytes()
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(whole) + 30, hard))  # for less than a row
    try:
        with pytest.raises(OSError, match="too large"):
            writer.add(rows[1])
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert path.read_bytes() == whole
    writer.add(rows[2])
    assert tables.read(path)["time"] == pytest.approx([1 / 3, 4 / 3])

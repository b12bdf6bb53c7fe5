"""Files, pictures and console output of hot spots."""

import json

import matplotlib.image as mpimg
import meshio
import numpy as np
import pytest
import tomli_w

from thermowear.app.cli import main
from thermowear.output import tables

from ..case.starter import tables as case_tables

CHANGES = {"mesh.degree": 3, "mesh.elements": 4, "analysis.hot_spots": [0, 4, 5]}


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    file = tmp_path_factory.mktemp("case") / "case.toml"
    file.write_bytes(tomli_w.dumps(case_tables("disk-brake-stability", CHANGES)).encode())
    return file


def run(case, folder, capsys, *options):
    assert main(["run", str(case), "-o", str(folder), *options]) == 0
    return " ".join(capsys.readouterr().out.split())


def drawn(path):
    image = mpimg.imread(path)[..., :3]
    return (np.abs(image - image[0, 0]).max(axis=2) > 0.05).mean()


def test_files(case, tmp_path, capsys):
    """requirement: tables, fields round the disk, pictures, summary and console line."""
    folder = tmp_path / "results"
    said = run(case, folder, capsys)
    modes, growth = (tables.read(folder / f"{name}.csv") for name in ("hot_spots", "growth"))
    assert modes["number"].tolist() == [0, 4, 5] * 2
    assert modes["symmetry"].tolist() == [1] * 3 + [-1] * 3
    summary = json.loads((folder / "summary.json").read_text())
    spots = modes["number"] > 0
    factor = summary["first_hot_spots_speed_factor"]
    assert factor == pytest.approx(modes["speed_factor"][spots].min(), rel=1e-12)
    assert summary["first_hot_spots_symmetry"] == "antisymmetric"
    assert summary["first_mode_number"] == 0
    turning = summary["first_hot_spots_angular_velocity_rad_per_s"]
    assert turning == pytest.approx(40 * factor, rel=1e-12)
    number = summary["first_hot_spots_number"]
    assert f"first hot spots {number}, antisymmetric, from {turning:.4g} rad/s" in said
    rates, speeds = growth["growth_rate"], growth["speed_factor"]
    assert (np.sign(rates) == np.sign(speeds - factor)).all()
    check_fields(meshio.read(folder / "hot_spots.vtu"), number)
    for name in ("hot_spots", "hot_spots_3d"):
        assert drawn(folder / f"{name}.png") > 0.01
    assert main(["report", str(folder)]) == 0
    assert "Critical speeds by the number of hot spots" in (folder / "report.html").read_text()
    run(case, folder, capsys, "--overwrite", "--no-pictures")


def check_fields(mesh, number):
    """Alternating spots: opposite temperatures below each other, and after half a wave."""
    x, y, z = mesh.points.T
    rise = mesh.point_data["temperature_K"]
    assert np.abs(rise).max() == pytest.approx(1.0, abs=0.05)
    middle, angle = -0.006, np.arctan2(y, x)
    top = np.abs(z) < 1e-6
    below = np.abs(z - 2 * middle) < 1e-6
    key = np.round(np.column_stack([np.hypot(x, y), np.cos(angle), np.sin(angle)]), 5)
    one, other = (np.lexsort(key[part].T) for part in (top, below))
    np.testing.assert_allclose(rise[top][one], -rise[below][other], atol=1e-6)
    waves = np.fft.rfft(ring_at(rise, x, y, z, top))
    assert np.argmax(np.abs(waves)) == number


def ring_at(rise, x, y, z, top):
    """Temperatures round the disk where they are largest, by angle."""
    radius = np.hypot(x, y)
    hottest = radius[top][np.argmax(np.abs(rise[top]))]
    ring = top & (np.abs(radius - hottest) < 1e-7)
    angle = np.round(np.arctan2(y[ring], x[ring]), 6)
    _, first = np.unique(angle, return_index=True)
    return rise[ring][first]

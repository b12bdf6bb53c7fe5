"""Pictures of what is left of a coating."""

import matplotlib.image as mpimg
import numpy as np
import pytest
import tomli_w

from thermowear.app.cli import main
from thermowear.output import tables
from thermowear.output.pictures.curves import coated_bodies, draw_coating
from thermowear.output.pictures.maps import draw_coating_maps

from ..case.starter import changed
from ..case.starter import tables as case_of
from ..conftest import DEMOS
from ..simulation.space import PUNCH


def shows_something(path):
    image = mpimg.imread(path)[..., :3]
    return (np.abs(image - image[0, 0]).max(axis=2) > 0.05).mean() > 0.01


@pytest.mark.parametrize("in_space", [False, True])
def test_picture_of_the_coating(in_space, tmp_path, capsys):
    """
    requirement: along the contact at the output times, in space a map; numbers on the console.
    """
    if in_space:
        layers = {"thickness": ["1 um"], "coefficient": ["1e-8 1/MPa"]}
        wear = {"coefficient": "1e-7 1/MPa", "layers": layers}
        analysis = {"type": "transient", "end_time": "300 s"}
        case = changed(PUNCH, {"analysis": analysis, "wear": {"punch": wear}})
    else:
        case = case_of("sphere-on-block-coated", {"mesh.elements": 16})
        case["analysis"] |= {"end_time": "120 s", "output_times": ["45 s"], "tolerance": 1e-2}
    (tmp_path / "case.toml").write_text(tomli_w.dumps(case), encoding="utf-8")
    folder = tmp_path / "results"
    assert main(["run", str(tmp_path / "case.toml"), "-o", str(folder), "--no-pictures"]) == 0
    if not in_space:
        said = capsys.readouterr().out
        assert "coating worn through, sphere" in " ".join(said.split())
    data = tables.read(folder / "interface.csv")
    assert coated_bodies(data) == ["coating_left_1"]
    assert "coating_left_2" not in data
    (draw_coating_maps if in_space else draw_coating)(folder)
    assert shows_something(folder / "coating.png")


def test_no_picture_without_a_coating(tmp_path):
    """
    requirement: no column and no picture of uncoated faces.
    """
    case = str(DEMOS / "stacked_blocks.toml")
    end = "analysis={type='transient', end_time='10 s'}"
    words = ["run", case, "-o", str(tmp_path / "out"), "--no-pictures", "--set", end]
    assert main([*words, "--set", "mesh.degree=2"]) == 0
    draw_coating(tmp_path / "out")
    assert not (tmp_path / "out" / "coating.png").exists()
    assert coated_bodies(tables.read(tmp_path / "out" / "interface.csv")) == []

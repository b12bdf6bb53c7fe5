"""Pictures: drawn from the results folder alone, and not empty."""

import shutil

import matplotlib as mpl
import matplotlib.image as mpimg
import numpy as np
import pytest
from matplotlib.text import Text

from thermowear import CaseError
from thermowear.app.cli import main
from thermowear.case.starters import starter_text
from thermowear.output.pictures.curves import draw_interface
from thermowear.output.pictures.make import make_pictures
from thermowear.output.pictures.over_time import draw_heat, draw_history
from thermowear.output.pictures.panels import column, from_zero, time_text
from thermowear.output.rendering import Renderer

from ..conftest import COLD_RUNNING_IN, HOT


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """Results of a hot steady run and of a cold running-in, coarse, without pictures."""
    base = tmp_path_factory.mktemp("results")
    small = ["--no-pictures", "--set=mesh.degree=3", "--set=mesh.elements=6"]
    short = ["--set=analysis.end_time=5 s", '--set=analysis.output_times=["1 s"]']
    assert main(["run", str(HOT), "-o", str(base / "hot"), *small]) == 0
    assert main(["run", str(COLD_RUNNING_IN), "-o", str(base / "cold"), *small, *short]) == 0
    return base


@pytest.fixture(scope="module")
def drawn(folders):
    """Results folders with all pictures drawn once."""
    assert make_pictures(folders / "hot") == []
    assert make_pictures(folders / "cold") == []
    return folders


def test_every_picture_shows_something(drawn):
    """requirement: the PNG exists, is large enough, and more than 1 % of it is drawn."""
    expected = {
        "hot": {"interface", "bodies", "deformed"},
        "cold": {"interface", "bodies", "deformed", "wear", "history"},
    }
    for name, pictures in expected.items():
        assert {p.stem for p in (drawn / name).glob("*.png")} == pictures
        for path in (drawn / name).glob("*.png"):
            image = mpimg.imread(path)[..., :3]
            assert min(image.shape[:2]) > 400, path
            assert (np.abs(image - image[0, 0]).max(axis=2) > 0.05).mean() > 0.01, path
            shades = np.round(10 * image).astype(int) @ [10_000, 100, 1]
            assert len(np.unique(shades)) > 5, path


def test_pictures_have_their_own_style(folders):
    """requirement: a `matplotlibrc` of the current folder has no influence."""
    with mpl.rc_context({"text.usetex": True, "savefig.format": "none"}):
        draw_interface(folders / "hot")
    image = mpimg.imread(folders / "hot" / "interface.png")
    assert image.shape[:2] == (round(3 * 2.3 * 150), round(6.4 * 150))


@pytest.mark.parametrize(("end", "text"), [(3.0, "3 s"), (7200.0, "7200 s"), (40403.8, "11.22 h")])
def test_long_times_are_in_hours(end, text):
    """requirement: times of runs beyond two hours are readable, the same unit in all labels."""
    assert time_text(end) == text
    assert time_text(3600.0, end).endswith(text[-1])


def test_no_label_is_cut_off(tmp_path):
    """requirement: all labels are drawn where two layouts with other ticks would alternate."""
    x, labels = np.linspace(0.0, 1.5, 31), ("contact pressure\n[MPa]", "shape\n[µm]")
    curves = np.full(31, 2 / 15), np.linspace(347.3, 0.0, 31)
    with column(tmp_path / "picture.png", 2, 2.3) as axes:
        for axis, y, label in zip(axes, curves, labels, strict=True):
            axis.plot(x, y)
            axis.set(xlabel="x [mm]", ylabel=label)
        from_zero(axes[0])
    image = mpimg.imread(tmp_path / "picture.png")[..., :3]
    assert (image[:, :3] > 0.95).all()


STARTERS = {
    "cylinder-on-block": {"interface", "bodies", "deformed"},
    "cylinder-stick-slip": {"interface", "bodies", "deformed", "friction", "loads"},
}


@pytest.mark.slow
@pytest.mark.parametrize(("name", "expected"), STARTERS.items(), ids=STARTERS)
def test_pictures_of_curved_faces(name, expected, tmp_path):
    """requirement: a run draws pictures of a plane half model and of a load history."""
    file, folder = tmp_path / "case.toml", tmp_path / "results"
    file.write_text(starter_text(name), encoding="utf-8")
    small = ["--set=mesh.degree=3", "--set=mesh.elements=12"]
    if name == "cylinder-stick-slip":
        small.append("--set=analysis.increments=3")
    assert main(["run", str(file), "-o", str(folder), *small]) == 0
    assert {p.stem for p in folder.glob("*.png")} == expected
    for path in folder.glob("*.png"):
        image = mpimg.imread(path)[..., :3]
        assert min(image.shape[:2]) > 400, path
        assert (np.abs(image - image[0, 0]).max(axis=2) > 0.05).mean() > 0.01, path


def test_temperatures_in_time(tmp_path):
    """requirement: three panels, curves from the first step to the last; none for one row."""
    file, folder = tmp_path / "case.toml", tmp_path / "results"
    file.write_text(starter_text("disk-brake-stop"), encoding="utf-8")
    small = ["--no-pictures", "--set=mesh.degree=2", "--set=mesh.elements=4"]
    assert main(["run", str(file), "-o", str(folder), *small]) == 0
    draw_heat(folder)
    image = mpimg.imread(folder / "heat.png")[..., :3]
    third = image.shape[0] // 3
    for k in range(3):
        panel = image[k * third : (k + 1) * third]
        coloured = (panel.max(axis=2) - panel.min(axis=2)) > 0.2
        assert coloured.any(axis=0).mean() > 0.75
    (folder / "heat.png").unlink()
    rows = (folder / "heat.csv").read_text(encoding="utf-8").splitlines()[:2]
    (folder / "heat.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    draw_heat(folder)
    assert not (folder / "heat.png").exists()


def test_a_joint_at_rest_has_no_empty_panels(tmp_path):
    """requirement: neither friction power nor worn volume is drawn where there is none, and an
    even pressure is drawn clear of the upper end of its axis."""
    file, folder = tmp_path / "case.toml", tmp_path / "results"
    file.write_text(starter_text("stacked-blocks-at-rest"), encoding="utf-8")
    small = ["--no-pictures", "--set=mesh.degree=2", "--set=analysis.end_time=40 s"]
    small += ['--set=analysis.output_times=["30 s"]']
    assert main(["run", str(file), "-o", str(folder), *small]) == 0
    draw_heat(folder)
    draw_history(folder)
    for name, panels in (("heat", 2), ("history", 1)):
        image = mpimg.imread(folder / f"{name}.png")[..., :3]
        assert image.shape[0] < 150 * (2.4 * panels + 0.4)  # no room for another panel
        red = (image[..., 0] - image[..., 1:].max(axis=2)) > 0.3
        orange = image[..., 1] > 0.4
        pressure = np.flatnonzero((red & ~orange).any(axis=1))
        assert len(pressure)
        last = image.shape[0] * (panels - 1) // panels
        assert pressure.min() > last + 4
        assert pressure.max() - pressure.min() < 12  # a level line


def test_bodies_are_drawn_in_colour(drawn):
    """requirement: the bodies are filled with the colours of their field, not an empty frame."""
    image = mpimg.imread(drawn / "hot" / "bodies.png")[..., :3]
    coloured = (image.max(axis=2) - image.min(axis=2)) > 0.1
    assert coloured.mean() > 0.2


def test_bodies_that_cannot_be_drawn(folders, tmp_path):
    """requirement: the curves are drawn and the reason is said."""
    folder = tmp_path / "copy"
    shutil.copytree(folders / "hot", folder)
    for picture in folder.glob("*.png"):
        picture.unlink()
    (folder / "fields.vtu").write_text("no fields", encoding="utf-8")
    problems = make_pictures(folder)
    assert len(problems) == 1
    assert problems[0].startswith("the bodies could not be drawn: ")
    assert (folder / "interface.png").exists()
    assert not (folder / "bodies.png").exists()


def test_sections_need_no_other_process(folders, monkeypatch):
    """requirement: neither VTK nor a second Python is started for them."""
    monkeypatch.setattr(Renderer, "start", lambda _: pytest.fail("a process is started"))
    assert make_pictures(folders / "cold") == []


def test_no_results_no_pictures(tmp_path):
    with pytest.raises(CaseError, match=r"interface\.csv"):
        make_pictures(tmp_path)


def test_names_are_text_in_pictures(tmp_path):
    """requirement: a name that looks like mathematics is drawn as it is, powers of ten as such."""
    with column(tmp_path / "p.png", 2, 2.0, sharex=False) as (first, second):
        first.plot([1, 2], [1, 2], label="$^$")
        first.set_title("$^$")
        first.legend()
        first.set_xticks([1, 2], ["$\\alpha$", "$_$"])
        second.plot([1, 2], [1e-3, 1e5])
        second.set_yscale("log")
        second.set_ylabel("$x^$ [kN]")
    texts = {text.get_text(): text.get_parse_math() for text in first.figure.findobj(Text)}
    names = ("$^$", "$\\alpha$", "$_$", "$x^$ [kN]")
    assert not any(texts[name] for name in names)
    powers = [text for text in texts if "mathdefault" in text]
    assert powers
    assert all(texts[power] for power in powers)
    assert mpimg.imread(tmp_path / "p.png")[..., :3].std() > 0.01

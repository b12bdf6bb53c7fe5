"""The gallery of the demo cases."""

from __future__ import annotations

import importlib.util
import json
import re
import shlex
import sys
from pathlib import Path

import matplotlib.image as mpimg
import numpy as np
import pytest

from thermowear.case.starters import starter_text, starters

from ..conftest import DEMOS


@pytest.fixture(scope="module")
def gallery():
    """The script as a module."""
    sys.path.insert(0, str(DEMOS))  # as for a script: its neighbours can be imported
    spec = importlib.util.spec_from_file_location("gallery", DEMOS / "gallery.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    sys.path.remove(str(DEMOS))
    return module


@pytest.mark.parametrize("name", starters())
def test_every_starter_has_a_text(name, gallery):
    """requirement: the comment at the head of a starter says what the case is about."""
    text = gallery.leading_text(starter_text(name))
    assert 60 < len(text) < 500
    assert text[0].isupper()
    assert text[-1] in ".?!)"
    assert "#" not in text


@pytest.mark.parametrize(
    ("case", "text"),
    [
        ("# One\n#   line.\n\n# not this\n", "One line."),
        ("# One.\n#\n# not this\ntitle = 'a'\n", "One."),
        ("# One.\ntitle = 'a' # not this\n", "One."),
        ("title = 'a'\n# not this\n", ""),
        ("", ""),
    ],
)
def test_the_text_is_the_first_paragraph_of_the_comment(case, text, gallery):
    """requirement: up to the first line of the leading comment that is empty."""
    assert gallery.leading_text(case) == text


def test_figures_say_what_there_is(gallery):
    """requirement: figures of the summary in engineering units, none that is zero or missing."""
    summary = {
        "max_pressure_Pa": 174996903.6,
        "shape_range_m": 3.99444e-05,
        "wear_volume_1_m3": 1.5607172e-05,
        "wear_volume_2_m3": 0.0,
        "max_temperature_K": None,
        "wear_coefficient_per": {"punch": "pressure"},
    }
    worn = "Largest pressure 175 MPa · peak-to-valley of the worn shape 39.94 µm"
    assert gallery.figures(summary) == f"{worn} · worn volume of body 1 15610 mm³"
    summary |= {"wear_coefficient_per": {}, "wear_volume_1_m3": 0.0, "max_temperature_K": 368.15}
    assert gallery.figures(summary) == "Largest pressure 175 MPa · highest temperature 95 °C"
    summary |= {"peak_temperature_K": 373.15, "shape_range_m": 4e-19}
    summary |= {"wear_coefficient_per": {"punch": "pressure"}, "critical_speed_m_per_s": 0.5}
    found = "Critical speed 500 mm/s · largest pressure 175 MPa · highest temperature 100 °C"
    assert gallery.figures(summary) == found


def noise(path: Path, width: int, height: int) -> None:
    """A picture of which a quarter does not compress."""
    grain = np.random.default_rng(1).normal(0, 60, (height, width, 3))
    grain[:, width // 4 :] = 0
    mpimg.imsave(path, (128 + grain).clip(0, 255).astype(np.uint8))


def test_pictures_become_small(gallery, tmp_path):
    """requirement: below 120 kB, in proportion, never enlarged; fields without bands."""
    noise(tmp_path / "large.png", 1200, 600)
    assert (tmp_path / "large.png").stat().st_size > 500_000
    content = gallery.small_png(tmp_path / "large.png")
    assert len(content) <= 120_000
    (tmp_path / "less.png").write_bytes(content)
    less = mpimg.imread(tmp_path / "less.png")[..., :3]
    assert less.shape[1] == pytest.approx(2 * less.shape[0], abs=2)
    colours = np.round(255 * less).astype(int) @ [65536, 256, 1]
    assert len(np.unique(colours)) > 1000
    noise(tmp_path / "little.png", 40, 30)
    (tmp_path / "same.png").write_bytes(gallery.small_png(tmp_path / "little.png"))
    assert mpimg.imread(tmp_path / "same.png").shape[:2] == (30, 40)


@pytest.fixture
def two(tmp_path):
    """Cases with results, one worn over time, one of several bodies; a picture that is no more."""
    files = {
        "one": ("wear", "interface", "bodies"),
        "two": ("interface",),
        "three": ("bodies", "profile_left", "profile_right", "interface_left"),
    }
    for name, drawn in files.items():
        (tmp_path / f"{name}.toml").write_text(f"# About {name}.\n\ntitle = 'Case {name}'\n")
        folder = tmp_path / "results" / name
        folder.mkdir(parents=True)
        summary = {"max_pressure_Pa": 5e7, "wear_coefficient_per": {}}
        if name == "three":  # several bodies
            per = {"wear_coefficient_per": {"pad": "pressure"}}
            summary = {"max_pressure_Pa": 5e7, "contacts": {"left": per, "right": per}}
        (folder / "summary.json").write_text(json.dumps(summary))
        for picture in drawn:
            noise(folder / f"{picture}.png", 60, 40)
    (tmp_path / "pictures").mkdir()
    (tmp_path / "pictures" / "old-bodies.png").write_bytes(b"")
    return tmp_path


def test_a_page_of_all_cases(two, gallery):
    """requirement: title, text, command, figures, and pictures that are there."""
    gallery.write_gallery(two, sorted(two.glob("*.toml")), two / "results")
    page = (two / "README.md").read_text(encoding="utf-8")
    assert re.findall(r"^## (.*)$", page, re.MULTILINE) == ["Case one", "Case three", "Case two"]
    for name in ("one", "two", "three"):
        assert f"\nAbout {name}.\n" in page
        assert f"\n    python3 -m thermowear run demos/{name}.toml\n" in page
    assert page.count("\nLargest pressure 50 MPa\n") == 3
    shown = re.findall(r"\]\((.*)\)", page)
    of_three = ("three-bodies", "three-profile_left", "three-profile_right")
    names = ("one-bodies", "one-wear", *of_three, "two-interface")
    assert shown == [f"pictures/{name}.png" for name in names]
    assert {f"pictures/{path.name}" for path in (two / "pictures").iterdir()} == set(shown)


def test_studies_on_the_page(two, gallery):
    """requirement: a study has its picture, and a command that a shell takes as it stands."""
    study = gallery.Study(
        "bent", "Bent", "As it is.", "one", "a.b", ("1 N", "2 N"), ('heat={ambient="20 degC"}',)
    )
    noise(two / "results" / "bent.png", 60, 40)
    gallery.write_gallery(two, [], two / "results", (), [study])
    page = (two / "README.md").read_text(encoding="utf-8")
    _, block = page.split("\nAs it is.\n\n")
    command = block.split("\n\n")[0].replace("\\\n", " ")
    assert shlex.split(command) == [
        *("python3", "-m", "thermowear", "sweep", "demos/one.toml"),
        *("--over", "a.b=1 N,2 N", "--set", 'heat={ambient="20 degC"}'),
    ]
    assert "![Bent](pictures/bent.png)" in page
    assert [path.name for path in (two / "pictures").iterdir()] == ["bent.png"]


def test_films_on_the_page(two, gallery):
    """requirement: a film, and the two commands that make it."""
    film = gallery.Film("one", "Goes", "It goes.", 7)
    (two / "results" / "one-film.gif").write_bytes(b"GIF89a")
    (two / "pictures" / "old-film.gif").write_bytes(b"")
    gallery.write_gallery(two, [], two / "results", films=[film])
    page = (two / "README.md").read_text(encoding="utf-8")
    _, block = page.split("\nIt goes.\n\n")
    run, show, *_ = (shlex.split(line) for line in block.splitlines())
    assert run[:5] == ["python3", "-m", "thermowear", "run", "demos/one.toml"]
    assert run[5:] == ["-o", "results/film", "--set", "analysis.frames=7"]
    assert show == ["python3", "-m", "thermowear", "animate", "results/film"]
    assert "![Goes](pictures/one-film.gif)" in page
    assert [path.name for path in (two / "pictures").iterdir()] == ["one-film.gif"]


def test_a_case_that_fails_ends_the_gallery(two, gallery, monkeypatch, capfd):
    """requirement: nothing is skipped: the exit code of the run, and no page."""
    monkeypatch.setattr(gallery, "HERE", two)
    monkeypatch.setattr(sys, "argv", ["gallery.py", "-o", str(two / "results")])
    assert gallery.main() == 1
    printed = capfd.readouterr().err
    assert "error: model: " in printed  # the run's own words
    assert "error: one ended with exit code 1" in printed
    assert not (two / "README.md").exists()
    assert (two / "results" / "two" / "interface.png").exists()

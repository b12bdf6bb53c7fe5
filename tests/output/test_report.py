"""Report: complete page of any results folder, without damage to other files."""

from __future__ import annotations

import base64
import json
import re
import shutil
from html.parser import HTMLParser
from pathlib import Path

import matplotlib.image as mpimg
import numpy as np
import pytest

from thermowear import output
from thermowear.app.cli import main
from thermowear.case.starters import starter_text
from thermowear.output import tables
from thermowear.output.files import BY_CONTACT, PICTURES
from thermowear.output.pictures.curves import draw_interface
from thermowear.output.report import is_report
from thermowear.output.report.contents import shown_table
from thermowear.output.report.figures import key_figures
from thermowear.results import TABLES

from ..case.starter import FRETTING, HERTZ, RUNNING_IN, STEADY

COARSE = ("mesh.degree=2", "mesh.elements=6")
RUNS = {
    STEADY: (),
    HERTZ: (),
    RUNNING_IN: ("analysis.end_time=2 s", 'analysis.output_times=["1 s"]'),
    FRETTING: ("analysis.increments=3",),
}
VOID = {"meta", "img"}


class Page(HTMLParser):
    """Parsed page; checks that elements are properly nested."""

    def __init__(self, text: str):
        super().__init__(convert_charrefs=True)
        self.open: list[str] = []
        self.elements: list[tuple[str, dict]] = []
        self.rows: list[tuple[str, list[str]]] = []
        self.text: dict[str, list[str]] = {}
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        names = [name for name, _ in attributes]
        assert len(names) == len(set(names))
        self.elements.append((tag, dict(attributes)))
        self.text.setdefault(tag, []).append("")
        if tag == "tr":
            self.rows.append((dict(attributes).get("title", ""), []))
        if tag in {"td", "th"}:
            self.rows[-1][1].append("")
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        for tag in self.open:
            self.text[tag][-1] += data
        if "td" in self.open or "th" in self.open:
            self.rows[-1][1][-1] += data

    def shown(self, key: str) -> str:
        """Displayed value of a key."""
        (cells,) = [cells for title, cells in self.rows if title.startswith(f"{key} = ")]
        return cells[-1]

    def table(self, caption: str) -> tuple[list[str], list[list[str]]]:
        """Heads and rows of the table below a heading."""
        number = [heading.split(":")[0] for heading in self.text["h3"]].index(caption)
        headed = [i for i, (_, cells) in enumerate(self.rows) if "[" in "".join(cells[:2])]
        first = [i for i in headed if self.rows[i][0] == ""][number]
        heads, rows = self.rows[first][1], []
        for title, cells in self.rows[first + 1 :]:
            if title or len(cells) != len(heads) or cells[0] == heads[0]:
                break
            rows.append(cells)
        return heads, rows


def report(folder: Path) -> Page:
    assert main(["report", str(folder)]) == 0
    return Page((folder / "report.html").read_text(encoding="utf-8"))


def content(path: Path):
    return json.loads(path.read_text(encoding="utf-8"))


def change(path: Path, **keys):
    path.write_text(json.dumps(content(path) | keys), encoding="utf-8")


@pytest.fixture(scope="module")
def runs(tmp_path_factory) -> Path:
    """Coarse results of every analysis, by the names of their starters."""
    base = tmp_path_factory.mktemp("runs")
    for name, keys in RUNS.items():
        (base / f"{name}.toml").write_text(starter_text(name), encoding="utf-8")
        words = [f"--set={key}" for key in (*COARSE, *keys)]
        case, out = str(base / f"{name}.toml"), str(base / name)
        assert main(["run", case, "-o", out, "--no-pictures", *words]) == 0
    return base


@pytest.fixture
def copy(runs, tmp_path):
    """Modifiable copy of a results folder."""

    def make(name: str) -> Path:
        return Path(shutil.copytree(runs / name, tmp_path / name))

    return make


# ---- what it says ----


@pytest.mark.parametrize("name", RUNS)
def test_a_page_says_everything_and_needs_nothing(name, copy, capsys):
    """requirement: well-formed, self-contained page with all summary keys, any analysis."""
    folder = copy(name)
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    page = report(folder)
    assert capsys.readouterr().out == f"wrote {folder / 'report.html'}\n"
    text = (folder / "report.html").read_text(encoding="utf-8")
    assert text.startswith('<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">')
    assert ("meta", {"name": "generator", "content": "thermowear"}) in page.elements
    assert {tag for tag, _ in page.elements}.isdisjoint({"script", "link", "iframe", "object"})
    assert not any({"href", "src", "srcset"} & set(keys) for _, keys in page.elements)
    assert not re.search(r"https?:|//[a-z]|url\(|@import", text)
    summary = content(folder / "summary.json")
    titles = " ".join(title for title, _ in page.rows)
    for key in paths(summary):
        if key != "title":
            assert f"{key} = " in titles, key
    assert page.text["h1"] == page.text["title"] == [summary["title"]]
    (case_text,) = page.text["pre"][-1:]
    assert case_text == (folder / "case.resolved.toml").read_text(encoding="utf-8")
    versions = content(folder / "run.json")["versions"]
    for program, version in versions.items():
        assert f"{program} {version}" in " ".join(page.text["td"])
    (folder / "report.html").unlink()
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_figures_are_in_engineering_units(copy):
    """requirement: MPa, mm, µm, °C, kN, mm³, from the SI values in the summary."""
    page = report(copy(STEADY))
    assert page.shown("mean_pressure_Pa") == "50 MPa"
    assert page.shown("normal_force_N") == "2199.11 kN"  # 50 MPa on π (0.12² - 0.02²) m²
    assert page.shown("friction_torque_Nm").endswith(" kN m")
    assert page.shown("contact_zones_m") == "[0, 100] mm"
    assert page.shown("rigid_wear_velocity_m_per_s") == "17.5 nm/s"
    assert page.shown("guide_force_N") == "–"
    assert page.shown("wear_coefficient_per.punch") == "friction-stress"
    cells = dict(cells for _, cells in page.rows if len(cells) == 2)
    assert "inner radius 20 mm" in cells["geometry"]
    assert "young modulus 200 GPa" in cells["bodies.punch"]
    assert "punch top 2000 W/m²/K" in cells["heat.cooling"]


VALUES = {
    "mean_pressure_Pa": (5e7, "50 MPa"),
    "max_pressure_Pa": (2.5e9, "2500 MPa"),
    "normal_force_N": (-36.5, "-36.5 N"),
    "friction_force_N": (2.2e6, "2200 kN"),
    "contact_area_m2": (1.5e-6, "1.5 mm²"),
    "contact_zones_m": ([[0.0, 1e-4], [2e-4, 5e-4]], "[0, 100], [200, 500] µm"),
    "wear_volume_1_m3": (1.25e-7, "125 mm³"),
    "shape_range_m": (4.4e-5, "44 µm"),
    "approach_m": (0.0125, "12.5 mm"),
    "max_temperature_K": (368.15, "95 °C"),
    "dissipated_energy_J": (2.1e-6, "2.1 µJ"),
    "rigid_wear_velocity_m_per_s": (2e-8, "20 nm/s"),
    "rigid_wear_rotation_rad_per_s": (2.5e-8, "25 nrad/s"),
    "guide_moment_Nm": (-1.5e4, "-15 kN m"),
    "seconds": ({"mesh": 0.5}, None),
    "seconds.mesh": (0.5, "0.5 s"),
    "dofs_displacement": (1234567, "1\u202f234\u202f567"),
    "friction_power_W": (float("nan"), "–"),
    "min_pressure_Pa": (float("-inf"), "–"),
    "guide_force_N": (None, "–"),
    # keys of a later release
    "wear_rate_mean_m_per_s": (3e-9, "3 nm/s"),
    "temperature_jump_K": (2.5, "2.5 K"),  # a difference: never turned to °C
    "cycles": (12, "12"),
    "converged": (True, "yes"),
    "moments_Nm": ([0.5, 2.0], "0.5, 2 N m"),
    "pads_Pa": ([{"left_Pa": 1e6}, None], "left: 1 MPa, –"),
    "per": ("m", "m"),
    "nothing_m": ([], "–"),
}


def test_every_kind_of_value_is_shown(copy):
    """requirement: unknown keys are in a separate group, undefined numbers are dashes."""
    folder = copy(HERTZ)
    keys = {key: value for key, (value, _) in VALUES.items() if "." not in key}
    change(folder / "summary.json", **keys)
    page = report(folder)
    for key, (_, text) in VALUES.items():
        if text is not None:
            assert page.shown(key) == text, key
    groups = [caption for caption in page.text["caption"] if not caption.startswith("Body ")]
    assert groups.index("Other") == len(groups) - 1
    labels = [cells[0] for _, cells in page.rows]
    assert "temperature jump" in labels
    assert "wear rate mean" in labels


def test_all_that_hurts_is_escaped(copy):
    """requirement: any text of a case is escaped on the page."""
    folder = copy(HERTZ)
    hurting = "<b>&\"'</title><script>alert(1)</script>\x00\ud800 µ"
    change(folder / "summary.json", title=hurting, analysis=hurting, **{hurting: hurting})
    change(folder / "run.json", status="failed", message=hurting)
    page = report(folder)
    seen = hurting.replace("\x00", "\ufffd").replace("\ud800", "\ufffd")
    assert page.text["h1"] == page.text["title"] == [seen]
    assert seen in page.text["p"][0]
    assert page.shown("analysis") == seen
    assert {"script", "b"}.isdisjoint(tag for tag, _ in page.elements)


def paths(summary, above=""):
    """Keys of a summary, those in tables by their paths."""
    for key, value in summary.items():
        if isinstance(value, dict):
            yield from paths(value, f"{above}{key}.")
        else:
            yield f"{above}{key}"


def marks(page: Page) -> list[tuple[str, str]]:
    classes = [keys.get("class", "") for tag, keys in page.elements if tag == "li"]
    return list(zip(classes, page.text["li"], strict=True))


def test_balances_are_judged(copy):
    """requirement: errors of equilibrium and heat are compared with 1e-6 and marked."""
    folder = copy(STEADY)
    of_bodies = ["good", "good"]  # worst forces and heat
    assert [mark for mark, _ in marks(report(folder))] == ["good", "good", *of_bodies]
    change(folder / "summary.json", equilibrium_relative_error=1.1e-6)
    assert [mark for mark, _ in marks(report(folder))] == ["bad", "good", *of_bodies]
    change(folder / "summary.json", equilibrium_relative_error=9e-7)
    change(folder / "summary.json", heat_balance_relative_error=float("nan"))
    found = marks(report(folder))
    assert [mark for mark, _ in found] == ["good", "bad", *of_bodies]
    assert "9.0e-07" in found[0][1]
    change(folder / "summary.json", heat_balance_relative_error=None)
    assert [mark for mark, _ in marks(report(folder))] == ["good", "", *of_bodies]


ENDS = {
    "done": ({}, "good", "Finished"),
    "failed": ({"message": "no step is small enough"}, "bad", "Stopped: no step is small enough."),
    "interrupted": ({}, "unsure", "Interrupted"),
    "running": ({}, "unsure", "Still running"),
    "paused": ({}, "unsure", "Unknown status: paused."),
}


@pytest.mark.parametrize(("status", "end"), ENDS.items(), ids=ENDS)
def test_the_verdict(status, end, copy):
    """requirement: status with reason, and the state that the figures refer to."""
    keys, mark, text = end
    folder = copy(RUNNING_IN)
    change(folder / "run.json", status=status, **keys)
    page = report(folder)
    assert ("p", {"class": f"verdict {mark}"}) in page.elements
    assert page.text["p"][0].startswith(text)
    assert ("The figures are those of the state at 2 s." in page.text["p"][0]) == (status != "done")


# ---- tables ----


def test_output_times_agree_with_the_history(copy):
    """requirement: pressure, area and volumes at 1 s and at the end are those of history.csv."""
    folder = copy(RUNNING_IN)
    heads, rows = report(folder).table("Output times")
    history = tables.read(folder / "history.csv")
    assert [row[0] for row in rows] == ["1", "2"]
    for row in rows:
        shown = dict(zip(heads, map(float, row), strict=True))
        (at,) = np.flatnonzero(history["time"] == shown["time [s]"])
        for name in ("max_pressure", "contact_area", "wear_volume_1"):
            expected = history.quantities[name].drawn(history[name][at])
            assert shown[history.quantities[name].axis] == pytest.approx(expected, rel=1e-5)
    assert "worn volume, plate [mm³]" not in heads  # nothing but zeros


def test_bodies_are_called_by_their_names(copy):
    """requirement: report and tables of two bodies call them as their case does."""
    folder = copy(RUNNING_IN)
    heads, _ = report(folder).table("Output times")
    assert "worn volume, punch [mm³]" in heads
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "worn volume, plate" in page
    assert "body 2" not in page.partition("case.resolved")[0]
    assert tables.read(folder / "interface.csv").quantities["wear_2"].label == "wear depth, plate"


def test_output_times_of_fretting_agree_with_the_loads(copy):
    """requirement: energy and stick area at the output times are those of loads.csv."""
    folder = copy(FRETTING)
    heads, rows = report(folder).table("Output times")
    loads = tables.read(folder / "loads.csv")
    assert [row[0] for row in rows] == ["1", "2", "3"]
    for row, at in zip(rows, (5, 8, 11), strict=True):
        shown = dict(zip(heads, map(float, row), strict=True))
        for name in ("dissipated", "stick_area", "contact_area", "max_pressure"):
            expected = loads.quantities[name].drawn(loads[name][at])
            assert shown[loads.quantities[name].axis] == pytest.approx(expected, rel=1e-5)
    slip = heads.index("largest slip [µm]")
    for row, name in zip(rows, ("friction_1", "friction_2", "friction"), strict=True):
        friction = tables.read(folder / f"{name}.csv")
        expected = 1e6 * max(friction["slip"].max(), -friction["slip"].min())
        assert float(row[slip]) == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("total", [1, 19, 20, 21, 5000])
def test_a_history_is_sampled(total, copy):
    """requirement: at most twenty rows, the first and the last among them."""
    folder = copy(RUNNING_IN)
    head = (folder / "history.csv").read_text(encoding="utf-8").splitlines()[0]
    rows = [",".join(f"{n + 0.25 * k:g}" for k in range(1, 16)) for n in range(total)]
    half_a_row = "17.5,3"  # of a run that is writing
    text = "\n".join([head, *rows, half_a_row])
    (folder / "history.csv").write_text(text, encoding="utf-8")
    _, shown = report(folder).table("History, one row per step")
    times = [float(row[0]) for row in shown]
    assert len(times) == min(total, 20)
    assert times[0] == 0.25
    assert times[-1] == total - 0.75
    assert np.all(np.diff(times) > 0)


def test_no_output_times_no_table(copy):
    """requirement: the table of output times is omitted without output times."""
    assert not any("Output times" in heading for heading in report(copy(STEADY)).text["h3"])


def test_columns_that_are_not_known(copy):
    """requirement: an unknown column is shown in the unit of its header."""
    folder = copy(RUNNING_IN)
    lines = (folder / "history.csv").read_text(encoding="utf-8").splitlines()
    more = [f"{lines[0]},tilt_rad,film_m", *(f"{line},0.5,nan" for line in lines[1:])]
    (folder / "history.csv").write_text("\n".join(more) + "\n", encoding="utf-8")
    heads, rows = report(folder).table("History, one row per step")
    assert heads[-1] == "tilt [mrad]"
    assert rows[0][-1] == "500"


def test_points_in_space_are_not_listed(copy):
    """requirement: a few of many unsorted points say nothing; their file and number are named."""
    folder = copy(STEADY)
    head, *rows = (folder / "interface.csv").read_text(encoding="utf-8").splitlines()
    k = head.split(",").index("s_m")
    cells = [row.split(",") for row in rows]
    lines = [",".join([*row[:k], "nan", *row[k + 1 :]]) for row in cells]
    (folder / "interface.csv").write_text("\n".join([head, *lines, ""]), encoding="utf-8")
    page = report(folder)
    assert f"{len(rows)} points in interface.csv, not shown here" in page.text["p"]
    assert "Contact at the end" in page.text["h3"]


def test_rounding_errors_are_zero(copy):
    """requirement: a force far below the others, and a position, are shown as 0."""
    folder = copy(STEADY)
    change(folder / "summary.json", guide_force_N=5.6e-13, equilibrium_relative_error=2e-15)
    page = report(folder)
    assert page.shown("guide_force_N") == "0 N"
    assert page.shown("equilibrium_relative_error") == "2e-15"
    values = {"x_m": np.array([0.01, 0.02]), "y_m": np.array([3e-19, -2e-19])}
    quantities = {name: TABLES["interface"].columns[name[0]] for name in values}
    assert [head.label for head in shown_table("", values, quantities, "").heads] == ["x"]


def test_memory_has_a_unit(copy):
    """requirement: bytes are shown in MB or GB."""
    folder = copy(STEADY)
    change(folder / "summary.json", factor_memory_estimate_bytes=905540000)
    assert report(folder).shown("factor_memory_estimate_bytes") == "906 MB"


# ---- pictures ----


def test_pictures_are_in_the_page(copy):
    """requirement: each picture is embedded unchanged, with a caption."""
    folder = copy(STEADY)
    draw_interface(folder)
    page = Page((report(folder), (folder / "report.html").read_text(encoding="utf-8"))[1])
    (image,) = [keys for tag, keys in page.elements if tag == "img"]
    start = "data:image/png;base64,"
    assert image["src"].startswith(start)
    decoded = base64.b64decode(image["src"].removeprefix(start), validate=True)
    assert decoded == (folder / "interface.png").read_bytes()
    (folder / "again.png").write_bytes(decoded)
    assert mpimg.imread(folder / "again.png").shape[0] > 400
    assert page.text["figcaption"] == [PICTURES["interface"]]
    assert not any("plot" in text for text in page.text["p"])


def test_without_pictures_it_says_how_to_make_them(copy):
    """requirement: the report of a run without pictures contains the commands to draw them."""
    folder = copy(STEADY)
    assert f"python3 -m thermowear plot {folder}" in report(folder).text["pre"][0]


def test_a_broken_picture_is_left_out(copy):
    """requirement: an incomplete picture file is omitted."""
    folder = copy(STEADY)
    (folder / "wear.png").write_bytes(b"")
    assert "img" not in {tag for tag, _ in report(folder).elements}


def test_parts_of_a_model_have_groups_of_their_own():
    """requirement: contacts, holders and bodies have lines; noise is relative to all of them."""
    summary = {
        "friction_power_W": 356.8,
        "contacts": {"rubbing": {"normal_force_N": 900.0, "friction_power_W": 356.8}},
        "holders": {"piston": {"approach_m": 4.59e-5}},
        "bodies": {"plate": {"contact_heat_W": 1e-14}},
    }
    found = key_figures(summary)
    assert list(found) == ["Heat and energy", "Contact rubbing", "Holder piston", "Body plate"]
    (force, _), (approach,), (heat,) = (found[name] for name in list(found)[1:])
    assert (force.label, force.text) == ("normal force", "900 N")
    assert force.source == "contacts.rubbing.normal_force_N = 900.0"
    assert approach.text == "45.9 µm"
    assert heat.text == "0 W"


def names_in(folder: Path, ending: str) -> set[str]:
    """Names of files with an ending in the sources of a folder."""
    texts = (path.read_text(encoding="utf-8") for path in folder.rglob("*.py"))
    return {name for text in texts for name in re.findall(rf'"(\w+)\.{ending}"', text)}


def test_everything_has_a_caption():
    """requirement: the report covers all pictures and tables of the program."""
    pictures = names_in(Path(output.__file__).parent / "pictures", "png")
    assert pictures | set(BY_CONTACT) == set(PICTURES)
    assert all(table.caption and table.content for table in TABLES.values())


# ---- unfinished runs, and what is none ----


def test_a_run_that_failed_half_way(tmp_path, capsys):
    """requirement: the report of a failed run contains the reason and the last figures."""
    (tmp_path / "case.toml").write_text(starter_text(RUNNING_IN), encoding="utf-8")
    words = [f"--set={key}" for key in (*COARSE, "analysis.max_steps=3")]
    out = tmp_path / "out"
    command = ["run", str(tmp_path / "case.toml"), "-o", str(out), "--no-pictures", *words]
    assert main(command) == 2
    page = report(out)
    assert ("p", {"class": "verdict bad"}) in page.elements
    assert "3 steps were not enough" in page.text["p"][0]
    assert page.shown("steps") == "3"


def test_a_run_that_left_nothing_but_its_case(copy):
    """requirement: the report of an early stop states that there are no results."""
    folder = copy(RUNNING_IN)
    for path in folder.iterdir():
        if path.name not in {"run.json", "case.resolved.toml", "history.csv"}:
            path.unlink()
    change(folder / "run.json", status="running")
    page = report(folder)
    assert page.text["h1"] == ["Annular punch turning on a plate, running-in"]
    assert "There is no summary." in page.text["p"][0]
    assert page.text["h3"] == ["History, one row per step"]
    assert "ended before there were results to draw" in "".join(page.text["p"])
    (folder / "case.resolved.toml").unlink()
    (folder / "history.csv").unlink()
    assert report(folder).text["h1"] == [RUNNING_IN]


def test_no_results_no_report(tmp_path, refused):
    """requirement: exit code 1 and one line without a results folder; nothing is written."""
    (tmp_path / "file").write_text("mine", encoding="utf-8")
    (tmp_path / "empty").mkdir()
    for name in ("none", "empty", "file", "n" * 300):
        assert str(tmp_path / name) in refused("report", str(tmp_path / name))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["empty", "file"]
    for text in ("", "[]", "{}", '{"versions": null}', '{"versions": {"other": "1"}}', "\xff"):
        (tmp_path / "empty" / "run.json").write_text(text, encoding="latin-1")
        assert "run.json" in refused("report", str(tmp_path / "empty"))
    assert [path.name for path in (tmp_path / "empty").iterdir()] == ["run.json"]


@pytest.mark.parametrize(
    "name", ["summary.json", "case.resolved.toml", "interface.csv", "history.csv"]
)
@pytest.mark.parametrize("broken", [b"\xff\xfe", b"{", b"a,b\n1\n", b"a_m\nx\n"])
def test_a_broken_file_is_named(name, broken, copy, refused):
    """requirement: one line naming the invalid file."""
    folder = copy(RUNNING_IN)
    if (name.endswith("csv"), broken) == (True, b"{"):
        broken = b""  # a single unfinished line is being written
    (folder / name).write_bytes(broken)
    assert str(folder / name) in refused("report", str(folder))
    assert not (folder / "report.html").exists()


# ---- files of others ----


def test_a_report_is_replaced(copy):
    """requirement: an earlier report is replaced, and no draft remains."""
    folder = copy(HERTZ)
    report(folder)
    change(folder / "summary.json", title="anew")
    assert report(folder).text["h1"] == ["anew"]
    assert is_report(folder / "report.html")
    assert not [path for path in folder.iterdir() if path.name.endswith(".part")]


@pytest.mark.parametrize(
    "mine", [b"", b"<p>mine</p>", b'<meta name="generator" content="thermowear-like">']
)
def test_a_page_of_someone_else_stays(mine, copy, refused):
    """requirement: a report.html of other origin is refused and remains."""
    folder = copy(HERTZ)
    (folder / "report.html").write_bytes(mine)
    line = refused("report", str(folder))
    assert f"{folder / 'report.html'}: exists and is not a report of this program" in line
    assert (folder / "report.html").read_bytes() == mine


def test_a_folder_or_a_link_of_someone_else_stays(copy, refused):
    """requirement: neither a folder of that name nor a broken link is replaced."""
    folder = copy(HERTZ)
    (folder / "report.html").mkdir()
    assert "not a report of this program" in refused("report", str(folder))
    (folder / "report.html").rmdir()
    (folder / "report.html").symlink_to("nowhere.html")
    assert "not a report of this program" in refused("report", str(folder))
    assert (folder / "report.html").is_symlink()


def test_where_nothing_can_be_written(copy, refused, monkeypatch):
    """requirement: a full disk is reported in one line."""

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    folder = copy(HERTZ)
    monkeypatch.setattr(Path, "write_text", full)
    assert refused("report", str(folder)).endswith(
        "report.html: cannot be written: No space left on device"
    )

"""Results of models of several bodies: tables by contact, and what belongs to a results folder."""

import contextlib
import io
import json
import tomllib

import numpy as np
import pytest
from PIL import Image

import thermowear as tw
from thermowear.app.cli import main
from thermowear.case.starters import starter_text, starters
from thermowear.output import tables
from thermowear.output.files import FRAMES, name_at, table_file
from thermowear.output.frames import frame_files, keep_indexed
from thermowear.output.pictures.animation import SectionPanel, contact_curves, read_frames

from ..slow import marked_slow
from .test_end_to_end import HEADS

ASSEMBLIES = [name for name in starters() if "[holders." in starter_text(name)]
COARSE = ("--set=mesh.degree=2", "--set=mesh.elements=6")
QUICK = {
    "clutch-pack": (
        "--set=analysis.end_time=0.3 s",
        '--set=analysis.output_times=["0.1 s"]',
    ),
    "strip-between-cylinders-fretting": (
        "--set=mesh.elements=20",
        "--set=wear.cycles=200",
        '--set=analysis.output_times=["1 s"]',
    ),
}
TWO_PADS = "disk-brake-two-pads"
TIMES = (
    "--set=analysis.type=transient",
    "--set=analysis.end_time=2 s",
    "--set=heat.transient=false",
)


READ = ("cad-pad", "two-pads-3d")
"""Starters with a mesh or CAD files, without a number of elements."""


def coarse(name):
    """Overrides of a starter for a coarse run."""
    return (*(COARSE[:1] if name in READ else COARSE), *QUICK.get(name, ()))


def run(folder, *words):
    with contextlib.redirect_stdout(io.StringIO()):
        return main(["run", str(folder / "case.toml"), "-o", str(folder / "results"), *words])


@pytest.fixture(scope="module", params=marked_slow(ASSEMBLIES, "cad-pad", "two-pads-3d"))
def finished(request, tmp_path_factory):
    """Starter case by name, and the results folder of a coarse run."""
    place = tmp_path_factory.mktemp(request.param)
    with contextlib.redirect_stdout(io.StringIO()):
        assert main(["init", request.param, "-o", str(place / "case.toml")]) == 0
    assert run(place, "--no-pictures", *coarse(request.param)) == 0
    return request.param, place / "results"


def contacts(case):
    return [name for name, contact in case.contacts.items() if not contact.tie]


def test_files_by_contact(finished):
    """requirement: tables of the points of each contact, with the columns of a pair."""
    _, folder = finished
    case = tw.load(folder / "case.resolved.toml")
    expected = {"summary.json", "run.json", "case.resolved.toml", "fields.vtu"}
    ends = [""]
    if case.analysis.type in ("transient", "fretting"):
        ends += [f"_at_{time:g}" for time in case.analysis.output_times]
        expected |= {"checkpoint.npz", "contacts.csv"}
    if case.analysis.type == "fretting":
        expected |= {f"{name}.csv" for name in ("loads", "cycles", "sticking", "holders")}
        expected |= {f"friction_{name}{end}.csv" for name in contacts(case) for end in ends}
    if case.analysis.type == "transient":
        expected |= {"history.csv"}
        heated = case.heat is not None and case.heat.transient
        expected |= {"heat.csv"} if heated else set()
    expected |= {f"interface_{name}{end}.csv" for name in contacts(case) for end in ends}
    expected |= {f"profile_{name}.csv" for name in contacts(case)}
    assert {path.name for path in folder.iterdir()} == expected
    assert json.loads((folder / "run.json").read_text(encoding="utf-8"))["status"] == "done"
    for path in folder.glob("*.csv"):
        head = path.read_text(encoding="utf-8").splitlines()[0]
        wet = ",fluid_pressure_Pa" if path.name == "interface_faces.csv" else ""
        assert head == HEADS[table_file(path.name).stem] + wet, path


def test_the_summary_is_that_of_the_tables(finished):
    """requirement: the summary of each contact is that of its table; the balances hold."""
    _, folder = finished
    case = tw.load(folder / "case.resolved.toml")
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert list(summary["bodies"]) == list(case.geometry.bodies)
    assert list(summary["holders"]) == list(case.holders)
    assert list(summary["contacts"]) == contacts(case)
    assert summary["equilibrium_relative_error"] < 1e-9
    assert (summary["heat_balance_relative_error"] or 0.0) < 1e-9
    count = 0
    for name, found in summary["contacts"].items():
        i = tables.read(folder / f"interface_{name}.csv")
        count += len(i["x"])
        assert i["pressure"].max() == pytest.approx(found["max_pressure_Pa"], rel=1e-12)
        if case.model == "axisymmetric":  # plane faces; the resultant of others is not their sum
            force = i["weight"] @ i["pressure"]
            assert force == pytest.approx(found["normal_force_N"], rel=1e-9)
            assert np.all(np.diff(i["s"]) >= 0)
        area = i["weight"][i["pressure"] > 0].sum()
        assert area == pytest.approx(found["contact_area_m2"], rel=1e-12)
        for side in (1, 2):
            if f"contact_heat_{side}_W" in found:
                heat = i["weight"] @ i[f"heat_flux_{side}"]
                assert heat == pytest.approx(found[f"contact_heat_{side}_W"], rel=1e-9, abs=1e-9)
    assert count == summary["contact_points"]
    power = sum(found["friction_power_W"] for found in summary["contacts"].values())
    assert power == pytest.approx(summary["friction_power_W"], rel=1e-12)
    heat = [
        body["contact_heat_W"] for body in summary["bodies"].values() if "contact_heat_W" in body
    ]
    if heat:
        assert sum(heat) == pytest.approx(power, rel=1e-9)


def test_histories_of_the_contacts_add_up(finished):
    """requirement: rows of the contacts at each step add up to those of the history."""
    _, folder = finished
    if not (folder / "contacts.csv").is_file():
        return
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    steps = "loads" if (folder / "loads.csv").is_file() else "history"
    history, rows = (tables.read(folder / f"{name}.csv") for name in (steps, "contacts"))
    each = [rows.rows(rows["contact"] == k) for k in range(1, len(summary["contacts"]) + 1)]
    for one in each:
        np.testing.assert_array_equal(one["time"], history["time"])
    for name in ("wear_volume_1", "wear_volume_2", "contact_area"):
        np.testing.assert_allclose(sum(one[name] for one in each), history[name], rtol=1e-12)
    largest = np.max([one["max_pressure"] for one in each], axis=0)
    np.testing.assert_allclose(largest, history["max_pressure"], rtol=1e-12)
    power = sum(one["friction_power"] for one in each)
    if (folder / "heat.csv").is_file():
        heat = tables.read(folder / "heat.csv")
        np.testing.assert_allclose(power, heat["friction_power"], rtol=1e-12, atol=1e-9)
    for one, found in zip(each, summary["contacts"].values(), strict=True):
        assert one["normal_force"][-1] == pytest.approx(found["normal_force_N"], rel=1e-9)
        assert one["wear_volume_1"][-1] == pytest.approx(found["wear_volume_1_m3"], rel=1e-12)
    if steps == "loads" or np.isnan(history["max_temperature"]).all():
        return
    sides = [one[f"max_temperature_{side}"] for one in each for side in (1, 2)]
    np.testing.assert_allclose(np.max(sides, axis=0), history["max_temperature"], rtol=1e-12)


def test_the_resolved_case_is_the_same_case(finished):
    """requirement: case.resolved.toml is a valid case again, with the values of all contacts."""
    name, folder = finished
    plain = tw.case.as_plain(tw.load(folder / "case.resolved.toml"))
    words = tuple(word[6:] for word in coarse(name))
    known = tw.load(folder.parent / "case.toml", words)
    assert plain == tw.case.as_plain(known)


def test_a_running_in_and_its_folder(tmp_path):
    """
    requirement: tables at output times by contact; a finished run is resumed without computing; a
    user's file of a similar name is not removed with the results.
    """
    (tmp_path / "case.toml").write_text(starter_text(TWO_PADS), encoding="utf-8")
    words = (*COARSE, *TIMES, '--set=analysis.output_times=["1 s"]')
    assert run(tmp_path, *words) == 0
    folder = tmp_path / "results"
    for name in ("left", "right"):
        file = folder / name_at("interface", 1.0, name)
        assert table_file(file.name) == ("interface", name, 1.0)
        early, late = tables.read(file), tables.read(folder / f"interface_{name}.csv")
        assert np.all(late["wear_1"] >= early["wear_1"])
        assert late["weight"] @ late["wear_1"] > 1.5 * (early["weight"] @ early["wear_1"])
        assert (folder / f"wear_{name}.png").stat().st_size > 10_000
    assert run(tmp_path, "--resume", *words) == 0
    (folder / "interface_notes.csv").write_text("mine", encoding="utf-8")
    (folder / "interface_notes.png").write_text("mine", encoding="utf-8")
    assert run(tmp_path, "--overwrite", "--no-pictures", *COARSE) == 0
    left = {path.name for path in folder.iterdir()}
    assert {"interface_notes.csv", "interface_notes.png"} <= left
    assert not {"history.csv", name_at("interface", 1.0, "left"), "wear_left.png"} & left


@pytest.mark.parametrize("name", ["10", "1e3", "left_at_2", "a/b", "", "a b"])
def test_names_of_contacts(name):
    """requirement: names of contacts are parts of file names that are told from times."""
    text = starter_text(TWO_PADS).replace("[contacts.left]", f'[contacts."{name}"]')
    with pytest.raises(tw.CaseError, match=r"^contacts\.") as error:
        tw.load(tomllib.loads(text))
    assert "name" in str(error.value)


def test_commands_for_several_bodies(tmp_path, capsys):
    """
    requirement: a sweep lists the numbers of each part; what is for pairs only is refused.
    """
    case = tmp_path / "case.toml"
    case.write_text(starter_text(TWO_PADS), encoding="utf-8")
    over = ("--over", "motions.disk.angular_velocity=1 rad/s,2 rad/s")
    words = ["sweep", str(case), *COARSE, *over, "-o", str(tmp_path / "sweep"), "--processes=1"]
    assert main(words) == 0
    head, one, two = (tmp_path / "sweep/sweep.csv").read_text("utf-8").splitlines()
    columns = dict(
        zip(head.split(","), zip(one.split(","), two.split(","), strict=True), strict=True)
    )
    power = [float(value) for value in columns["contacts.left.friction_power_W"]]
    assert power[1] == pytest.approx(2 * power[0], rel=1e-9)
    assert not (tmp_path / "sweep/shapes.png").exists()
    capsys.readouterr()
    assert main(["shape", str(case), "-o", str(tmp_path / "shape.csv")]) == 1
    assert "there are several contact faces" in capsys.readouterr().err


@pytest.mark.slow
def test_frames_by_contact(tmp_path, bodies_not_drawn):
    """requirement: an interface for each contact and frame; the animation shows all contacts."""
    (tmp_path / "case.toml").write_text(starter_text(TWO_PADS), encoding="utf-8")
    deep = ("--set=wear.left_pad.coefficient=4e-3 1/MPa", "--set=analysis.end_time=100 s")
    assert run(tmp_path, *COARSE, *TIMES, *deep, "--set=analysis.frames=4") == 0
    folder = tmp_path / "results"
    frames = frame_files(folder / FRAMES)
    assert 2 < len(frames) <= 4
    names = ("left", "right")
    files = {frame.file("interface", name).name for frame in frames for name in names}
    files |= {frame.file("fields").name for frame in frames}
    assert {path.name for path in (folder / FRAMES).iterdir()} == files | {"frames.pvd"}
    rows = tables.read(folder / "contacts.csv")
    for number, name in enumerate(names, start=1):
        largest = rows["max_pressure"][rows["contact"] == number]
        for frame in frames:
            pressure = tables.read(frame.file("interface", name))["pressure"]
            assert pressure.max() == pytest.approx(largest[frame.number], rel=1e-9)
    sequence = read_frames(folder)
    pressure, wear = contact_curves(sequence)
    assert pressure._curves == [("left", "pressure"), ("right", "pressure")]
    assert wear._curves == [("left", "wear_1"), ("right", "wear_1")]
    with Image.open(folder / "animation.gif") as film:
        assert film.n_frames == len(sequence.states)
    tops = [_top_of(section, 1) for section in SectionPanel(sequence).sections.values()]
    sunk = json.loads((folder / "summary.json").read_text("utf-8"))["holders"]["piston"]
    assert tops[0] - tops[-1] == pytest.approx(1e3 * sunk["approach_m"], rel=2e-2)
    (folder / FRAMES / "interface_left_at_99999.csv").write_text("left behind", encoding="utf-8")
    keep_indexed(folder / FRAMES)
    assert {path.name for path in (folder / FRAMES).iterdir()} == files | {"frames.pvd"}
    assert run(tmp_path, "--overwrite", "--no-pictures", *COARSE) == 0
    assert not (folder / FRAMES).exists()


def _top_of(section, body):
    """Largest height of a body [mm]."""
    return section.points[section.triangles[section.body == body], 1].max()

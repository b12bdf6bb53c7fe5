"""Whole runs by the command line: every starter case, and bodies that were meshed elsewhere."""

from __future__ import annotations

import contextlib
import io
import json
import math
from pathlib import Path

import numpy as np
import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main
from thermowear.case.starters import starter_text, starters
from thermowear.geometry.mesh.gmsh_session import gmsh_model
from thermowear.output import tables
from thermowear.output.files import name_at

from ..case import starter
from ..case.starter import FRETTING, HERTZ, PUNCH, RECIPROCATING, RUNNING_IN, SPHERE, STEADY
from ..slow import marked_slow
from ..systems import prepared

SPACE = "sphere-fretting"
VECTORS = ",z_m,shear_x_Pa,shear_y_Pa,shear_z_Pa,slip_x_m,slip_y_m,slip_z_m"
COATED = ("sphere-on-block-coated", "shaft-in-bush-coated")
PAIRS = [name for name in starters() if "[holders." not in starter_text(name)]

ALWAYS = {
    "summary.json", "run.json", "case.resolved.toml", "interface.csv", "profile.csv", "fields.vtu",
}  # fmt: skip
MORE = {
    RUNNING_IN: {"checkpoint.npz", "history.csv", "interface_1.csv"},
    FRETTING: {
        "checkpoint.npz",
        "loads.csv",
        "cycles.csv",
        "friction.csv",
        *(f"{stem}_{time}.csv" for stem in ("friction", "interface") for time in (1, 2)),
    },
    RECIPROCATING: {
        "checkpoint.npz",
        "history.csv",
        "track.csv",
        "track_1.csv",
        "interface_1.csv",
    },
}
COARSE = ("mesh.degree=3", "mesh.elements=6")
QUICK = {
    "disk-brake-hot-spots": ("mesh.elements=4", "mesh.degree=3", "analysis.hot_spots=[0, 5]"),
    RUNNING_IN: ("analysis.end_time=2 s", 'analysis.output_times=["1 s"]'),
    FRETTING: ("mesh.degree=2", "mesh.elements=12", "analysis.increments=3"),
    RECIPROCATING: ("mesh.degree=2", "analysis.cycles=4", 'analysis.output_times=["1 s"]'),
    "annular-punch-deep": ("mesh.elements=2", "mesh.degree=2")
    + ("analysis.end_time=20 h", 'analysis.output_times=["10 h"]'),
    "disk-sector": ("mesh.degree=2", "mesh.elements=4"),
    "disk-brake-3d": ("mesh.degree=2", "mesh.elements=4"),
    "rectangular-punch": ("mesh.degree=2", "mesh.elements=4"),
    "pin-on-disk": ("mesh.degree=2", "mesh.elements=4"),
    "pin-on-disk-ball": ("mesh.degree=2", "mesh.elements=4"),
    "pin-on-disk-running-in": ("mesh.degree=2", "mesh.elements=4")
    + ("analysis.end_time=20 s", 'analysis.output_times=["1 s"]'),
    "shaft-in-bush-coated": ("geometry.zone=6 mm",),  # coarse faces end farther away
    "tube-in-support": ("mesh.degree=2", "analysis.cycles=8000")
    + ('analysis.output_times=["200 s"]',),
    "sphere-fretting": (
        "mesh.degree=2",
        "mesh.elements=4",
        "analysis.increments=2",
        "wear.cycles=2",
    )
    + ('analysis.output_times=["62.5 ms"]',),
    "cylinder-fretting": ("mesh.degree=2", "wear.cycles=20", 'analysis.output_times=["1 s"]'),
}
READ = ("own-mesh", "own-mesh-3d")
"""Starters with a mesh file, whose elements are given."""
HEADS = {
    "probes": "time_s,probe,temperature_K",
    "interface": "x_m,y_m,z_m,s_m,weight_m2,pressure_Pa,gap_m,shape_m,wear_1_m,wear_2_m,"
    "wear_rate_1_m_per_s,wear_rate_2_m_per_s,temperature_1_K,temperature_2_K,"
    "heat_flux_1_W_per_m2,heat_flux_2_W_per_m2",
    "profile": "x_m,y_m,z_m,s_m,normal_x,normal_y,normal_z,shape_m,shape_along_press_m,"
    "wear_rate_m_per_s,wear_rate_along_press_m_per_s",
    "friction": "x_m,y_m,s_m,weight_m2,pressure_Pa,shear_Pa,slip_m,dissipated_J_per_m2,status",
    "loads": "time_s,normal_force_N,approach_m,tangential_force_N,tangential_displacement_m,"
    "max_pressure_Pa,contact_area_m2,stick_area_m2,dissipated_J,iterations,cycle,"
    "wear_volume_1_m3,wear_volume_2_m3",
    "hot": "number,wave_number_per_m,symmetry,speed_factor,frequency_rad_per_s,drift_m_per_s,"
    "speed_factor_with_wear,frequency_with_wear_rad_per_s",
    "growth": "speed_factor,growth_rate_per_s,frequency_rad_per_s,growth_rate_with_wear_per_s,"
    "frequency_with_wear_rad_per_s",
    "cycles": "cycle,time_s,wear_volume_1_m3,wear_volume_2_m3,dissipated_J,max_wear_1_m,"
    "max_wear_2_m,contact_area_m2,max_pressure_Pa,jump,error,stick_radius_m",
    "track": "x_m,wear_2_m,wear_rate_2_m_per_s",
    "heat": "time_s,speed_m_per_s,normal_force_N,friction_power_W,heat_in_J,heat_stored_J,"
    "heat_lost_J,balance_relative_error,max_temperature_1_K,max_temperature_2_K,mean_temperature_1_K,"
    "mean_temperature_2_K",
    "mode": "mode,speed_factor,growth_rate_per_s,frequency_rad_per_s,x_m,y_m,z_m,s_m,pressure,"
    "pressure_imaginary",
    "contacts": "time_s,contact,normal_force_N,friction_power_W,max_pressure_Pa,contact_area_m2,"
    "wear_volume_1_m3,wear_volume_2_m3,max_temperature_1_K,max_temperature_2_K",
    "sticking": "time_s,contact,friction_force_N,stick_area_m2,dissipated_J,cycle",
    "tangential": "time_s,holder,force_x_N,force_y_N,displacement_x_m,displacement_y_m,torque_Nm,"
    "twist_rad",
    "holders": "time_s,holder,normal_force_N,approach_m,tangential_force_N,"
    "tangential_displacement_m,moment_Nm,rotation_rad",
    "history": "time_s,sliding_distance_m,max_pressure_Pa,contact_area_m2,wear_volume_1_m3,"
    "wear_volume_2_m3,max_temperature_K,approach_m,step_s,error,max_wear_1_m,max_wear_2_m,"
    "friction_power_W,friction_force_N,friction_torque_Nm",
}


def run(file: Path, folder: Path, *words: str) -> int:
    return main(["run", str(file), "-o", str(folder), "--no-pictures", *words])


def sets(*overrides: str) -> list[str]:
    return [f"--set={text}" for text in overrides]


def coarse(name: str) -> tuple[str, ...]:
    """Overrides of a starter for a coarse run."""
    return (*(COARSE[:1] if name in READ else COARSE), *QUICK.get(name, ()))


def summary_of(folder: Path) -> dict:
    return json.loads((folder / "summary.json").read_text(encoding="utf-8"))


# ---- the starter cases ----


@pytest.fixture(scope="module", params=marked_slow(PAIRS, "ball-in-socket", "disk-brake-3d"))
def finished(request, tmp_path_factory):
    """Starter case by name, and the results folder of a coarse run."""
    name = request.param
    place = tmp_path_factory.mktemp(name)
    with contextlib.redirect_stdout(io.StringIO()):
        assert main(["init", name, "-o", str(place / "case.toml")]) == 0
        words = sets(*coarse(name))
        assert run(place / "case.toml", place / "results", *words) == 0
    return name, place / "results"


def test_a_starter_leaves_its_files(finished):
    """requirement: exactly the files of the contract, and status done."""
    name, folder = finished
    case = tw.load(folder / "case.resolved.toml")
    analysis, heat, more = case.analysis, case.heat, set()
    if analysis.type == "fretting":
        at = ("", *(f"_{time:g}" for time in analysis.output_times))
        more = {"loads.csv", "cycles.csv", *(f"friction{time}.csv" for time in at)}
        more |= {"checkpoint.npz"}
        more |= {f"interface{time}.csv" for time in at}
        more |= {"tangential.csv"} if case.model == "3d" else set()
    if analysis.type == "transient":
        more = {"history.csv", *(f"interface_{time:g}.csv" for time in analysis.output_times)}
        more |= {"checkpoint.npz"}
        more |= {"heat.csv"} if heat is not None and heat.transient else set()
        more |= {"probes.csv"} if case.probes else set()
    if analysis.type == "stability":
        more = {"mode.csv"}
        more |= {"hot_spots.csv", "growth.csv", "hot_spots.vtu"} if analysis.hot_spots else set()
    assert {path.name for path in folder.iterdir()} == ALWAYS | MORE.get(name, more)
    assert json.loads((folder / "run.json").read_text(encoding="utf-8"))["status"] == "done"


def test_the_columns_are_those_of_the_contract(finished):
    """requirement: other programs rely on these headers."""
    name, folder = finished
    for path in folder.glob("*.csv"):
        head, stem = path.read_text(encoding="utf-8").splitlines()[0], path.stem.partition("_")[0]
        coated = name in COATED and stem == "interface"
        vectors = VECTORS if name == SPACE and stem == "friction" else ""
        assert head == HEADS[stem] + (",coating_left_1_m" if coated else "") + vectors, path


def test_the_resolved_case_is_the_same_case(finished):
    """requirement: case.resolved.toml is a valid case again, every override in it."""
    name, folder = finished
    case = tw.load(folder.parent / "case.toml", coarse(name))
    assert tw.load(folder / "case.resolved.toml") == case


def test_summary_and_interface_tell_one_story(finished):
    """requirement: peak, area and force of the summary are those of interface.csv."""
    name, folder = finished
    summary, i = summary_of(folder), tables.read(folder / "interface.csv")
    pressing = i["pressure"] > 0
    assert len(i["x"]) == summary["contact_points"]
    assert i["pressure"].max() == pytest.approx(summary["max_pressure_Pa"], rel=1e-12)
    assert i["weight"][pressing].sum() == pytest.approx(summary["contact_area_m2"], rel=1e-12)
    carried = i["weight"] @ i["pressure"]
    # the normals of a round face lean: its pressure adds up to a little more than the force
    slightly_round = name in (HERTZ, FRETTING, SPHERE)
    level = np.ptp(i["y"]) < 1e-12
    if level or slightly_round:
        near = 1e-9 if level else 2e-3
        assert carried == pytest.approx(summary["normal_force_N"], rel=near)
    in_space = json.loads((folder / "summary.json").read_text("utf-8"))["model"] == "3d"
    assert np.isnan(i["s"]).all() if in_space else np.all(np.diff(i["s"]) >= 0)
    assert summary["equilibrium_relative_error"] < 1e-9
    case = tw.load(folder / "case.resolved.toml")
    assert np.isfinite(i["temperature_1"]).all() == (case.heat is not None)
    if level and case.motion is not None and case.motion.velocity is not None:
        along = 0.0 if case.geometry.slides_across else case.contact.friction * carried
        drag = math.copysign(along, case.motion.velocity)
        assert summary["guide_force_N"] == pytest.approx(drag, rel=1e-9, abs=1e-9 * carried)


def test_the_profile_is_that_of_the_interface(finished):
    """requirement: heights along the load direction are normal heights over the cosine."""
    _, folder = finished
    i = tables.read(folder / "interface.csv")
    profile = tables.read(folder / "profile.csv")
    normals = np.array([profile[f"normal_{axis}"] for axis in "xyz"])
    assert np.linalg.norm(normals, axis=0) == pytest.approx(1.0)
    assert np.array_equal(profile["shape"], i["shape"])
    assert profile["wear_rate"] == pytest.approx(
        i["wear_rate_1"] + i["wear_rate_2"], rel=1e-12, abs=0.0
    )
    press = np.array(tw.load(folder / "case.resolved.toml").geometry.press_direction)
    along = press @ normals[: len(press)]
    rates = profile["wear_rate_along_press"] * along
    assert rates == pytest.approx(profile["wear_rate"], rel=1e-12, abs=0.0)
    # how much lies above the deepest point is known from the shape, the rest is gap and wear
    pairing = prepared(tw.load(folder / "case.resolved.toml")).pairing
    unlike = pairing.gap + i["wear_1"] + i["wear_2"]
    lost = i["shape"].max() - i["shape"] + pairing.gap.min()
    heights = (lost / along).max() - lost / along
    # a mesh moved to its worn face is tilted: depths add up along normals that turn on the way
    tilt = np.abs(normals[: len(press)].T - pairing.normals).max()
    allowed = 1e-12 * np.ptp(i["shape"]) + tilt**2 * unlike.max() * np.ptp(1 / along)
    if summary_of(folder).get("geometry_updates"):  # from then on gaps lie between moved faces
        allowed += 1e-5 * np.ptp(i["shape"])
    assert profile["shape_along_press"] == pytest.approx(heights, abs=allowed)


INCLINED = {
    *("annular-punch-conical", "annular-punch-toroidal", "ring-segment-on-disk"),
    "shaft-in-bush-coated",
}
"""Starters with friction along inclined faces."""


def test_a_starter_carries_its_load(finished):
    """requirement: the force of the case; the approach of Hertz's starter."""
    name, folder = finished
    summary, case = summary_of(folder), tw.load(folder / "case.resolved.toml")
    if name == HERTZ:
        assert summary["approach_m"] == pytest.approx(50e-6, rel=1e-9, abs=0.0)
        assert summary["normal_force_N"] == pytest.approx(2230.2, rel=2e-3)
    elif "z" in case.holder.free:
        history = case.load.history
        pressed = 1.0 if history is None else history.loads.factor_at(summary["time_s"])
        expected = pytest.approx(pressed * case.force(), rel=1e-9, abs=1e-9)
        if name in INCLINED:  # friction carries a part of the load
            assert summary["equilibrium_relative_error"] < 1e-9
            assert summary["normal_force_N"] == pytest.approx(resultant(folder, case), rel=1e-9)
        else:
            assert summary["normal_force_N"] == expected
    else:
        assert summary["normal_force_N"] > 0.0


def resultant(folder, case):
    """Resultant of the pressure of a section; its radial or symmetric components cancel [N]."""
    i, profile = (tables.read(folder / f"{name}.csv") for name in ("interface", "profile"))
    x, y = ((i["weight"] * i["pressure"]) @ profile[f"normal_{axis}"] for axis in "xy")
    symmetric = case.model == "axisymmetric" or bool(prepared(case).model.symmetry)
    return abs(y) if symmetric else np.hypot(x, y)


@pytest.fixture(scope="module")
def fretting(tmp_path_factory):
    """Case file and results of the stick-slip starter."""
    place = tmp_path_factory.mktemp("fretting")
    (place / "case.toml").write_text(starter_text(FRETTING), encoding="utf-8")
    with contextlib.redirect_stdout(io.StringIO()):
        assert run(place / "case.toml", place / "results", *sets(*COARSE, *QUICK[FRETTING])) == 0
    return place


def test_tables_of_fretting_agree(fretting):
    """requirement: loads.csv, friction.csv and interface.csv are consistent."""
    folder, summary = fretting / "results", summary_of(fretting / "results")
    loads = tables.read(folder / "loads.csv")
    assert len(loads["time"]) == summary["steps"] == 4 * 3
    assert loads["time"][[2, 5, 8, 11]] == pytest.approx([0, 1, 2, 3])
    assert loads["tangential_force"][[5, 8, 11]] == pytest.approx([36, -36, 36], rel=1e-9)
    assert loads["dissipated"][-1] == pytest.approx(summary["dissipated_energy_J"], rel=1e-12)
    assert np.all(loads["iterations"][1:] >= 1)
    for time, row in ((1, 5), (2, 8), (None, 11)):
        f, i = (tables.read(folder / name_at(stem, time)) for stem in ("friction", "interface"))
        for column in ("x", "y", "s", "weight", "pressure"):
            np.testing.assert_array_equal(f[column], i[column])
        assert f["weight"] @ f["shear"] == pytest.approx(-loads["tangential_force"][row], rel=2e-3)
        assert f["weight"] @ f["dissipated"] == pytest.approx(loads["dissipated"][row], rel=1e-9)
        assert set(f["status"]) == {0.0, 1.0, 2.0}
        stuck = f["weight"][f["status"] == 1].sum()
        assert stuck == pytest.approx(loads["stick_area"][row], rel=1e-9)


def test_another_analysis_leaves_nothing_of_fretting(fretting, tmp_path):
    """requirement: --overwrite removes fretting files that the new run does not write."""
    folder = tmp_path / "results"
    quick = sets(*COARSE, *QUICK[FRETTING])
    assert run(fretting / "case.toml", folder, *quick) == 0
    (folder / "notes.txt").write_text("mine", encoding="utf-8")
    (folder / "friction.png").write_bytes(b"of an earlier run")
    (folder / "loads.png").write_bytes(b"of an earlier run")
    fewer = sets('analysis.output_times=["1.5 s"]')
    assert run(fretting / "case.toml", folder, *quick, *fewer, "--overwrite") == 0
    found = {path.name for path in folder.iterdir()}
    assert found == ALWAYS | {
        "notes.txt",
        "checkpoint.npz",
        "loads.csv",
        "cycles.csv",
        "friction.csv",
        "friction_1.5.csv",
        "interface_1.5.csv",
    }
    other = tmp_path / "punch.toml"
    other.write_text(starter_text(PUNCH), encoding="utf-8")
    assert run(other, folder, *sets(*COARSE), "--overwrite") == 0
    assert {path.name for path in folder.iterdir()} == ALWAYS | {"notes.txt"}


def test_too_large_a_load_is_one_line(tmp_path, capsys):
    """requirement: a contact that exceeds its body is reported with the key of the case."""
    file = tmp_path / "case.toml"
    file.write_text(starter_text(HERTZ), encoding="utf-8")
    words = sets(*COARSE, 'load={force="1 MN"}')
    assert run(file, tmp_path / "results", *words) == 1
    assert main(["mesh", str(file), *words, "-o", str(tmp_path / "mesh.msh")]) == 1
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 2
    for line in lines:
        assert line.startswith("error: geometry.radius: too small for the contact, which is")
        assert "up to 0.005 m" in line
    assert not (tmp_path / "mesh.msh").exists()
    assert not (tmp_path / "results").exists()  # the corrected case finds its place free


# ---- bodies that were meshed elsewhere ----

PLAIN = {
    PUNCH: {},
    STEADY: {"analysis": {"type": "initial"}},
    HERTZ: {"contact": {}, "load": {"force": "1.5 kN"}},
}
MESHED = ("mesh.degree=4", "mesh.elements=6")


def by_gmsh(path: Path) -> None:
    """Let gmsh read a mesh and write it again, as it writes its own."""
    with gmsh_model("again") as gmsh:
        gmsh.merge(str(path))
        gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
        gmsh.option.setNumber("Mesh.Binary", 1)
        gmsh.option.setNumber("Mesh.SaveAll", 0)
        gmsh.write(str(path))
        gmsh.option.setNumber("Mesh.Binary", 0)
    assert path.read_bytes().startswith(b"$MeshFormat\n4.1 1")


def file_geometry(case, path: Path) -> dict:
    """Keys that name the parts of a mesh that was written from another geometry."""
    geometry = case.geometry
    upper, lower = geometry.bodies
    keys = {
        "type": "file",
        "path": str(path),
        "bodies": {upper: upper, lower: lower},
        "contact": list(geometry.contact),
        "held": geometry.held,
        "fixed": geometry.fixed,
        "symmetry": list(geometry.symmetry),
        "surfaces": {name: name for name in geometry.surfaces},
    }
    if geometry.contact_area() is not None:
        keys["contact_area"] = f"{geometry.contact_area()!r} m^2"
    if geometry.thickness_factor is not None:
        keys |= {"thickness": f"{geometry.thickness!r} m", "half": geometry.half}
    return keys


@pytest.mark.parametrize(
    ("name", "ending", "allowed"),
    [
        (PUNCH, ".msh", 1e-9),
        pytest.param(PUNCH, ".inp", 1e-9, marks=pytest.mark.slow),
        (PUNCH, ".vtu", 1e-9),
        pytest.param(STEADY, ".msh", 1e-9, marks=pytest.mark.slow),
        (STEADY, ".inp", 1e-9),
        (HERTZ, ".msh", 1e-9),
        (HERTZ, ".inp", 1e-5),  # arcs of the third order are written as of the second
    ],
)
def test_a_mesh_from_a_file_gives_the_same_pressure(name, ending, allowed, tmp_path, capsys):
    """requirement: a mesh written by other programs gives the results of the geometry."""
    original, again = tmp_path / "original.toml", tmp_path / "again.toml"
    mesh = tmp_path / f"mesh{ending}"
    changes = PLAIN[name]
    original.write_text(tomli_w.dumps(starter.tables(name, changes)), encoding="utf-8")
    case = tw.load(original, MESHED)
    assert run(original, tmp_path / "one", *sets(*MESHED)) == 0
    assert main(["mesh", str(original), *sets(*MESHED), "-o", str(mesh)]) == 0
    if ending == ".msh":
        by_gmsh(mesh)
    keys = file_geometry(case, mesh)
    if ending == ".vtu":  # numbers for names
        numbers = {n: str(i) for i, n in enumerate((*keys["bodies"], *keys["surfaces"]), 1)}
        for table in ("bodies", "surfaces"):
            keys[table] = {name: numbers[name] for name in keys[table]}
    read = changes | {"geometry": keys, "mesh": {}}
    again.write_text(tomli_w.dumps(starter.tables(name, read)), encoding="utf-8")
    assert main(["validate", str(again)]) == 0
    assert run(again, tmp_path / "two", *sets(MESHED[0])) == 0
    one, two = (tables.read(tmp_path / f / "interface.csv") for f in ("one", "two"))
    np.testing.assert_allclose(two["x"], one["x"], rtol=0, atol=1e-3 * allowed)
    assert np.abs(two["pressure"] - one["pressure"]).max() < allowed * one["pressure"].max()
    first, second = summary_of(tmp_path / "one"), summary_of(tmp_path / "two")
    for key in ("normal_force_N", "approach_m", "contact_area_m2"):
        assert second[key] == pytest.approx(first[key], rel=1e-6 if allowed < 1e-6 else 3e-5)
    assert tw.load(tmp_path / "two" / "case.resolved.toml") == tw.load(again, MESHED[:1])
    assert capsys.readouterr().err == ""


def gmsh_punch(path: Path) -> None:
    """Bodies of the starter case in millimetres, meshed with gmsh as by a user."""
    with gmsh_model("punch") as gmsh:
        model, occ = gmsh.model, gmsh.model.occ
        punch = occ.addRectangle(-5, 0, 0, 10, 10)
        block = occ.addRectangle(-100, -100, 0, 200, 100)
        ends = [occ.addPoint(x, 0, 0) for x in (-5, 5)]
        face = occ.addLine(*ends)
        occ.fragment([(2, block)], [(1, face)])
        occ.synchronize()
        box = model.getEntitiesInBoundingBox
        lines = {
            "PUNCH_FACE": model.getBoundary([(2, punch)], oriented=False),
            "BLOCK_FACE": box(-5.1, -0.1, -1, 5.1, 0.1, 1, dim=1),
            "TOP": box(-6, 9.9, -1, 6, 10.1, 1, dim=1),
            "BOTTOM": box(-101, -101, -1, 101, -99, 1, dim=1),
        }
        flat = {tag for _, tag in lines["BLOCK_FACE"]}
        lines["PUNCH_FACE"] = [(1, t) for _, t in lines["PUNCH_FACE"] if t in flat]
        lines["BLOCK_FACE"] = [(1, t) for t in flat if (1, t) not in lines["PUNCH_FACE"]]
        for name, tag in (("PUNCH", punch), ("BLOCK", block)):
            model.addPhysicalGroup(2, [tag], name=name)
        for name, found in lines.items():
            model.addPhysicalGroup(1, [tag for _, tag in found], name=name)
        ball = model.mesh.field.add("Ball")
        for key, value in {"Radius": 7, "Thickness": 60, "VIn": 0.6, "VOut": 15}.items():
            model.mesh.field.setNumber(ball, key, value)
        model.mesh.field.setAsBackgroundMesh(ball)
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
        model.mesh.generate(2)
        gmsh.write(str(path))


@pytest.mark.slow
def test_triangles_of_gmsh_give_the_pressure_of_the_starter(tmp_path):
    """requirement: a user mesh of other cells and unit agrees away from the edges."""
    gmsh_punch(tmp_path / "own.msh")
    geometry = {
        "type": "file",
        "path": str(tmp_path / "own.msh"),
        "length_unit": "1 mm",
        "bodies": {"punch": "PUNCH", "block": "BLOCK"},
        "contact": ["PUNCH_FACE", "BLOCK_FACE"],
        "held": "TOP",
        "fixed": "BOTTOM",
        "contact_area": "10 mm^2",
    }
    file = tmp_path / "case.toml"
    file.write_text(
        tomli_w.dumps(starter.tables(PUNCH, {"geometry": geometry, "mesh": {}})), encoding="utf-8"
    )
    assert run(file, tmp_path / "own", *sets("mesh.degree=4")) == 0
    own = tables.read(tmp_path / "own" / "interface.csv")
    known = starter.solved(PUNCH, {}, "mesh.degree=6").interface
    x = np.linspace(-3.5e-3, 3.5e-3, 60)
    pressures = np.interp(x, own["x"], own["pressure"]), np.interp(x, known.x, known.pressure)
    assert pressures[0] == pytest.approx(pressures[1], rel=1e-2)
    assert summary_of(tmp_path / "own")["normal_force_N"] == pytest.approx(200.0, rel=1e-9)


WRONG = {
    "body": ({"bodies": {"punch": "PINCH", "block": "block"}}, "geometry.bodies.punch", "'PINCH'"),
    "face": ({"contact": ["face", "block_face"]}, "geometry.contact", "punch_face, punch_side"),
    "holder": ({"held": "top"}, "geometry.held", "block_bottom, block_face"),
    "support": ({"fixed": "punch_side"}, "geometry.fixed", "not on the boundary of body 'block'"),
    "surface": ({"surfaces": {"side": "SIDE"}}, "geometry.surfaces.side", "'SIDE'; one of: "),
    "no file": ({"path": "none.msh"}, "geometry.path", "none.msh cannot be read: No such file"),
    "folder": ({"path": "folder.msh"}, "geometry.path", "folder.msh cannot be read: Is a dir"),
    "no mesh": ({"path": "text.inp"}, "geometry.path", "begins with 'hello'; only meshes"),
    "ending": (
        {"path": "mesh.stl"},
        "geometry.path",
        "unknown file ending; must be one of: .msh, .inp",
    ),
}


@pytest.mark.parametrize(("keys", "path", "text"), WRONG.values(), ids=WRONG)
def test_what_is_not_in_the_file(keys, path, text, tmp_path, monkeypatch, capsys):
    """requirement: exit code 1 and one line with the key and the existing names."""
    monkeypatch.chdir(tmp_path)
    Path("punch.toml").write_text(starter_text(PUNCH), encoding="utf-8")
    Path("folder.msh").mkdir()
    Path("text.inp").write_text("hello\n", encoding="utf-8")
    assert main(["mesh", "punch.toml", *sets(*COARSE), "-o", "mesh.inp"]) == 0
    geometry = {
        "type": "file",
        "path": "mesh.inp",
        "bodies": {"punch": "punch", "block": "block"},
        "contact": ["punch_face", "block_face"],
        "held": "punch_top",
        "fixed": "block_bottom",
        "contact_area": "10 mm^2",
    }
    changes = {"geometry": geometry | keys, "mesh": {}}
    Path("case.toml").write_text(tomli_w.dumps(starter.tables(PUNCH, changes)), encoding="utf-8")
    capsys.readouterr()
    for words in (["mesh", "case.toml", "-o", "again.msh"], ["run", "case.toml", "--no-pictures"]):
        assert main([*words, *sets(COARSE[0])]) == 1
        (line,) = capsys.readouterr().err.splitlines()
        assert line.startswith(f"error: {path}: ")
        assert text in line
    assert not Path("again.msh").exists()


def test_history_rows_are_written_as_they_come(tmp_path):
    """requirement: history.csv of a plane running-in has the worn volume of Archard's law."""
    changes = {
        "motion": {"velocity": "1 m/s"},
        "contact": {"friction": 0.3},
        "wear": {"punch": {"coefficient": "1e-6 1/MPa"}},
        "analysis": {"type": "transient", "end_time": "1 s", "tolerance": 1e-2},
    }
    file = tmp_path / "case.toml"
    file.write_text(tomli_w.dumps(starter.tables(PUNCH, changes)), encoding="utf-8")
    assert run(file, tmp_path / "results", *sets(*COARSE)) == 0
    history = tables.read(tmp_path / "results" / "history.csv")
    np.testing.assert_allclose(
        history["wear_volume_1"], 6e-11 * history["sliding_distance"], rtol=1e-6, atol=1e-20
    )
    assert np.isnan(history["max_temperature"]).all()

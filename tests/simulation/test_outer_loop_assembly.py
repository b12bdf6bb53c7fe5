"""Running-in of several bodies whose meshes follow the worn faces."""

import tomllib
from dataclasses import replace

import gmsh
import numpy as np
import pytest
import tomli_w

from thermowear.app.cli import main
from thermowear.case import load
from thermowear.case.starters import starter_files, starter_text
from thermowear.simulation.analyses.run import run
from thermowear.simulation.from_case.analysis import analysis_of, model_of
from thermowear.simulation.geometry_update.moving_faces import in_place
from thermowear.simulation.geometry_update.outer_loop import thicknesses
from thermowear.verification.cases.assembly.pad_disk_pad import (
    FORCE,
    FRICTION,
    SPEED,
    at_contact,
)
from thermowear.verification.check import computed, starter

from ..app.test_resume import assert_the_same
from ..systems import built
from ..test_parallel import pytestmark as needs_mpirun
from ..test_parallel import same_on_two_ranks
from . import deep_brake
from .deep_brake import DISK, DURATION, PAD, worn
from .hot_ring import HEAT

NAMES = ("pressure", "wear_1", "wear_2", "x", "temperature_1", "temperature_2", "heat_flux_1")
INSIDE, OUTSIDE = 0.08, 0.13
SHORT = ("analysis.output_times=[]", "wear.update=0.01")


@pytest.fixture(scope="module", params=[False, True], ids=["cold", "in time"])
def half(request):
    """Whether temperatures are followed in time, and the model of one half."""
    return request.param, worn("half", transient=request.param)


@pytest.mark.parametrize("disk", ["clamped", "floating"])
def test_equal_pads_are_the_half_model(half, disk):
    """requirement: both halves of a deeply worn brake are the model of one half, to 1e-8."""
    transient, expected = half
    found = worn(disk, transient=transient)
    for name in ("geometry_updates", "steps"):
        assert found.summary[name] == expected.summary[name]
    assert expected.summary["geometry_updates"] >= 4
    kept = (each.summary["geometry_largest_kept"] for each in (found, expected))
    assert next(kept) == pytest.approx(next(kept), rel=1e-8)
    assert expected.interface.wear_1.min() > 0.12 * 0.015
    assert expected.interface.wear_2.min() > 0.1 * 0.006
    for contact in ("left", "right"):
        ours = at_contact(found, contact)
        if transient:
            heat = found.summary["contacts"][contact]
            into = heat["contact_heat_1_W"] + heat["contact_heat_2_W"]
            assert into == pytest.approx(heat["friction_power_W"], rel=2e-2)
        for name in NAMES:
            values = getattr(expected.interface, name)
            atol = 1e-8 * np.abs(values).max()
            np.testing.assert_allclose(
                getattr(ours, name), values, rtol=0.0, atol=atol, err_msg=f"{contact} {name}"
            )


@pytest.fixture(scope="module")
def floating():
    """Unequal pads, and a disk that floats between them and wears on both faces."""
    return worn("floating", 9.0, update=0.02)


def test_meshes_lose_what_is_worn_off(floating):
    """requirement: volumes of the meshes and of the wear, by body; those of Archard's law."""
    summary = floating.summary
    assert summary["geometry_updates"] >= 8
    assert summary["geometry_volume_error"] < 1e-9
    # steady pressures are proportional to 1/r: k mu F omega (a + b)/2 t, but for the running-in
    expected = FRICTION * FORCE * SPEED * (INSIDE + OUTSIDE) / 2 * DURATION
    for body, coefficient in (("left", PAD), ("right", PAD), ("disk", 2 * DISK)):
        found = summary["bodies"][body]
        lost = found["geometry_volume_m3"]
        assert lost == pytest.approx(found["wear_volume_m3"], rel=1e-6, abs=0.0)
        assert found["wear_volume_m3"] == pytest.approx(coefficient * expected, rel=1e-3)
    last = floating.contact_history[-2:]
    for row, name in zip(last, ("left", "right"), strict=True):
        of_contact = summary["contacts"][name]
        assert row.wear_volume_1 == pytest.approx(of_contact["wear_volume_1_m3"], rel=1e-12)
        assert row.wear_volume_1 + row.wear_volume_2 == pytest.approx(
            (PAD + DISK) * expected, rel=1e-3
        )
    whole = floating.history[-1]
    assert whole.wear_volume_1 == pytest.approx(2 * PAD * expected, rel=1e-3)
    assert whole.wear_volume_2 == pytest.approx(2 * DISK * expected, rel=1e-3)


def test_faces_of_the_meshes_are_where_they_were_worn_to(floating):
    """requirement: drawn places of the faces plus their wear; bodies stay in contact."""
    left, right = (at_contact(floating, name) for name in ("left", "right"))
    np.testing.assert_allclose(left.y, left.wear_1, atol=2e-7)
    np.testing.assert_allclose(right.y, -0.012 - right.wear_1, atol=2e-7)
    holders = floating.summary["holders"]
    depths = [np.mean(table.wear_1 + table.wear_2) for table in (left, right)]
    assert holders["hub"]["approach_m"] == pytest.approx(depths[1], rel=1e-2)
    assert holders["left"]["approach_m"] == pytest.approx(sum(depths), rel=1e-2)
    heights = {}
    for fields in floating.fields.blocks:
        for body in (1, 2, 3):
            own = fields.points[fields.body == body][..., 1]
            heights[body] = own.min(), own.max()
    assert heights[1][0] == pytest.approx(heights[2][1], abs=1e-5)
    assert heights[2][0] == pytest.approx(heights[3][1], abs=1e-5)


def test_the_end_is_that_of_bodies_drawn_so_thin(floating):
    """requirement: the worn shape in the end is the steady one of bodies of the worn heights."""
    bodies, area = floating.summary["bodies"], np.pi * (OUTSIDE**2 - INSIDE**2)
    tables = deep_brake.tables("floating", 9.0, update="never")
    drawn = computed(load(tables | {"analysis": {"type": "steady"}}))
    for name, layer in tables["geometry"]["layers"].items():
        height = float(layer["height"].removesuffix(" mm"))
        layer["height"] = f"{height - 1e3 * bodies[name]['geometry_volume_m3'] / area!r} mm"
    thin = computed(load(tables | {"analysis": {"type": "steady"}}))
    for contact in ("left", "right"):
        found, expected, before = (
            at_contact(each, contact).shape for each in (floating, thin, drawn)
        )
        change = np.abs(before - expected).max()
        assert change > 0.1 * expected.max()
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=0.05 * change)


def test_worn_faces_share_the_thickness_of_their_body():
    """requirement: each face of the disk has half of it, as in the half model."""
    for disk, contacts in (("half", 1), ("clamped", 2)):
        system = built(load(deep_brake.tables(disk)))
        for faces in thicknesses(system, in_place(system)):
            assert faces == pytest.approx({0: 0.015, 1: 0.006}, rel=1e-12)
        assert len(in_place(system)) == 2 * contacts


def test_small_wear_moves_nothing():
    """requirement: up to the allowed fraction the numbers are those without updates."""
    tables = deep_brake.tables("clamped", 9.0)
    tables["analysis"]["end_time"] = "500 s"
    found = [
        computed(load(tables | {"wear": tables["wear"] | {"update": update}})).summary
        for update in ("auto", "never")
    ]
    assert "geometry_updates" not in found[0]
    assert found[0] == found[1]


def test_thresholds():
    """requirement: the wear kept in the gap stays near the allowed fraction of the thickness."""
    updates = []
    for update in (0.04, 0.02):
        summary = worn("clamped", 9.0, update=update).summary
        assert 0.9 * update < summary["geometry_largest_kept"] < 2.1 * update
        updates.append(summary["geometry_updates"])
    assert updates[1] == pytest.approx(2 * updates[0], abs=3)


@pytest.mark.parametrize(
    "words",
    [
        ("annular-punch-running-in", "mesh.degree=4", 'analysis.end_time="1000 s"', *SHORT),
        pytest.param(("annular-punch", *HEAT), marks=pytest.mark.slow),
    ],
    ids=["cold", "in time"],
)
def test_a_pair_with_a_named_contact(words):
    """requirement: a model of two bodies with a named contact gives the numbers of the pair."""
    case = starter(*words, "mesh.elements=4")
    model, analysis = model_of(case), analysis_of(case)
    named = replace(
        model,
        interfaces=(replace(model.interface, name="a"),),
        holders=(replace(model.holder, name="a"),),
    )
    expected, found = run(model, analysis), run(named, analysis)
    assert expected.summary["geometry_updates"] >= 2
    for name in (*NAMES, "y", "gap", "shape"):
        ours, theirs = (getattr(each.interface, name) for each in (found, expected))
        np.testing.assert_allclose(ours, theirs, rtol=1e-12, atol=0.0, err_msg=name)
    volumes = [found.summary["bodies"][body.name]["geometry_volume_m3"] for body in model.bodies]
    pair = [expected.summary[f"geometry_volume_{body}_m3"] for body in (1, 2)]
    assert volumes == pytest.approx(pair, rel=1e-12, abs=0.0)


@pytest.mark.slow
def test_a_pair_written_with_tables_of_contacts(tmp_path):
    """requirement: the starter own-mesh as a case of several bodies gives the same numbers."""
    pair = tomllib.loads(starter_text("own-mesh"))
    mesh = tmp_path / "own-mesh.msh"
    mesh.write_bytes(starter_files("own-mesh")["own-mesh.msh"])
    pair["geometry"]["path"] = str(mesh)
    pair["wear"]["pad"]["coefficient"] = "2e-6 1/MPa"
    pair["wear"]["update"] = 0.005
    pair["analysis"] = {"type": "transient", "end_time": "200 s", "tolerance": 1e-3}
    geometry = {key: pair["geometry"][key] for key in ("type", "path", "length_unit", "bodies")}
    geometry["surfaces"] = {
        "pad": ["PAD_FACE", "PAD_BACK"],
        "plate": ["PLATE_FACE", "PLATE_BOTTOM"],
    }
    several = {key: pair[key] for key in ("model", "mesh", "contact", "wear", "analysis")} | {
        "geometry": geometry | {"thickness": "10 mm"},
        "bodies": pair["bodies"] | {"plate": pair["bodies"]["plate"] | {"fixed": "PLATE_BOTTOM"}},
        "contacts": {"a": {"between": ["PAD_FACE", "PLATE_FACE"]}},
        "holders": {"pad": {"surface": "PAD_BACK", "force": "3 kN"}},
        "motions": {"plate": {"velocity": "-0.5 m/s"}},
    }
    expected, found = computed(load(pair)), computed(load(several))
    assert expected.summary["geometry_updates"] >= 3
    assert found.summary["geometry_updates"] == expected.summary["geometry_updates"]
    for name in ("pressure", "wear_1", "x", "y"):
        ours, theirs = (getattr(each.interface, name) for each in (found, expected))
        atol = 1e-9 * np.abs(theirs).max()
        np.testing.assert_allclose(ours, theirs, rtol=0.0, atol=atol, err_msg=name)


def write_halves(path):
    """Write a mesh of two blocks side by side on a third one [mm]."""
    blocks = {"ONE": (0, 0, 10, 6), "TWO": (10, 0, 10, 6), "BASE": (-5, -8, 30, 8)}
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        sides = ("BOTTOM", "RIGHT", "TOP", "LEFT")
        for name, (x, y, width, height) in blocks.items():
            tag = gmsh.model.occ.addRectangle(x, y, 0, width, height)
            gmsh.model.occ.synchronize()
            gmsh.model.addPhysicalGroup(2, [tag], name=name)
            curves = [c for _, c in gmsh.model.getBoundary([(2, tag)], oriented=False)]
            for side, curve in zip(sides, curves, strict=True):
                gmsh.model.addPhysicalGroup(1, [curve], name=f"{name}_{side}")
        gmsh.option.setNumber("Mesh.MeshSizeMin", 2)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 2)
        gmsh.model.mesh.generate(2)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    return path


def test_a_worn_face_beside_a_joint_keeps_its_wear_in_the_gap(tmp_path, capsys):
    """requirement: glued faces stay joined: no mesh moves where one would take them along."""
    material = {"young_modulus": "1 GPa", "poisson_ratio": 0.3}
    tables = {
        "model": "plane-strain",
        "geometry": {
            "type": "file",
            "path": str(write_halves(tmp_path / "halves.msh")),
            "length_unit": "1 mm",
            "bodies": {"one": "ONE", "two": "TWO", "base": "BASE"},
            "surfaces": {
                "one": ["ONE_BOTTOM", "ONE_RIGHT", "ONE_TOP"],
                "two": ["TWO_LEFT", "TWO_BOTTOM"],
                "base": ["BASE_TOP", "BASE_BOTTOM"],
            },
        },
        "mesh": {"degree": 2},
        "bodies": {"one": material, "two": material, "base": material | {"fixed": "BASE_BOTTOM"}},
        "contact": {"friction": 0.1},
        "contacts": {
            "sliding": {"between": ["ONE_BOTTOM", "BASE_TOP"]},
            "joint": {"between": ["ONE_RIGHT", "TWO_LEFT"], "tie": True},
        },
        "holders": {"one": {"surface": "ONE_TOP", "force": "10 N"}},
        "motions": {"base": {"velocity": "1 m/s"}},
        "wear": {"one": {"coefficient": "1e-4 1/MPa", "per": "pressure"}},
        "analysis": {"type": "transient", "end_time": "10 s", "tolerance": 1e-3},
    }
    case, folder = tmp_path / "case.toml", tmp_path / "results"
    case.write_text(tomli_w.dumps(tables), encoding="utf-8")
    assert main(["run", str(case), "-o", str(folder), "--no-pictures"]) == 0
    said = capsys.readouterr()
    text = " ".join((said.out + said.err).split())
    assert "the worn face ONE_BOTTOM ends at the face ONE_RIGHT, which it would take along" in text
    assert "wear.update: at" in text
    assert "geometry_updates" not in (folder / "summary.json").read_text("utf-8")


@needs_mpirun
@pytest.mark.parametrize("kind", ["cold", pytest.param("in time", marks=pytest.mark.slow)])
def test_two_ranks(tmp_path, kind):
    """requirement: two ranks give the deep wear of the serial run, to 1e-8."""
    expected = deep_brake.columns(kind == "in time")
    same_on_two_ranks("tests.simulation.deep_brake", tmp_path, expected, kind)


def test_a_run_goes_on_from_its_checkpoint(tmp_path, capsys):
    """requirement: stopped and resumed after geometry updates: every table the same to 1e-12."""
    case = tmp_path / "brake.toml"
    case.write_text(tomli_w.dumps(deep_brake.short(transient=True)))
    arguments = ["run", str(case), "--no-pictures", "-o"]
    assert main([*arguments, str(tmp_path / "whole")]) == 0
    stopped = [*arguments, str(tmp_path / "stopped")]
    assert main([*stopped, "--set=analysis.max_steps=40"]) == 2
    assert '"geometry_updates": ' in (tmp_path / "stopped" / "summary.json").read_text("utf-8")
    assert main([*stopped, "--resume"]) == 0
    assert "resumed from" in capsys.readouterr().out
    assert_the_same(tmp_path / "stopped", tmp_path / "whole")

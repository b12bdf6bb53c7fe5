"""Designs of the steady state, and runs that start from them."""

import numpy as np
import pytest

import thermowear as tw
from thermowear.app.shaping import shape, steady_case
from thermowear.errors import CaseError
from thermowear.geometry.cad.design import write_table

from ..case.starter import STEADY, changed, solved, tables
from .space import BRAKE, PUNCH

COARSE = ("mesh.degree=5", "mesh.elements=8")
INITIAL = "analysis={type='initial'}"


def begun(file, design, source, *overrides):
    """Contact of faces one of which has the shape of a design."""
    write_table(design, file)
    return tw.run(tw.load(source, (*overrides, INITIAL, f"geometry.initial_shape={str(file)!r}")))


@pytest.mark.parametrize("body", ["punch", "plate"])
def test_either_face_takes_the_shape_of_both(tmp_path, body):
    """requirement: hot, from the design of either face, the steady pressure from the start."""
    steady = solved(STEADY, None, *COARSE)
    shaped = shape(tw.load(tables(), COARSE), body)
    design = shaped.design
    assert design.body == ("punch", "plate").index(body) + 1
    assert design.normals[:, 1] == pytest.approx(-1.0 if body == "punch" else 1.0)
    assert design.depth.min() == pytest.approx(0.0, abs=1e-9)
    assert design.shape == pytest.approx(steady.profile.shape, abs=1e-12)
    assert design.shape_along_press == pytest.approx(steady.profile.shape_along_press, abs=1e-12)
    first = begun(tmp_path / "d.csv", design, tables(), *COARSE)
    assert first.interface.pressure == pytest.approx(steady.interface.pressure, rel=2e-3)
    unworn = solved(STEADY, None, *COARSE, INITIAL)
    assert np.abs(unworn.interface.pressure / steady.interface.pressure - 1).max() > 0.5


def test_faces_that_do_not_match(tmp_path):
    """requirement: what the faces are apart as drawn is taken into account: a ball on a flat."""
    name, steady = "cylinder-on-block-growing", "analysis={type='steady'}"
    coarse = "mesh.degree=3", "mesh.elements=40"
    direct = solved(name, None, steady, *coarse)
    design = shape(tw.load(tables(name), (steady, *coarse))).design
    assert design.depth.min() == pytest.approx(0.0, abs=1e-12)
    first = begun(tmp_path / "d.csv", design, tables(name), *coarse)
    assert first.interface.pressure == pytest.approx(direct.interface.pressure, rel=1e-3)


def test_a_worn_profile_is_all_of_the_gap(tmp_path):
    """requirement: the profile of an earlier run counts the gap of the unworn faces once."""
    name, coarse = "cylinder-on-block-growing", ("mesh.degree=3", "mesh.elements=40")
    unworn = solved(name, None, *coarse, INITIAL)
    file = tmp_path / "profile.csv"
    table = np.column_stack([unworn.profile.s, unworn.profile.shape])
    np.savetxt(file, table, "%.17g", ",", header="s_m,shape_m", comments="")
    again = solved(name, None, *coarse, INITIAL, f"geometry.initial_shape={str(file)!r}")
    largest = unworn.interface.pressure.max()
    assert again.interface.pressure == pytest.approx(unworn.interface.pressure, abs=1e-3 * largest)


@pytest.mark.parametrize(
    ("source", "allowed"), [(PUNCH, 1e-6), pytest.param(BRAKE, 2e-2, marks=pytest.mark.slow)]
)
def test_in_space(tmp_path, source, allowed):
    """requirement: a face in space starts in the steady state as well."""
    steady = tw.run(tw.load(source)).interface.pressure
    first = begun(tmp_path / "d.csv", shape(tw.load(source)).design, source).interface.pressure
    assert first == pytest.approx(steady, rel=allowed)
    flat = tw.run(tw.load(source, (INITIAL,))).interface.pressure
    assert np.abs(flat / steady - 1).max() > 5 * allowed


def test_steady_whatever_the_analysis():
    """requirement: the steady state of the case, of faces as drawn, of lasting temperatures."""
    more = {
        "analysis": {"type": "transient", "end_time": "10 s", "tolerance": 1e-3},
        "heat.transient": True,
        "heat.initial": "100 degC",
        "bodies.punch.density": "7800 kg/m^3",
        "bodies.punch.specific_heat": "460 J/(kg K)",
        "geometry.initial_shape": "none.csv",
    }
    case = steady_case(tw.load(tables(STEADY, more), COARSE))
    assert case.analysis.type == "steady"
    assert case.geometry.initial_shape is None
    direct = shape(tw.load(tables(), COARSE)).design
    assert shape(case).design.depth == pytest.approx(direct.depth, abs=1e-12)


@pytest.mark.parametrize(
    ("source", "overrides", "text"),
    [
        (tables("beam-on-foundation"), (), "holder.free"),
        (tables("disk-brake-stop"), (), "motion.history"),
        (changed(tables(), {"wear": None}), (), "wear: missing"),
    ],
)
def test_no_steady_state(source, overrides, text):
    """requirement: one line a reason, before anything is computed."""
    with pytest.raises(CaseError, match=text):
        shape(tw.load(source, overrides) if "wear" in source else source)


@pytest.mark.parametrize(
    ("spoil", "text"),
    [
        (lambda t: t.replace("depth_m", "deep_m").replace("shape_m", "s"), "no columns s_m"),
        (lambda t: t.replace("normal_x", "normal"), "no column normal_x"),
        (lambda t: t.replace(",0,", ",nan,"), "not numbers"),
    ],
)
def test_spoiled_designs(tmp_path, spoil, text):
    """requirement: one line with the key, the file and what is wrong with it."""
    file = tmp_path / "d.csv"
    write_table(shape(tw.load(tables(), COARSE)).design, file)
    file.write_text(spoil(file.read_text()), encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        solved(STEADY, None, *COARSE, INITIAL, f"geometry.initial_shape={str(file)!r}")
    (line,) = caught.value.faults
    assert line.startswith(f"geometry.initial_shape: {file} ")
    assert text in line


def test_the_design_of_another_face(tmp_path):
    """requirement: a design is for the face that it was made for."""
    design = shape(tw.load(tables("block-on-disk"), ("mesh.degree=3", "mesh.elements=6"))).design
    with pytest.raises(CaseError, match="away from the contact face"):
        begun(tmp_path / "d.csv", design, tables(), *COARSE)


@pytest.mark.parametrize(
    ("source", "name"), [(PUNCH, "profile.csv"), (tables(), "part.step"), (tables(), "mesh.msh")]
)
def test_files_without_a_design(tmp_path, source, name):
    """requirement: a profile says nothing of a face in space, nor does a file of another origin."""
    file = tmp_path / name
    file.write_text("s_m,shape_m\n0,0\n1,0\n", encoding="utf-8")
    with pytest.raises(CaseError, match="carries no design"):
        tw.run(tw.load(source, (INITIAL, f"geometry.initial_shape={str(file)!r}")))

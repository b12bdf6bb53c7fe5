"""Designs of the faces of several contacts, initial shapes by contact, and sweeps of such cases."""

import json

import numpy as np
import pytest

import thermowear as tw
from thermowear.app.cli import main
from thermowear.app.shaping import shape, steady_case
from thermowear.errors import CaseError
from thermowear.geometry.cad.design import write_table
from thermowear.verification.check import computed, starter

NAME = "disk-brake-two-pads"
COARSE = ("mesh.elements=8", "mesh.degree=3")
INITIAL = "analysis={type='initial'}"
STEADY = "analysis={type='steady'}"
FACES = ["left_pad_bottom", "disk_top", "right_pad_top", "disk_bottom"]


def case(*overrides):
    return starter(NAME, *COARSE, *overrides)


def begun(*shapes):
    """Contact of unworn faces with initial shapes by contact."""
    return computed(case(INITIAL, *(f"contacts.{name}.initial_shape='{f}'" for name, f in shapes)))


def test_faces_of_both_contacts_begin_in_the_steady_state(tmp_path):
    """requirement: designs of a face of each contact, hot: the steady pressures from the start."""
    steady, files = computed(case(STEADY)), []
    for contact, face in (("left", "left_pad_bottom"), ("right", "disk_bottom")):
        shaped = shape(case(), face=face)
        files.append((contact, tmp_path / f"{contact}.csv"))
        assert shaped.design.depth.min() == pytest.approx(0.0, abs=1e-9)
        assert shaped.body.name in face
        write_table(shaped.design, files[-1][1])
    first, expected = begun(*files).interface.pressure, steady.interface.pressure
    assert first == pytest.approx(expected, rel=2e-3)
    for fewer in (files[:1], []):
        assert np.abs(begun(*fewer).interface.pressure / expected - 1).max() > 0.1


def test_the_case_of_a_design_has_faces_as_drawn(tmp_path):
    """requirement: initial shapes of a case, and its analysis, do not change its designs."""
    file = tmp_path / "left.csv"
    write_table(shape(case(), face=FACES[0]).design, file)
    shaped = case(f"contacts.left.initial_shape='{file}'", INITIAL)
    assert shaped.initial_shapes == [str(file)]
    assert steady_case(shaped).initial_shapes == []
    again = shape(shaped, face=FACES[0]).design.depth
    np.testing.assert_allclose(again, shape(case(), face=FACES[0]).design.depth, atol=1e-15)


@pytest.mark.parametrize(
    ("chosen", "text"),
    [
        ({}, f"--face {' | '.join(FACES)}"),
        ({"body": "disk"}, "--face disk_top | disk_bottom"),
        ({"body": "left_plate"}, "no body with a contact face; one of: left_pad, disk, right_pad"),
        ({"face": "left_plate_bottom"}, f"no contact face; one of: {', '.join(FACES)}"),
    ],
)
def test_the_face_must_be_clear(chosen, text):
    """requirement: a missing or ambiguous face is answered by the faces that there are."""
    with pytest.raises(CaseError) as caught:
        shape(case(), **chosen)
    assert text in str(caught.value)


def test_a_drum_keeps_no_shape():
    """requirement: the shape of a face that slides past does not stay in the contact."""
    with pytest.raises(CaseError, match="--face drum_left_shoe: slides past under"):
        shape(starter("two-shoe-drum", "mesh.elements=4"), face="drum_left_shoe")


def test_the_key_of_a_spoiled_shape(tmp_path, capsys):
    """requirement: one line with the key, from `validate` as well."""
    file, given = tmp_path / "nothing.csv", tmp_path / "case.toml"
    file.write_text("s_m,shape_m\n", encoding="utf-8")
    assert main(["init", NAME, "-o", str(given)]) == 0
    key = "contacts.left.initial_shape"
    assert main(["validate", str(given), "--set", f"{key}='{file}'"]) == 1
    assert capsys.readouterr().err.splitlines()[-1].startswith(f"error: {key}: {file} ")
    tied = "contacts.left_joint.initial_shape"
    assert main(["validate", str(given), "--set", f"{tied}='{file}'"]) == 1
    assert f"{tied}: not allowed together with tie" in capsys.readouterr().err


def test_a_sweep_of_several_bodies(tmp_path):
    """requirement: variants that share their factorisations are those computed alone."""
    forces = ["500 N", "1 kN"]
    found = tw.sweep(case(STEADY), {"holders.piston.force": forces})
    for (_, result), force in zip(found, forces, strict=True):
        alone = computed(case(STEADY, f"holders.piston.force={force!r}"))
        np.testing.assert_allclose(result.interface.pressure, alone.interface.pressure, rtol=1e-9)
        json.dumps(result.summary)

"""Steady states in which wear has unloaded one of several contacts."""

import math

import numpy as np
import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main
from thermowear.verification.cases.assembly.pad_disk_pad import FORCE, FRICTION, SPEED, Brake

from ..case.starter import changed

BRAKE = Brake("clamped", 9.0, heated=True, elements=4)
FIXED = {"surface": "right_bottom", "free": []}
GIVEN = {"surface": "right_bottom", "approach": "1 um"}
INNER, OUTER = 0.08, 0.13


def tables(**holders):
    """Tables of a brake whose left pad is pressed on a clamped disk."""
    return changed(BRAKE.tables("steady"), {f"holders.{k}": v for k, v in holders.items()})


@pytest.mark.parametrize("right", [FIXED, GIVEN], ids=["fixed", "approach"])
def test_wear_unloads_a_pad_that_does_not_follow(right):
    """requirement: nothing presses there, no heat passes, and the shape is not made up."""
    result = tw.run(tw.load(tables(right=right)))
    contacts, bodies = result.summary["contacts"], result.summary["bodies"]
    own, faces = result.contacts["right"], result.interface
    assert contacts["left"]["normal_force_N"] == pytest.approx(FORCE, rel=1e-12)
    assert not faces.pressure[own].any()
    assert np.isnan(faces.shape[own]).all()
    assert contacts["right"]["shape_range_m"] is None
    assert bodies["right"]["contact_heat_W"] == 0.0
    made = FRICTION * FORCE * SPEED * (INNER + OUTER) / 2  # uniform wear: p r is constant
    assert sum(one["contact_heat_W"] for one in bodies.values()) == pytest.approx(made, rel=1e-9)
    assert np.ptp(faces.shape[result.contacts["left"]]) > 0.0


def test_heat_through_the_open_gap():
    """requirement: h times the jump of the temperature at this contact, none at the pressed one."""
    h = 50.0
    case = changed(tables(right=FIXED), {"contacts.right.gap_conductance": f"{h} W/(m^2 K)"})
    result = tw.run(tw.load(case))
    own, at = result.contacts["right"], result.interface
    through = h * (at.temperature_2 - at.temperature_1)[own]
    np.testing.assert_allclose(at.heat_flux_1[own], through, rtol=1e-9)
    heat = result.summary["bodies"]["right"]["contact_heat_W"]
    assert heat == pytest.approx(at.weight[own] @ through, rel=1e-9)
    assert heat > 1.0


def test_all_of_a_force_borne_next_to_its_contact():
    """requirement: a reaction on the disk leaves nothing for the pad on its other side."""
    case = Brake("floating", 9.0, heated=True, elements=4).tables("steady")
    case["holders"]["left"]["reaction"] = "hub"
    result = tw.run(tw.load(case))
    assert result.summary["contacts"]["left"]["normal_force_N"] == pytest.approx(FORCE, rel=1e-12)
    assert result.summary["contacts"]["right"]["normal_force_N"] == 0.0
    assert result.summary["bodies"]["right"]["contact_heat_W"] == 0.0


def test_rates_of_holders_that_a_force_and_an_approach_press():
    """requirement: the rate of Archard's law for the pressed pad, zero for the given position."""
    holders = tw.run(tw.load(tables(right=GIVEN))).summary["holders"]
    p_times_r = FORCE / (2 * math.pi * (OUTER - INNER))
    rate = 1e-13 * FRICTION * p_times_r * SPEED
    found = {name: one["rigid_wear_velocity_m_per_s"] for name, one in holders.items()}
    assert found["left"] == pytest.approx(rate, rel=1e-9)
    assert found["right"] == 0.0


def test_a_holder_without_any_load():
    """requirement: a pad that floats beside the disk has no position; the message names it."""
    case = tables(right={"surface": "right_bottom", "force": "0 N"})
    with pytest.raises(tw.ComputationError, match=r"no steady position of the holders right \(z\)"):
        tw.run(tw.load(case))


def test_pictures_and_design(tmp_path, capsys, recwarn):
    """requirement: all pictures are made; a shape that does not follow is refused by its table."""
    file, folder = tmp_path / "case.toml", tmp_path / "results"
    file.write_text(tomli_w.dumps(tables(right=FIXED)), encoding="utf-8")
    assert main(["run", str(file), "-o", str(folder)]) == 0
    assert "nothing touches at the end in the contacts: right" in capsys.readouterr().out
    assert (folder / "interface_right.png").exists()
    assert not [one for one in recwarn if issubclass(one.category, RuntimeWarning)]
    arguments = ["shape", str(file), "-o", str(tmp_path / "shape.csv"), "--body", "right"]
    assert main(arguments) == 2
    assert "error: contacts.right: carries nothing" in capsys.readouterr().err

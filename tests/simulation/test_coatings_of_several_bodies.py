"""Coatings in models of several bodies."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
import tomli_w

from thermowear.app.cli import main
from thermowear.case import load
from thermowear.errors import CaseError
from thermowear.verification.cases.assembly.pad_disk_pad import Brake, at_contact
from thermowear.verification.check import computed

from ..app.test_resume import assert_the_same

HALF = Brake("half", heated=True, elements=4)
NAMES = ("pressure", "wear_1", "coating_left_1", "wear_rate_1")
AREA, SPEED, END = 1e-4, 0.1, 400.0
"""Area of flat faces [m²], sliding speed [m/s] and duration of their wear [s]."""
FORCES = {"a": 200.0, "b": 200.0, "c": 300.0, "d": 300.0}
"""Forces on the faces [N]."""
PAIRS = {"upper": "ab", "lower": "cd"}
"""Bodies of each contact."""
LAWS = {
    "a": ((3e-6,), (4e-14,), 1e-14),
    "b": ((5e-7,), (1e-14,), 2e-15),
    "c": ((1e-6, 2e-6), (2e-14, 9e-14), 3e-14),
    "d": ((), (), 5e-15),
}
"""Thicknesses of the layers, their coefficients and that of the substrate, by body [m, 1/Pa]."""


def coated(brake, body="left", **keys):
    """Tables of a brake with coated pads, worn through at different times along the radius."""
    tables = brake.tables("after running-in")
    layers = {"thickness": ["30 nm", "50 nm"], "coefficient": ["4e-8 1/MPa", "2e-7 1/MPa"]}
    pads = {pad: tables["wear"][pad] | {"layers": layers} for pad in tables["holders"]}
    return tables | {"wear": {"update": "never"} | pads} | keys


def worn(thickness, coefficients, substrate):
    """Table ``wear`` of a body."""
    table = {"coefficient": f"{substrate} 1/Pa", "per": "pressure"}
    if not thickness:
        return table
    layers = {
        "thickness": [f"{h} m" for h in thickness],
        "coefficient": [f"{k} 1/Pa" for k in coefficients],
    }
    return table | {"layers": layers}


def blocks(**keys):
    """Two pairs of flat blocks, a on b and c on d, in one model."""
    solid = {"young_modulus": "1 GPa", "poisson_ratio": 0.0}
    return {
        "model": "plane-strain",
        "geometry": {
            "type": "stack",
            "thickness": "10 mm",
            "layers": {name: {"x": ["0 mm", "10 mm"], "height": "5 mm"} for name in LAWS},
        },
        "mesh": {"degree": 2, "elements": 3},
        "bodies": {name: dict(solid) for name in "ac"}
        | {name: solid | {"fixed": f"{name}_bottom"} for name in "bd"},
        "contacts": {
            "upper": {"between": ["a_bottom", "b_top"]},
            "lower": {"between": ["c_bottom", "d_top"]},
        },
        "holders": {
            name: {"surface": f"{name}_top", "force": f"{FORCES[name]} N"} for name in "ac"
        },
        "motions": {name: {"velocity": f"{SPEED} m/s", "across": True} for name in "bd"},
        "wear": {"update": "never"} | {name: worn(*law) for name, law in LAWS.items()},
        "analysis": {"type": "transient", "end_time": f"{END} s"},
    } | keys


PUNCHES = {"a": ((5e-7,), (2e-14,), 6e-14), "c": ((1.4e-7, 3e-7), (3e-14, 1e-14), 5e-14)}


def punches():
    """Two coated punches on blocks that are not coated."""
    punch, base = ({"x": [f"{-x} mm", f"{x} mm"], "height": "5 mm"} for x in (5, 8))
    tables = blocks(wear={"update": "never"} | {name: worn(*law) for name, law in PUNCHES.items()})
    tables["geometry"]["layers"] = {"a": punch, "b": base, "c": punch, "d": base}
    tables["mesh"]["elements"] = 8
    tables["analysis"]["end_time"] = "90 s"
    return tables


def exact(body, time):
    """Depths worn of the layers and of the substrate of a flat face, time of losing the layers."""
    thickness, coefficients, substrate = LAWS[body]
    depths, lost, pv = [], 0.0, FORCES[body] / AREA * SPEED
    for h, k in zip(thickness, coefficients, strict=True):
        depths.append(min(h, max(time - lost, 0.0) * k * pv))
        lost += h / (k * pv)
    return [*depths, max(time - lost, 0.0) * substrate * pv], lost


def test_equal_pads_are_the_half_model():
    """
    requirement: both coated halves of a hot brake are the coated half, to 1e-9, with the layers
    worn through at a part of the faces.
    """
    brakes = HALF, replace(HALF, disk="clamped")
    expected, found = (computed(load(coated(brake))) for brake in brakes)
    left = expected.interface.coating_left_1
    assert 0.0 == left.min() < left.max()  # worn through at a part of the face
    theirs = expected.summary["contacts"]["left"]
    for contact in ("left", "right"):
        fields, ours = at_contact(found, contact), found.summary["contacts"][contact]
        for column in NAMES:
            exact = getattr(expected.interface, column)
            atol = 1e-9 * np.abs(exact).max()
            np.testing.assert_allclose(getattr(fields, column), exact, rtol=0.0, atol=atol)
        assert np.isnan(fields.coating_left_2).all()
        for key in ("worn_through_time_1_s", "worn_through_distance_1_m", "layer_volumes_1_m3"):
            assert ours[key] == pytest.approx(theirs[key], rel=1e-8, abs=0.0), key
        volumes = ours["layer_volumes_1_m3"]
        assert sum(volumes) == pytest.approx(ours["wear_volume_1_m3"], rel=1e-12, abs=0.0)
        assert all(volume > 0.0 for volume in volumes)


def test_borders_of_layers_on_two_faces():
    """
    requirement: while borders travel over the faces of two different pairs, Σ V_i/k_i = F s holds
    for each of them, and the pressure has a jump at each border only.
    """
    result = computed(load(punches()))
    for contact, (body, (_, coefficients, substrate)) in zip(
        result.contacts, PUNCHES.items(), strict=True
    ):
        fields, summary = at_contact(result, contact), result.summary["contacts"][contact]
        left = fields.coating_left_1
        assert 0.0 == left.min() < left.max()  # worn through at a part of the face
        volumes = np.array(summary["layer_volumes_1_m3"])
        dose = volumes @ (1 / np.array([*coefficients, substrate]))
        assert dose == pytest.approx(FORCES[body] * SPEED * 90.0, rel=1e-9)
        bare = (left == 0.0) & (fields.weight > 0.0)
        rate = substrate * SPEED * fields.pressure[bare]
        np.testing.assert_allclose(fields.wear_rate_1[bare], rate, rtol=1e-9)


def test_flat_faces_lose_their_layers_one_by_one():
    """
    requirement: t = Σ h/(k p v) for each face of either contact; the depths have exact kinks.
    """
    result = computed(load(blocks()))
    for contact, bodies in PAIRS.items():
        fields, summary = at_contact(result, contact), result.summary["contacts"][contact]
        for side, body in enumerate(bodies, 1):
            depths, lost = exact(body, END)
            total = np.full(len(fields.x), sum(depths))
            np.testing.assert_allclose(getattr(fields, f"wear_{side}"), total, rtol=1e-9)
            if not LAWS[body][0]:
                assert f"layer_volumes_{side}_m3" not in summary
                assert f"worn_through_time_{side}_s" not in summary
                continue
            volumes = summary[f"layer_volumes_{side}_m3"]
            assert volumes == pytest.approx(AREA * np.array(depths), rel=1e-9, abs=0.0)
            assert summary[f"worn_through_time_{side}_s"] == pytest.approx(lost, rel=1e-9)
            slid = summary[f"worn_through_distance_{side}_m"]
            assert slid == pytest.approx(lost * SPEED, rel=1e-9)


def test_layers_that_are_left():
    """
    requirement: thicknesses left before layers are lost; no time where they are not.
    """
    analysis = {"type": "transient", "end_time": "245 s"}
    result = computed(load(blocks(analysis=analysis)))
    for contact, bodies in PAIRS.items():
        fields, summary = at_contact(result, contact), result.summary["contacts"][contact]
        for side, body in enumerate(bodies, 1):
            left = getattr(fields, f"coating_left_{side}")
            depths, lost = exact(body, 245.0)
            if not LAWS[body][0]:
                assert np.isnan(left).all()
                continue
            expected = sum(LAWS[body][0]) - sum(depths[:-1])
            np.testing.assert_allclose(left, expected, rtol=1e-8, atol=1e-20)
            time = summary[f"worn_through_time_{side}_s"]
            assert time is None if lost > 245.0 else time == pytest.approx(lost, rel=1e-9)


def test_the_steady_state_is_that_of_the_substrates():
    """
    requirement: pressures and rates of the steady state are those without layers, with a note.
    """
    tables = blocks(analysis={"type": "steady"})
    bare = {name: worn((), (), law[2]) for name, law in LAWS.items()}
    found = computed(load(tables)).interface
    expected = computed(load(tables | {"wear": {"update": "never"} | bare})).interface
    for name in ("pressure", "wear_rate_1", "wear_rate_2"):
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), rtol=1e-12)


def test_a_run_goes_on_from_its_checkpoint(tmp_path, capsys):
    """
    requirement: stopped after one coating is lost and resumed: every table the same to 1e-12; the
    pictures of the coatings are by contact.
    """
    case = tmp_path / "punches.toml"
    case.write_text(tomli_w.dumps(punches()))
    arguments = ["run", str(case), "-o"]
    assert main([*arguments, str(tmp_path / "whole")]) == 0
    stopped = [*arguments, str(tmp_path / "stopped")]
    assert main([*stopped, "--set=analysis.max_steps=5"]) == 2
    stands = float(re.search(r"stands at (\S+) s", capsys.readouterr().err)[1])
    assert main([*stopped, "--resume"]) == 0
    assert "resumed from" in capsys.readouterr().out
    assert_the_same(tmp_path / "stopped", tmp_path / "whole")
    whole = json.loads((tmp_path / "whole" / "summary.json").read_text())["contacts"]
    again = json.loads((tmp_path / "stopped" / "summary.json").read_text())["contacts"]
    times = [again[name]["worn_through_time_1_s"] for name in PAIRS]
    assert min(times) < stands < max(times)  # one coating was lost, the other was not
    for name in PAIRS:
        for key in ("worn_through_time_1_s", "worn_through_distance_1_m", "layer_volumes_1_m3"):
            assert again[name][key] == pytest.approx(whole[name][key], rel=1e-12, abs=0.0)
        assert (tmp_path / "whole" / f"coating_{name}.png").exists()


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        (
            {"layers": {"thickness": ["1 um"], "rate": ["1e-9/MPa*p*v*T/(1 K)"]}},
            "wear.a.layers.rate.0: depends on T",
        ),
        (
            {"layers": {"thickness": ["1 um"], "coefficient": ["1e-9 1/MPa"],
                        "per": ["friction-stress"]}},
            "contacts.upper.friction: is 0; layer 0 of wear.a.layers is per friction stress",
        ),
    ],
)  # fmt: skip
def test_refused(keys, message):
    """
    requirement: laws without what they depend on are refused in one line with the path of the key.
    """
    with pytest.raises(CaseError) as error:
        load(blocks(wear={"a": worn((), (), 1e-14) | keys}))
    assert str(error.value).startswith(message)

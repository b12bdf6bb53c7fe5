"""Defaults that are often not what is meant are noted."""

import warnings

import numpy as np
import pytest

import thermowear as tw
from thermowear.errors import CaseNote

from ..geometry.plain import NAMES, blocks, msh
from .starter import STEADY, tables

COOLED = {"PUNCH_TOP": "500 W/(m^2 K)", "PLATE_BOTTOM": "500 W/(m^2 K)"}
TRACK = {"track": "0.5 m"}
STORING = {"density": "7800 kg/m^3", "specific_heat": "500 J/(kg K)"}


def strip(folder, geometry=(), heat=(), **more):
    """Case of a punch on a strip from a mesh file."""
    (folder / "blocks.msh").write_text(msh(blocks((8, 12), (4, 4))), encoding="utf-8")
    case = tables(STEADY)
    punch = case["bodies"]["punch"] | STORING
    return (
        case
        | {
            "model": "plane-strain",
            "geometry": {"type": "file", "path": str(folder / "blocks.msh")}
            | NAMES
            | dict(geometry),
            "bodies": {"punch": punch, "plate": {"like": "punch"}},
            "heat": {"ambient": "20 degC", "cooling": COOLED} | dict(heat),
            "mesh": {"degree": 3},
            "load": {"force": "2 kN"},
            "motion": {"velocity": "5 mm/s"},
        }
        | more
    )


def notes(case):
    """Case that is loaded, and the notes on it."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", CaseNote)
        loaded = tw.load(case)
    return loaded, " ".join(str(one.message) for one in caught)


def test_a_thickness_that_forces_act_on(tmp_path):
    """requirement: 1 mm is noted; not if it is given, or the load is a pressure."""
    left_out = "geometry.thickness is left out"
    assert left_out in notes(strip(tmp_path))[1]
    assert left_out not in notes(strip(tmp_path, {"thickness": "1 mm"}))[1]
    area = {"contact_area": "40 mm^2"}
    assert left_out not in notes(strip(tmp_path, area, load={"mean_pressure": "1 MPa"}))[1]


@pytest.mark.parametrize(
    ("geometry", "heat", "said"),
    [
        ({}, {}, "give geometry.track"),
        (TRACK, {}, "carries the heat along"),
        ({}, {"advection": "none"}, ""),
        (TRACK, {"advection": "resolved"}, ""),
    ],
)
def test_conduction_as_if_at_rest(geometry, heat, said, tmp_path):
    """requirement: a moving body that conducts heat only is noted, unless the case says so."""
    found = notes(strip(tmp_path, geometry, heat))[1]
    assert ("heat.advection is left out: plate conducts" in found) is bool(said)
    assert said in found


@pytest.mark.parametrize(
    ("geometry", "more", "message"),
    [
        ({}, {"heat": {"advection": "resolved"}}, r"heat\.advection: plate passes .* geometry\.tr"),
        ({}, {"spread": "track"}, r"wear\.plate\.spread: plate passes .* geometry\.track"),
        ({"half": True, "symmetry": ["AXES"]} | TRACK, {}, r"geometry\.track: requires a plane"),
        (TRACK, {"model": "axisymmetric"}, r"geometry\.track: requires a plane"),
    ],
)
def test_a_strip_needs_the_length_of_its_track(geometry, more, message, tmp_path):
    """requirement: the message names the key."""
    more = dict(more)
    case = strip(tmp_path, geometry, more.pop("heat", {}))
    if "spread" in more:
        wear = case["wear"]["punch"]
        case["wear"] = {"punch": wear, "plate": wear | {"spread": more.pop("spread")}}
    with pytest.raises(tw.CaseError, match=message):
        tw.load(case | more)


def test_heat_carried_along_as_by_several_bodies(tmp_path):
    """requirement: the same temperature as in the form with motions."""
    held = {"type": "file", "path": str(tmp_path / "blocks.msh"), "bodies": NAMES["bodies"]}
    case = strip(tmp_path, TRACK, {"advection": "resolved"})
    ahead = tw.run(tw.load(case))
    back = tw.run(tw.load(case | {"motion": {"velocity": "-5 mm/s"}}))
    rise = ahead.interface.temperature_2
    assert back.interface.temperature_2[::-1] == pytest.approx(rise, rel=1e-9)
    along = np.corrcoef(ahead.interface.x, rise)[0, 1]  # the plate moves along -x under the punch
    assert along < -0.5
    pair = ahead.summary["max_temperature_K"]
    for key in ("geometry", "load", "motion"):
        case.pop(key)
    surfaces = {
        "punch": {"PUNCH_FACE": "PUNCH_FACE", "PUNCH_TOP": "PUNCH_TOP"},
        "plate": {"PLATE_FACE": "PLATE_FACE", "PLATE_BOTTOM": "PLATE_BOTTOM"},
    }
    case["geometry"] = held | {"surfaces": surfaces}
    case["bodies"]["plate"]["fixed"] = "PLATE_BOTTOM"
    case |= {
        "contacts": {"rub": {"between": ["PUNCH_FACE", "PLATE_FACE"]}},
        "holders": {"ram": {"surface": "PUNCH_TOP", "force": "2 kN"}},
        "motions": {"plate": {"velocity": "-5 mm/s"}},
    }
    several = tw.run(tw.load(case)).summary["max_temperature_K"]
    assert pair == pytest.approx(several, rel=1e-9)
    still = tw.run(tw.load(strip(tmp_path, {}, {"advection": "none"}))).summary
    assert pair < still["max_temperature_K"] - 1.0


def test_wear_spread_along_the_track(tmp_path):
    """requirement: a strip of 20 times the length of the punch wears a twentieth as fast."""
    case = strip(tmp_path, {"track": "0.8 m"}, {"advection": "none"})
    wear = case["wear"]["punch"]
    rates = []
    for spread in ("in-place", "track"):
        case["wear"] = {"punch": wear, "plate": wear | {"spread": spread}}
        interface = tw.run(tw.load(case)).interface
        rates.append(interface.wear_rate_2 / interface.wear_rate_1)
    assert rates[1] == pytest.approx(rates[0] / 20, rel=1e-6)

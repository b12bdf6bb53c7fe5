"""Sides of a contact: they follow its faces as they are named, whichever body moves."""

import re
from contextlib import nullcontext
from dataclasses import replace

from mpi4py import MPI

import numpy as np
import pytest

import thermowear as tw
from thermowear.simulation.analyses.run import run
from thermowear.simulation.from_case import analysis_of, model_of
from thermowear.simulation.system.building import build
from thermowear.simulation.system.thermal_system import _passage
from thermowear.timer import Phases

from ..case.starter import RECIPROCATING, RUNNING_IN, tables
from .test_meshing_anew import COLD, slanted
from .test_without_holder import STEEL, write_sections

SHOES, TURNED, COATED = "two-shoe-drum", "block-on-ring", "shaft-in-bush-coated"
FRETTED = ("mesh.elements=16", "wear.cycles=300", "analysis.output_times=[]")


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """A pad that slides on a plate: results by the body that moves."""
    path = tmp_path_factory.mktemp("pad") / "pad.msh"
    write_sections(path, {"PAD": (0.0, 8.0, 0.0, 6.0), "PLATE": (-4.0, 12.0, -8.0, 0.0)})
    given = {
        "model": "plane-strain",
        "geometry": {
            "type": "file",
            "path": str(path),
            "length_unit": "1 mm",
            "thickness": "10 mm",
            "bodies": {"pad": "PAD", "plate": "PLATE"},
            "surfaces": {"pad": ["PAD_TOP", "PAD_BOTTOM"], "plate": ["PLATE_TOP", "PLATE_BOTTOM"]},
        },
        "mesh": {"degree": 2},
        "bodies": {"pad": STEEL, "plate": STEEL | {"fixed": "PLATE_BOTTOM"}},
        "contact": {"friction": 0.3},
        "contacts": {"rubbing": {"between": ["PAD_BOTTOM", "PLATE_TOP"]}},
        "holders": {"arm": {"surface": "PAD_TOP", "force": "1 kN"}},
        "wear": {"pad": {"coefficient": "1e-8 1/MPa", "per": "pressure"}},
        "analysis": {"type": "initial"},
    }
    moving = {"pad": "0.5 m/s", "plate": "-0.5 m/s"}
    return [
        tw.run(tw.load(given | {"motions": {body: {"velocity": speed}}}))
        for body, speed in moving.items()
    ]


def test_the_numbers_are_those_of_the_relative_motion(results):
    """requirement: which body moves changes nothing."""
    one, other = results
    for name in ("pressure", "wear_rate_1", "wear_rate_2"):
        found, known = getattr(one.interface, name), getattr(other.interface, name)
        np.testing.assert_allclose(found, known, rtol=1e-12, atol=0.0)


def test_the_pad_is_body_1(results):
    """requirement: it is named first, so that its wear is that of body 1; ``k p v``."""
    for result in results:
        assert result.summary["contacts"]["rubbing"]["between"] == ["pad", "plate"]
        p = result.interface.pressure
        np.testing.assert_allclose(result.interface.wear_rate_1, 1e-14 * p * 0.5, rtol=1e-12)
        assert not result.interface.wear_rate_2.any()


def test_forces_of_a_flat_contact(results):
    """requirement: normal and contact force are the load, friction mu times the latter."""
    for found in (result.summary["contacts"]["rubbing"] for result in results):
        forces = [found[f"{key}_force_N"] for key in ("normal", "contact", "friction")]
        np.testing.assert_allclose(forces, [1e3, 1e3, 300.0], rtol=1e-9)


def named(case, exchanged):
    """Model of a pair as an assembly, with the faces of its contact in either order."""
    model, settings = model_of(case), analysis_of(case)
    one, motion = model.interface, model.interface.motion
    if settings.type == "reciprocating":
        motion = replace(motion, velocity=4 * settings.amplitude * settings.frequency)
    one = replace(one, name="only", motion=motion)
    if exchanged:
        one = replace(
            one,
            bodies=(1, 0),
            faces=one.faces[::-1],
            wear={1 - side: wear for side, wear in one.wear.items()},
            partition=1 - one.partition,
            motion=replace(motion.faster(-1.0), moving_side=1 - motion.moving_side),
        )
    return replace(model, interfaces=(one,), holders=(replace(model.holder, name="arm"),))


@pytest.mark.parametrize(
    ("starter", "overrides", "found", "counts"),
    [
        (RUNNING_IN, (*COLD, "analysis.end_time=1000 s"), ["interface"], (3, 1)),
        (TURNED, ("mesh.degree=2", "mesh.elements=12"), ["interface"], (1, 0)),
        (COATED, ("mesh.degree=2", "mesh.elements=6"), ["interface"], (0, 0)),
        (RECIPROCATING, ("mesh.degree=2", "analysis.cycles=200"), ["interface", "track"], (0, 0)),
        ("cylinder-fretting", FRETTED, ["interface", "friction"], (0, 0)),
    ],
)
def test_either_face_first(starter, overrides, found, counts):
    """
    requirement: the same numbers to 1e-12 with the labels of the bodies exchanged, after
    updates of the geometry and a new mesh, with coatings, and for repeated motions.
    """
    case, results = tw.load(tables(starter), overrides), []
    for exchanged in (False, True):
        with slanted(2) if counts[1] else nullcontext():
            results.append(run(named(case, exchanged), analysis_of(case)))
    for name, least in zip(("updates", "meshed_anew"), counts, strict=True):
        both = [result.summary.get(f"geometry_{name}", 0) for result in results]
        assert both[0] == both[1] >= least
    for table in found:
        known, other = (result.columns(f"{table}_only") for result in results)
        on_body_1 = () if table == "track" else ("x_m", "y_m", "z_m", "s_m")
        for name in known.keys() - on_body_1:
            values = other[re.sub("_([12])", lambda side: f"_{3 - int(side[1])}", name)]
            values = -values if name in ("shear_Pa", "slip_m") else values  # of body 1 along x
            allowed = 1e-12 * np.nanmax(np.abs(known[name]))
            np.testing.assert_allclose(values, known[name], 0.0, allowed, err_msg=name)


def test_heat_is_carried_by_the_drum():
    """requirement: also where it is named first."""
    spread = {"heat.advection": "spread"}
    model = model_of(tw.load(tables(SHOES, spread)))
    contacts = {one.name: {"between": list(one.faces[::-1])} for one in model.interfaces}
    other = model_of(tw.load(tables(SHOES, spread | {"contacts": contacts})))
    assert model.heat is not None
    assert [one.faces for one in other.interfaces] == [one.faces[::-1] for one in model.interfaces]
    contacts = build(model, MPI.COMM_WORLD, Phases()).contacts
    carried = _passage(model, model.heat, contacts)
    assert carried is not None
    assert _passage(other, model.heat, contacts) == carried

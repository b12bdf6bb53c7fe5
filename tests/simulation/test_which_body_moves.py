"""Sides of a contact: they follow its faces as they are named, whichever body moves."""

from mpi4py import MPI

import numpy as np
import pytest

import thermowear as tw
from thermowear.simulation.from_case import model_of
from thermowear.simulation.system.building import build
from thermowear.simulation.system.thermal_system import _passage
from thermowear.timer import Phases

from ..case.starter import tables
from .test_without_holder import STEEL, write_sections

SHOES = "two-shoe-drum"


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

"""Element ends at the edges of the contact: ``contact.positioning``."""

import itertools

import numpy as np
import pytest

import thermowear as tw
from thermowear.reference.elastic_contact.hertz import contact_modulus, line_contact
from thermowear.simulation.analyses.positioning import touching

from ..case.starter import GONE, HERTZ, PUNCH, SPHERE, STEADY, solved, tables
from ..systems import prepared

ROUNDED = {"geometry.edge_radius": "1 mm", "load": {"mean_pressure": "5 MPa"}}
SLIDING = {"motion": {"velocity": "1 m/s"}}
THICK = {"geometry.block_height": "200 mm", "geometry.block_width": "400 mm"}


def positioned(name, changes, *overrides):
    """System of a case, its element ends along x, its smallest element, and where it touches."""
    on = ("contact.positioning=true", *overrides)
    system = prepared(tw.load(tables(name, changes), on))
    nodes = system.pairing.sides[0].face.nodes
    sizes = np.linalg.norm(nodes[:, -1] - nodes[:, 0], axis=1)
    return system, nodes[:, [0, -1], 0].ravel(), sizes.min(), touching(system)


CASES = {
    "half a cylinder": (HERTZ, {}),
    "a cylinder": (HERTZ, {"geometry.half": False}),
    "a cylinder narrower than expected": (HERTZ, THICK),
    "by penalty": (HERTZ, {"contact": {"method": "penalty"}}),
    "by Nitsche": (HERTZ, {"contact": {"method": "nitsche"}}),
    "a sphere": (SPHERE, {}),
    "a rounded punch": (PUNCH, ROUNDED),
    "half a rounded punch": (PUNCH, ROUNDED | {"geometry.half": True}),
    "a rounded punch by approach": (PUNCH, ROUNDED | {"load": {"approach": "20 um"}}),
}


@pytest.mark.parametrize("degree", [4, pytest.param(6, marks=pytest.mark.slow)])
@pytest.mark.parametrize(("name", "changes"), CASES.values(), ids=CASES)
def test_element_ends_lie_at_the_edges(name, changes, degree):
    """requirement: within a tenth of the smallest element, on both sides where there are two."""
    settings = (f"mesh.degree={degree}", "mesh.elements=8")
    system, ends, smallest, zone = positioned(name, changes, *settings)
    half = bool(system.model.symmetry) or name == SPHERE
    for edge in zone[1:] if half else zone:
        assert 0 < abs(edge) < 0.9 * np.abs(ends).max()
        assert np.abs(ends - edge).min() <= 0.1 * smallest
    if not half:
        assert zone[0] == pytest.approx(-zone[1], rel=1e-3)


@pytest.mark.parametrize("way", [1, -1])
def test_friction_moves_the_contact_and_the_mesh_follows(way):
    """requirement: a contact that is not centred gets element ends at both of its edges."""
    changes = {
        "geometry.half": False,
        "motion": {"velocity": f"{way} m/s"},
        "contact": {"friction": 0.3},
    }
    _, ends, smallest, zone = positioned(HERTZ, changes, "mesh.degree=4", "mesh.elements=8")
    for edge in zone:
        assert np.abs(ends - edge).min() <= 0.1 * smallest
    width = zone[1] - zone[0]
    assert 0.005 * width < -way * sum(zone) / 2 < 0.015 * width  # it trails
    assert smallest < 0.05 * width


@pytest.fixture(scope="module")
def best():
    """A contact that is narrower than expected, on a fine mesh."""
    return solved(HERTZ, THICK, "mesh.degree=8", "mesh.elements=20")


@pytest.mark.parametrize("degree", [4, pytest.param(6, marks=pytest.mark.slow)])
def test_positioning_is_worth_it(degree, best):
    """requirement: where the contact is not as expected, the error of the pressure falls."""
    x = best.interface.x
    errors = {}
    for on in ("false", "true"):
        settings = (f"mesh.degree={degree}", "mesh.elements=8", f"contact.positioning={on}")
        result = solved(HERTZ, THICK, *settings)
        pressure = np.interp(x, result.interface.x, result.interface.pressure)
        peak = result.summary["max_pressure_Pa"] / best.summary["max_pressure_Pa"] - 1
        missed = best.interface.weight @ np.abs(pressure - best.interface.pressure)
        errors[on] = abs(peak), missed / best.summary["normal_force_N"]
    assert errors["true"][0] < errors["false"][0] / 4
    assert errors["true"][1] < errors["false"][1] / 2.5


def test_a_flat_face_that_touches_everywhere_is_left_as_it_is():
    """requirement: positioning does no harm where there is nothing to do."""
    settings = ("mesh.degree=3", "mesh.elements=8")
    off, on = (
        solved(PUNCH, {}, *settings, f"contact.positioning={value}") for value in ("false", "true")
    )
    np.testing.assert_array_equal(off.interface.pressure, on.interface.pressure)


def test_a_face_that_heat_parts():
    """requirement: a hot ring lifts off outside; an element ends where it does."""
    changes = {"analysis": {"type": "initial"}, "wear": GONE}
    _, ends, smallest, zone = positioned(STEADY, changes, "mesh.degree=4", "mesh.elements=8")
    assert zone[0] == pytest.approx(0.02)
    assert 0.08 < zone[1] < 0.11
    assert np.abs(ends - zone[1]).min() <= 0.1 * smallest


def test_edges_settle_or_it_is_said():
    """requirement: edges that do not settle end with advice, never with a wrong mesh."""
    case = tw.load(tables(HERTZ), ("mesh.degree=2", "mesh.elements=8"))
    try:
        system = prepared(case)
    except tw.ComputationError as error:
        assert "contact.positioning" in str(error)
    else:
        nodes = system.pairing.sides[0].face.nodes
        sizes = np.linalg.norm(nodes[:, -1] - nodes[:, 0], axis=1)
        assert np.abs(nodes[..., 0] - touching(system)[1]).min() <= 0.1 * sizes.min()


# ---- Hertz's line contact ----

CONVERGED = 1.00057897
"""Peak over ``√(F E*/(π R))`` of the starter case, with 32 elements of degree 8."""

UNPOSITIONED = {20: 1.58e-3, 40: 4.4e-4, 80: 9.7e-5, 160: 1.9e-5}
"""Error of that by elements, degree 2, all of one size."""

POSITIONED = {4: 2.8e-4, 6: 2.2e-5, 8: 6.3e-6}
"""By degree, 8 graded elements."""


def error_of(*overrides):
    """Relative error of the peak pressure over the formula at the computed force."""
    summary = solved(HERTZ, {}, *overrides).summary
    modulus = contact_modulus((210e9, 0.3), (210e9, 0.3))
    formula = line_contact(summary["normal_force_N"] / 1e-3, 10e-3, modulus).peak
    return abs(summary["max_pressure_Pa"] / formula / CONVERGED - 1)


def least_fall(found):
    """Least ratio of an error to the next one."""
    return min(a / b for a, b in itertools.pairwise(found.values()))


def largest_part(found, known):
    """Largest error by the known one."""
    return max(found[key] / known[key] for key in known)


@pytest.mark.slow
def test_refinement_of_elements():
    """requirement: the peak converges with unpositioned elements, see `UNPOSITIONED`."""
    plain = ("contact.positioning=false", "mesh.degree=2", "mesh.grading=1.0")
    found = {n: error_of(*plain, f"mesh.elements={n}") for n in UNPOSITIONED}
    assert least_fall(found) > 1.5
    assert largest_part(found, UNPOSITIONED) < 1.2


def test_refinement_of_degree():
    """requirement: eight positioned elements converge in their degree, see `POSITIONED`."""
    graded = ("mesh.elements=8", "mesh.grading=0.5")
    found = {k: error_of(*graded, f"mesh.degree={k}") for k in POSITIONED}
    assert least_fall(found) > 1.5
    assert largest_part(found, POSITIONED) < 1.2


class Listener(tw.simulation.Observer):
    """Keeps what is said."""

    def __init__(self):
        self.notes = []

    def note(self, text):
        self.notes.append(text)


@pytest.mark.parametrize("half", [pytest.param(True, marks=pytest.mark.slow), False])
def test_a_contact_that_outgrows_its_face(monkeypatch, half):
    """requirement: pressure cut off where the contact face ends is said; positioning mends it."""
    kind = type(tw.load(tables(HERTZ, {})).geometry)
    monkeypatch.setattr(kind, "expected_zone", lambda self, pressing: (-1e-4, 1e-4))
    pressures, notes = [], []
    for on in ("false", "true"):
        listener = Listener()
        keys = (f"contact.positioning={on}", f"geometry.half={str(half).lower()}")
        result = tw.run(tw.load(tables(HERTZ, {}), keys), observer=listener)
        pressures.append(result.summary["max_pressure_Pa"])
        notes.append(listener.notes)
    assert "reaches the end of the contact face" in notes[0][0]
    assert notes[1] == []
    assert pressures[0] > 1.5 * pressures[1]
    assert pressures[1] == pytest.approx(2.8648e9, rel=1e-3)


def test_several_zones_are_refused(monkeypatch):
    """requirement: positioning is for one contact zone, and says so."""
    zones = "thermowear.simulation.analyses.positioning.contact_zones"
    monkeypatch.setattr(zones, lambda *_: [(0.0, 1e-4), (2e-4, 3e-4)])
    with pytest.raises(tw.ComputationError, match="2 places"):
        positioned(HERTZ, {}, "mesh.degree=2", "mesh.elements=8")


@pytest.mark.parametrize("zone", [(0.0, -1e-4), (1e-4, 1e-4), (-1e-4, 0.0)])
def test_a_zone_that_is_none_is_refused(zone):
    """requirement: no mesh is tried for a contact without width."""
    with pytest.raises(tw.CaseError, match="geometry"):
        tw.load(tables(HERTZ, {})).tagged_mesh(zone)

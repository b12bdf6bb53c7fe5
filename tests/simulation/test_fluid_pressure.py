"""Pressure of a fluid between contact faces: forces, deflection, wear, and refusals."""

import json
import shutil
import subprocess
import sys

from mpi4py import MPI

import numpy as np
import pytest
import ufl

import thermowear as tw
from thermowear.simulation.from_case import model_of
from thermowear.simulation.system.building import build
from thermowear.simulation.system.conditions import parted_by_fluid
from thermowear.simulation.system.rigid_modes import fluid_pressure
from thermowear.timer import Phases
from thermowear.verification.cases.assembly import face_seal as seal

from ..case.starter import changed
from .test_surface_pressure import BLOCKS

AREA, HEIGHT, E = 40e-3 * 10e-3, 30e-3, 2e9
PRESSED = {"load": {"force": "1 kN"}}
MEAN = 1000.0 / AREA
RISING = "1 MPa * (1 + x / (40 mm))"
"""On blocks from x = -20 mm to 20 mm: 0.5 MPa to 1.5 MPa."""
LINEAR = "0.1 MPa * (r - 25 mm) / (7 mm)"


def run(tables, changes=None):
    return tw.run(tw.load(changed(tables, changes or {})))


def wet_seal(pressure, analysis="steady", **holders):
    """Face seal without heat."""
    found = seal.tables(None, 4, pressure)
    found["analysis"] = {"type": analysis}
    found["holders"] |= holders
    return found


@pytest.mark.parametrize("method", ["condensed", "pointwise", "penalty", "nitsche"])
@pytest.mark.parametrize("pressure", ["1 MPa", RISING])
def test_blocks_share_the_load_with_the_fluid(method, pressure):
    """
    requirement: contact and fluid together press uniformly on columns between rigid ends, as the
    contact alone does without a fluid: p = F/A - p_f at every point, the same approach.
    """
    changes = {"load": PRESSED["load"], "contact": {"fluid_pressure": pressure, "method": method}}
    result = run(BLOCKS, changes)
    at, exact = result.interface, method in ("condensed", "pointwise")
    fluid = 1e6 * (1 + at.x / 40e-3) if pressure == RISING else np.full(len(at.x), 1e6)
    np.testing.assert_allclose(at.fluid_pressure, fluid, rtol=1e-12)
    np.testing.assert_allclose(at.pressure, MEAN - fluid, rtol=1e-9 if exact else 5e-4)
    numbers = result.summary
    assert numbers["fluid_force_N"] == pytest.approx(1e6 * AREA, rel=1e-9)
    assert numbers["normal_force_N"] == pytest.approx(1000.0 - 1e6 * AREA, rel=1e-7)
    assert numbers["equilibrium_relative_error"] < 1e-9
    expected = MEAN * HEIGHT / E
    assert numbers["approach_m"] == pytest.approx(expected, rel=1e-9 if exact else 5e-3, abs=0.0)


def test_wear_in_time_follows_the_contact_pressure():
    """requirement: the fluid does not wear: depth k (F/A - p_f) v t."""
    changes = {
        "load": PRESSED["load"],
        "contact": {"fluid_pressure": "1 MPa", "friction": 0.0},
        "motion": {"velocity": "1 m/s"},
        "wear": {"punch": {"coefficient": "1e-8 1/MPa", "per": "pressure"}, "update": "never"},
        "analysis": {"type": "transient", "end_time": "10 s"},
    }
    result = run(BLOCKS, changes)
    np.testing.assert_allclose(result.interface.pressure, MEAN - 1e6, rtol=1e-9)
    np.testing.assert_allclose(result.interface.wear_1, 1e-14 * (MEAN - 1e6) * 10.0, rtol=1e-9)


def test_friction_heat_follows_the_contact_pressure():
    """requirement: the fluid does not rub: heat mu w r_m (F - p_f A), all of it into the rings."""
    found = tw.run(tw.load(seal.tables(elements=4, fluid="0.05 MPa"))).summary
    contact = found["contacts"]["ring-seat"]
    force = seal.FORCE - 0.05e6 * np.pi * (seal.OUTER**2 - seal.INNER**2)
    power = seal.FRICTION * seal.SPEED * (seal.OUTER + seal.INNER) / 2 * force
    assert contact["friction_power_W"] == pytest.approx(power, rel=1e-9)
    into = contact["contact_heat_1_W"] + contact["contact_heat_2_W"]
    assert into == pytest.approx(power, rel=1e-9)


def test_running_in_ends_in_the_steady_state():
    """requirement: wear under the fluid leads to the pressure and shape of the principle."""
    tables = wet_seal(LINEAR)
    steady = tw.run(tw.load(tables)).interface
    tables["analysis"] = {"type": "transient", "end_time": "1e6 s", "tolerance": 1e-3}
    worn = tw.run(tw.load(tables)).interface
    np.testing.assert_allclose(worn.pressure, steady.pressure, rtol=1e-3)
    np.testing.assert_allclose(worn.shape, steady.shape, atol=1e-3 * np.ptp(steady.shape))


def test_fluid_in_an_open_contact():
    """requirement: the fluid presses on faces apart, too: the gap is p_f h/E less the approach."""
    result = run(BLOCKS, {"load": {"approach": "5 um"}, "contact": {"fluid_pressure": "1 MPa"}})
    assert not result.interface.pressure.any()
    np.testing.assert_allclose(result.interface.gap, 1e6 * HEIGHT / E - 5e-6, rtol=1e-9)
    closed = run(BLOCKS, {"load": {"approach": "40 um"}, "contact": {"fluid_pressure": "1 MPa"}})
    np.testing.assert_allclose(closed.interface.pressure, 40e-6 * E / HEIGHT - 1e6, rtol=1e-9)


def test_steady_states_of_a_seal():
    """requirement: forces and uniform wear to 1e-9; a fluid 1/r leaves the worn shape alone."""
    checks = list(seal.fluid())
    assert len(checks) == 7
    assert not [check for check in checks if not check.passed]


@pytest.mark.parametrize(("pressure", "rises"), [("0.05 MPa", False), (LINEAR, True)])
def test_deflection_by_the_fluid(pressure, rises):
    """
    requirement: faces wear to fit under the fluid: the shape is that of the contact pressure, plus
    the opening of each ring under the same pressure on its free face alone, to 1e-9.
    """
    wet = tw.run(tw.load(wet_seal(pressure)))
    force = wet.summary["contacts"]["ring-seat"]["normal_force_N"]
    spring = {"surface": "ring_top", "force": f"{force!r} N"}
    dry = tw.run(tw.load(wet_seal(None, spring=spring)))
    system = build(model_of(tw.load(wet_seal(None))), MPI.COMM_SELF, Phases())
    elastic = system.elastic

    def work(body, surface):
        r = ufl.SpatialCoordinate(body.body.mesh)[0]
        given = 0.1e6 * (r - 0.025) / 0.007 if rises else 0.05e6
        return body._work(surface, -given * ufl.FacetNormal(body.body.mesh))

    loads = [[work(b, face) for b in elastic.each] for face in ("ring_bottom", "seat_top")]
    opening = sum(system.trace.T @ elastic.solve(elastic.spaces.loads(each)) for each in loads)
    found = wet.interface.shape - dry.interface.shape
    scale = np.ptp(dry.interface.shape)
    assert np.ptp(opening) > scale if rises else np.ptp(opening) < 1e-3 * scale
    np.testing.assert_allclose(found - found[0], opening - opening[0], rtol=0, atol=1e-9 * scale)


def test_a_floating_ring_between_two_fluids():
    """
    requirement: each contact carries the load less its own fluid force; the housing reacts to
    both; the equilibrium of the floating body contains both fluids.
    """
    layer = {"x": ["20 mm", "30 mm"], "height": "10 mm"}
    tables = seal.tables(None, 4)
    tables["geometry"]["layers"] = dict.fromkeys(("upper", "middle", "lower"), layer)
    tables["bodies"] = dict.fromkeys(("upper", "middle", "lower"), tables["bodies"]["ring"])
    tables |= {
        "contacts": {
            "upper-middle": {"fluid_pressure": "0.2 MPa"},
            "middle-lower": {"fluid_pressure": "0.1 MPa * (r - 20 mm) / (10 mm)"},
        },
        "holders": {
            "spring": {"surface": "upper_top", "force": "1 kN"},
            "guide": {"surface": "middle_inside"},
            "housing": {"surface": "lower_bottom", "free": []},
        },
        "motions": {"middle": {"angular_velocity": "10 rad/s"}},
        "wear": {"middle": {"coefficient": "1e-10 1/MPa"}, "update": "never"},
    }
    forces = 0.2e6 * np.pi * 500e-6, 2 * np.pi * 10e6 * (19e-6 / 3 - 0.02 * 500e-6 / 2)
    for analysis in ("steady", "initial"):
        result = tw.run(tw.load(tables | {"analysis": {"type": analysis}}))
        found = result.summary["contacts"].values()
        assert [c["fluid_force_N"] for c in found] == pytest.approx(forces, rel=1e-9)
        rest = [1000.0 - force for force in forces]
        assert [c["normal_force_N"] for c in found] == pytest.approx(rest, rel=1e-9)
        housing = result.summary["holders"]["housing"]
        assert abs(housing["guide_force_z_N"]) == pytest.approx(1000.0, rel=1e-9)
        assert result.summary["equilibrium_relative_error"] < 1e-9
    tables["contacts"]["middle-lower"] = {"fluid_pressure": "1 MPa"}
    message = r"contacts.middle-lower.fluid_pressure: the fluid parts the faces: .* 314.2 N in "
    with pytest.raises(tw.ComputationError, match=message + r"upper-middle, 1571 N .* 1000 N"):
        tw.run(tw.load(tables))


@pytest.mark.parametrize("analysis", ["initial", "steady"])
def test_fluid_that_parts_the_faces(analysis):
    """requirement: one line with both forces."""
    message = r"^contacts.ring-seat.fluid_pressure: .* presses with 376 N .* loads with 300 N"
    with pytest.raises(tw.ComputationError, match=message):
        tw.run(tw.load(wet_seal("0.3 MPa", analysis)))


def test_a_load_that_falls_below_the_fluid():
    """requirement: a run in time ends in one line when the faces part, with the load of then."""
    spring = {
        "surface": "ring_top",
        "history": {"time": ["0 s", "10 s"], "force": ["300 N", "30 N"]},
    }
    tables = wet_seal("0.1 MPa", spring=spring)
    tables["analysis"] = {"type": "transient", "end_time": "10 s"}
    stopped = tw.run(tw.load(tables)).stopped
    assert "the fluid parts the faces: it presses with 125.3 N" in str(stopped)


@pytest.mark.parametrize("left", [-1e-3, -1e-13, 0.0, 1e-13, 1e-3])
def test_what_rounding_leaves_of_a_load_carries_nothing(left):
    """requirement: the line of the fluid on both sides of the load that just parts the faces."""
    system = build(model_of(tw.load(wet_seal("0.1 MPa"))), MPI.COMM_WORLD, Phases())
    opening = system.holder.modes.T @ (
        system.weights * fluid_pressure(system.model, system.contacts)
    )
    parted = parted_by_fluid(system, left * opening)
    assert (parted is None) == (left == 1e-3)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"contact.fluid_pressure": 5e5}, r"contact.fluid_pressure: .*unit"),
        ({"contact.fluid_pressure": "1 N"}, r"contact.fluid_pressure: .*needs Pa"),
        ({"contact.fluid_pressure": "p"}, r"contact.fluid_pressure: .*not a variable"),
        ({"contact.fluid_pressure": "1 MPa * z / (1 m)"}, r"contact.fluid_pressure: z is .* 3d"),
        ({"contact.fluid_pressure": "1 MPa * x / (1 m)"}, r"contact.fluid_pressure: -.* at x = -"),
        ({"contact.fluid_pressure": "1 Pa m / x / 0"}, r"contact.fluid_pressure: "),
    ],
)
def test_faults(changes, message):
    """requirement: one line that names the key."""
    with pytest.raises(tw.CaseError, match=message):
        run(BLOCKS, PRESSED | changes)


def test_glued_faces_hold_no_fluid():
    """requirement: refused with the path of the key."""
    tables = wet_seal(None)
    tables["contacts"] = {"ring-seat": {"tie": True, "fluid_pressure": "1 MPa"}}
    with pytest.raises(tw.CaseError, match=r"ring-seat.fluid_pressure: not allowed .* tie"):
        tw.load(tables)


def test_on_two_ranks(tmp_path):
    """requirement: the ranks find what one process finds."""
    if shutil.which("mpirun") is None:
        pytest.skip("needs mpirun")
    tables = wet_seal(LINEAR)
    script = (
        "import sys, json, numpy as np, thermowear as tw\n"
        "from mpi4py import MPI\n"
        "found = tw.run(tw.load(json.loads(sys.argv[1])))\n"
        "if MPI.COMM_WORLD.rank == 0: np.save(sys.argv[2], found.interface.shape)\n"
    )
    file = tmp_path / "shape.npy"
    command = ["mpirun", "--oversubscribe", "-n", "2", sys.executable, "-c", script]
    subprocess.run([*command, json.dumps(tables), str(file)], check=True, timeout=300)
    alone = tw.run(tw.load(tables)).interface.shape
    np.testing.assert_allclose(np.load(file), alone, atol=1e-9 * np.ptp(alone))

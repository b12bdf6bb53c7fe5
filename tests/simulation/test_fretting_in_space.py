"""Stick, slip and wear in space, from the case to the results."""

from math import cos, radians, sin
from types import SimpleNamespace

import numpy as np
import pytest

import thermowear as tw
from thermowear.contact.friction.frictional_contact import condense_tangential
from thermowear.contact.friction.stick_slip import FullSliding, follow
from thermowear.contact.friction.stick_slip_state import Loads
from thermowear.contact.operators.rigid_motion import tangential_frame
from thermowear.geometry.geometries.rectangular_punch import RectangularPunch
from thermowear.reference.elastic_contact.fretting_sphere import FrettingSphere
from thermowear.reference.elastic_contact.mindlin_sphere import MindlinSphere
from thermowear.simulation.cycles.held_loads import HeldLoads

from ..case.starter import solved
from ..systems import built

MU, FORCE, K = 0.4, 1000.0, 1e-14
VOLUME = 0.05  # of those of the march
SIZES = {"size_x": "4 mm", "size_y": "4 mm", "height": "3 mm"}
SIZES |= {"block_x": "8 mm", "block_y": "8 mm", "block_height": "4 mm"}
STEEL = {"young_modulus": "200 GPa", "poisson_ratio": 0.3}


class TurnedPunch(RectangularPunch):
    """A punch and a block that are turned about z."""

    turned: float = 0.0

    def build(self, mesh, zone=None):
        found, (c, s) = super().build(mesh, zone), (cos(self.turned), sin(self.turned))
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        object.__setattr__(found, "points", found.points @ turn.T)
        return found


def case(history, turned=0.0, wear=None, elements=4, method="condensed", **analysis):
    """A punch on a block, an instant a second."""
    count = len(next(iter(history.values())))
    geometry = TurnedPunch(type="rectangular-punch", turned=turned, **SIZES)
    tables = {
        "model": "3d",
        "geometry": geometry,
        "mesh": {"degree": 2, "elements": elements, "grading": 0.6},
        "bodies": {"punch": STEEL, "block": {"like": "punch"}},
        "load": {
            "force": f"{FORCE} N",
            "history": {"time": [f"{t} s" for t in range(count)]} | history,
        },
        "contact": {"friction": MU, "method": method},
        "wear": wear or {},
        "analysis": {"type": "fretting", "increments": 4} | analysis,
    }
    return tw.load(tables)


def pushed(*forces, angle=0.0):
    """Histories of a force along a direction [N]."""
    return {
        "tangential_force": [f"{f * cos(angle)!r} N" for f in forces],
        "tangential_force_y": [f"{f * sin(angle)!r} N" for f in forces],
    }


def moved(*places):
    """Histories of displacements (x, y) [µm]."""
    return {
        "tangential_displacement": [f"{x!r} um" for x, _ in places],
        "tangential_displacement_y": [f"{y!r} um" for _, y in places],
    }


PUNCH_WEARS = {"punch": {"coefficient": f"{K} 1/Pa", "per": "pressure"}}


@pytest.fixture(scope="module")
def slid():
    """A square path far beyond the limit of friction."""
    d = 40.0
    path = moved((0, 0), (d, 0), (d, d), (0, d), (0, 0), (d, 0))
    return tw.run(case(path, wear=PUNCH_WEARS, increments=8))


# ---- direction ----


@pytest.mark.parametrize("method", ["condensed", "penalty", "nitsche"])
def test_turned_with_the_mesh_it_is_the_same(method):
    """requirement: no axis is preferred; forces and meshes turned by 37 degrees alike."""
    angle, forces = radians(37), (0.0, 300.0, -200.0)
    settings = {"method": method}
    if method != "condensed":
        settings |= {"elements": 2, "increments": 2}
    one = tw.run(case(pushed(*forces), **settings))
    two = tw.run(case(pushed(*forces, angle=angle), turned=angle, **settings))
    f, g, (c, s) = one.friction.last, two.friction.last, (cos(angle), sin(angle))
    scale = f.shear.max()
    np.testing.assert_allclose(c * g.x + s * g.y, f.x, atol=1e-12)
    np.testing.assert_allclose(g.pressure, f.pressure, atol=1e-6 * f.pressure.max())
    np.testing.assert_allclose(c * g.shear_x + s * g.shear_y, f.shear_x, atol=1e-6 * scale)
    np.testing.assert_allclose(c * g.shear_y - s * g.shear_x, f.shear_y, atol=1e-6 * scale)
    np.testing.assert_array_equal(g.status, f.status)
    assert np.unique(f.status).tolist() == [1, 2]
    a, b = one.friction.tangential[-1], two.friction.tangential[-1]
    moved = np.hypot(b.displacement_x, b.displacement_y)
    assert moved == pytest.approx(-a.displacement_x, rel=1e-6)
    assert b.displacement_y / b.displacement_x == pytest.approx(s / c, rel=1e-6)


def test_the_frame_of_the_face_does_not_matter():
    """requirement: tangential directions are only components; turned ones give the same vectors."""
    system = built(case(pushed(0.0, 350.0, angle=0.4)))
    held = HeldLoads(system)
    found = []
    for turned in (0.0, 0.9):
        frame = tangential_frame(system.contacts, turned=turned)
        contact = condense_tangential(
            system.elastic, system.contacts, system.basis, held.held, frame
        )
        *_, state = follow(contact, MU, [held.at(0.0), held.at(1.0)], 3)
        found.append(np.einsum("mt,ti->mi", state.shear, frame[:, 0]))
        assert (state.status == 2).any()
    np.testing.assert_allclose(found[1], found[0], atol=1e-8 * np.abs(found[0]).max())


def test_shear_balances_the_holder():
    """requirement: forces along x and y, and shear within the cone of friction."""
    result = tw.run(case(pushed(0.0, 350.0, angle=0.4)))
    f, row = result.friction.last, result.friction.tangential[-1]
    for axis, force in (("x", 350 * cos(0.4)), ("y", 350 * sin(0.4))):
        assert f.weight @ getattr(f, f"shear_{axis}") == pytest.approx(-force, rel=1e-9)
        assert getattr(row, f"force_{axis}") == pytest.approx(force, rel=1e-9)
    limit = MU * f.pressure
    assert np.all(f.shear <= limit * (1 + 1e-9))
    slips = f.status == 2
    carried, most = f.weight * f.shear, f.weight * limit
    assert carried[slips].sum() > 0.95 * most[slips].sum()
    assert carried[~slips].sum() < 0.95 * most[~slips].sum()
    np.testing.assert_allclose(f.shear, np.hypot(f.shear_x, f.shear_y), rtol=1e-12)
    assert result.summary["friction_force_N"] == pytest.approx(350.0, rel=1e-9)
    assert result.summary["equilibrium_relative_error"] < 1e-9
    assert 0 < result.summary["stick_area_m2"] < result.summary["contact_area_m2"]


@pytest.mark.parametrize("angle", [0.0, 0.6])
def test_gross_slip_in_any_direction(angle):
    """requirement: friction carries mu P in every direction, and no more."""
    below = tw.run(case(pushed(0.0, 0.98 * MU * FORCE, angle=angle)))
    assert below.stopped is None
    beyond = tw.run(case(pushed(0.0, 1.01 * MU * FORCE, angle=angle)))
    assert isinstance(beyond.stopped, FullSliding)
    assert "body 1 slides; friction carries" in str(beyond.stopped)


@pytest.mark.parametrize("method", ["penalty", "nitsche"])
def test_gross_slip_on_the_full_system(method):
    """requirement: the same limit by the other methods; they wear by k P times the way."""
    path = moved((0, 0), (20, 15), (40, 30))
    slid = tw.run(case(path, wear=PUNCH_WEARS, elements=2, method=method, increments=1))
    rows = slid.friction.rows
    volume = rows[-1].wear_volume_1 - rows[-2].wear_volume_1
    assert volume == pytest.approx(K * FORCE * 25e-6, rel=1e-4, abs=0.0)
    last = slid.friction.tangential[-1]
    np.testing.assert_allclose([last.force_x, last.force_y], [320.0, 240.0], rtol=1e-2)
    beyond = pushed(0.0, 1.01 * MU * FORCE, angle=0.6)
    refused = tw.run(case(beyond, elements=2, method=method, increments=1))
    assert isinstance(refused.stopped, FullSliding)


# ---- twist ----


def test_twist():
    """requirement: a turn of the holder takes a torque of its sense, up to ∫ mu p r dA."""
    result = tw.run(case({"twist": ["0 mrad", "20 mrad"]}, elements=8))
    f, row = result.friction.last, result.friction.tangential[-1]
    bound = f.weight @ (MU * f.pressure * np.hypot(f.x, f.y))
    assert row.torque == pytest.approx(bound, rel=5e-2)
    assert row.twist == pytest.approx(0.02, rel=1e-12)
    # the punch turns anticlockwise seen from above: friction on it clockwise
    assert f.weight @ (f.x * f.shear_y - f.y * f.shear_x) == pytest.approx(-row.torque, rel=1e-9)
    assert np.abs([row.force_x, row.force_y]).max() < 1e-6 * MU * FORCE
    moment = {"torque": ["0 N m", f"{0.5 * row.torque!r} N m"]}
    half = tw.run(case(moment)).friction.tangential[-1]
    assert half.torque == pytest.approx(0.5 * row.torque, rel=1e-9)
    assert 0 < half.twist < 0.02


# ---- energy and wear ----


def test_energy_is_the_work_of_the_holder():
    """requirement: once cycles are closed, all work of the forces and the torque is dissipated."""
    history = moved((0, 0), *[(6, 3), (-6, -3)] * 2, (6, 3))
    history["twist"] = ["0 mrad", *["1 mrad", "-1 mrad"] * 2, "1 mrad"]
    (coarse, _), (fine, rows) = (_cycle(history, increments) for increments in (12, 24))
    work = 0.0
    for force, motion in (
        ("force_x", "displacement_x"),
        ("force_y", "displacement_y"),
        ("torque", "twist"),
        ("normal_force", "approach"),
    ):
        f, d = (np.array([getattr(row, name) for row in rows]) for name in (force, motion))
        work += np.sum((f[1:] + f[:-1]) / 2 * np.diff(d))
    assert 2 * fine - coarse == pytest.approx(work, rel=3e-3)  # errors are those of the increments


def _cycle(history, increments):
    """Energy dissipated in the second cycle, and rows of the holder."""
    found = tw.run(case(history, increments=increments)).friction
    lost = {row.time: row.dissipated for row in found.rows}
    both = zip(found.rows, found.tangential, strict=True)
    rows = [SimpleNamespace(**vars(one) | vars(other)) for one, other in both if one.time >= 3.0]
    return lost[5.0] - lost[3.0], rows


def test_gross_slip_volume_is_the_way_along_any_path(slid):
    """requirement: V = k ∮ p ds to 1e-4 where all slides, and k/mu times the energy always."""
    volumes = {row.time: row.wear_volume_1 for row in slid.friction.rows}
    energy = {row.time: row.dissipated for row in slid.friction.rows}
    for start, end in ((1.5, 2.0), (2.5, 3.0), (3.5, 4.0)):
        known = K * FORCE * 20e-6  # half a side of the square, after the turn of the corner
        assert volumes[end] - volumes[start] == pytest.approx(known, rel=1e-4, abs=0.0)
    pressed = [row for row in slid.friction.rows if row.time == 0.0][-1].dissipated
    known = K / MU * (energy[5.0] - pressed)
    assert volumes[5.0] == pytest.approx(known, rel=1e-9, abs=0.0)


def test_friction_turns_with_the_motion(slid):
    """requirement: along each side of the square the shear ends against the motion."""
    forces = {row.time: (row.force_x, row.force_y) for row in slid.friction.tangential}
    for time, along in ((1.0, (1, 0)), (2.0, (0, 1)), (3.0, (-1, 0)), (4.0, (0, -1))):
        expected = MU * FORCE * np.array(along)
        np.testing.assert_allclose(forces[time], expected, atol=1e-2 * MU * FORCE)


def test_what_sticks_does_not_wear():
    """requirement: in partial slip the corners and edges of the face wear, its middle does not."""
    history = pushed(0.0, 200.0, -200.0, 200.0, angle=0.5)
    result = tw.run(case(history, wear=PUNCH_WEARS, elements=6))
    i = result.interface
    r = np.hypot(i.x, i.y)
    assert np.abs(i.wear_1[r < 0.8e-3]).max() < 1e-6 * i.wear_1.max()
    assert i.wear_1.max() > 0.0
    assert i.wear_2.max() == 0.0


def test_cycles_are_jumped():
    """requirement: 1000 cycles in few jumps; twice as many jumps give the same volume."""
    history = pushed(0.0, 380.0, -380.0, 380.0, angle=0.5)
    wear = PUNCH_WEARS | {"cycles": 1000}
    coarse = tw.run(case(history, wear=wear, tolerance=1e-3)).friction.cycles
    fine = tw.run(case(history, wear=wear, tolerance=5e-5)).friction.cycles
    assert coarse[-1].cycle == 1000
    assert len(coarse) < 25 < len(fine)
    assert coarse[-1].wear_volume_1 == pytest.approx(fine[-1].wear_volume_1, rel=3e-2, abs=0.0)


# ---- a sphere in partial slip ----

SPHERE = MindlinSphere(20.0, 0.01, ((2e11, 0.3), (2e11, 0.3)), 0.6)
SWINGS = {
    "load.history": {
        "time": ["0 ms", "12.5 ms", "37.5 ms", "62.5 ms"],
        "tangential_displacement": ["0 um", "0.3495 um", "-0.3495 um", "0.3495 um"],
    },
    "analysis.output_times": [],
}


def radius_at(result):
    """Stick radius by Cattaneo and Mindlin under the friction force on both halves [m]."""
    part = 2 * abs(result.summary["tangential_force_N"]) / SPHERE.limit
    return SPHERE.contact_radius * (1 - part) ** (1 / 3)


def test_the_stick_radius_of_a_sphere_is_interpolated():
    """requirement: within 1 % where elements are a tenth of the contact radius wide."""
    result = solved("sphere-fretting", SWINGS | {"wear.cycles": 1})
    found = result.summary["stick_radius_m"]
    assert found == pytest.approx(radius_at(result), rel=1e-2, abs=0.0)
    assert result.friction.cycles[-1].stick_radius == found


@pytest.mark.slow
def test_a_sphere_frets_until_nothing_wears():
    """requirement: volumes and stick radius of a march by dimensionality reduction until the end.

    The amplitude at the contact is that of the force in the first cycle, 2 % less than that of
    the holder.
    """
    numbers = [311, 1700, 4647, 9576, 13157, 17885, 24185, 40000]
    times = [f"{0.0125 + 0.05 * number} s" for number in numbers[:-1]]
    changes = SWINGS | {"wear.cycles": numbers[-1], "analysis.output_times": times}
    result = solved("sphere-fretting", changes)
    first = next(row for row in result.friction.rows if row.cycle == 1 and row.time > 0.06)
    amplitude = SPHERE.displacement(2 * abs(first.tangential_force))
    assert amplitude == pytest.approx(0.342e-6, rel=5e-3, abs=0.0)
    known = FrettingSphere(SPHERE, amplitude, 2e-13, points=300)
    depths = known.depths(numbers)
    rows = {row.cycle: row for row in result.friction.cycles}
    found = np.array([2 * (rows[n].wear_volume_1 + rows[n].wear_volume_2) for n in numbers])
    error = result.summary["wear_volume_error_estimate_relative"]
    np.testing.assert_allclose(found, known.volume(depths), rtol=VOLUME)
    assert error > abs(found[-1] / known.volume(depths)[-1] - 1)
    for depth, number in ((depths[0], 311), (depths[-1], 40000)):
        radius = known.contact(depth).stick_radius
        assert rows[number].stick_radius == pytest.approx(radius, rel=2e-2, abs=0.0)


# ---- requests that are refused ----


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"tangential_force_y": ["0 N", "1 N"], "tangential_displacement_y": ["0 um", "1 um"]},
            "load.history.tangential_displacement_y: only one of",
        ),
        ({"twist": ["0 deg", "30 deg"]}, "load.history.twist.1"),
        ({"torque": ["0 N m"]}, "load.history.torque: has 1 values for 2 times"),
    ],
)
def test_faults_of_histories(changes, message):
    """requirement: one line with the path of the key."""
    with pytest.raises(tw.CaseError) as refused:
        case({"tangential_force": ["0 N", "1 N"]} | changes)
    assert message in str(refused.value)


def test_loads_must_exist_once():
    """requirement: exactly one of force and displacement along each motion."""
    with pytest.raises(ValueError, match="either force or translation"):
        Loads(np.array([1.0, 2.0]), np.array([np.nan, 1.0]))

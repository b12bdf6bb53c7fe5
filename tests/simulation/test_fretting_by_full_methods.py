"""Fretting by penalty and by Nitsche's method, in sections and in space."""

import numpy as np
import pytest

from thermowear.contact.friction.stick_slip import FullSliding
from thermowear.reference.elastic_contact.hertz import MindlinLine, contact_modulus
from thermowear.verification.cases.cycles import spheres

from ..case.starter import FRETTING, solved

METHODS = ["penalty", "nitsche"]
LINE = MindlinLine(120e3, 6e-3, contact_modulus((200e9, 0.3), (200e9, 0.3)), 0.6)
PUSH, THICKNESS = 36e3, 1e-3
HISTORY = {
    "time": ["0 s", "1 s", "2 s", "3 s"],
    "tangential_force": ["0 N", "36 N", "-36 N", "36 N"],
}


def cylinder(method, *more, elements=32, **changes):
    """The starter case of Cattaneo and Mindlin on a coarser mesh."""
    mesh = f"mesh.elements={elements}", "mesh.degree=2", "mesh.grading=1.0"
    small = (*mesh, "analysis.increments=2", f"contact.method={method}")
    return solved(FRETTING, {"load.history": HISTORY} | changes, *small, *more)


def of_cycle(result):
    """Energy dissipated between both ends of the cycle [J/m]."""
    lost = {row.time: row.dissipated for row in result.friction.rows}
    return (lost[3.0] - lost[1.0]) / THICKNESS


# ---- sections ----


@pytest.mark.parametrize("method", METHODS)
def test_cattaneo_and_mindlin(method):
    """requirement: shear, stick zone and energy of a cycle of the closed form."""
    result = cylinder(method)
    assert result.stopped is None
    f, exact = result.friction.outputs[1.0], LINE.shear
    off = f.weight @ np.abs(-f.shear - exact(f.x, PUSH))
    assert off < 0.03 * PUSH * THICKNESS
    a, c = LINE.normal.half_width, LINE.stick_half_width(PUSH)
    stuck = f.weight[f.status == 1].sum() / THICKNESS / 2
    assert stuck == pytest.approx(c, abs=0.06 * a)
    away = (np.abs(np.abs(f.x) - c) > 0.1 * a) & (np.abs(np.abs(f.x) - a) > 0.1 * a)
    expected = np.where(np.abs(f.x) < c, 1, np.where(np.abs(f.x) < a, 2, 0))
    np.testing.assert_array_equal(f.status[away], expected[away])
    assert of_cycle(result) == pytest.approx(LINE.loss_per_cycle(PUSH), rel=0.03)
    assert result.summary["equilibrium_relative_error"] < 1e-7
    assert result.summary["friction_force_N"] == pytest.approx(36.0, rel=1e-8)


def test_the_condensed_displacement_within_the_error_of_the_mesh():
    """requirement: Nitsche's displacements are within 1e-3 of the condensed ones, and closer on a
    finer mesh.
    """
    off = []
    for elements in (16, 32):
        one, two = (
            cylinder(m, elements=elements).friction.rows[-1] for m in ("condensed", "nitsche")
        )
        for name in ("approach", "tangential_displacement"):
            assert getattr(two, name) == pytest.approx(getattr(one, name), rel=1e-3, abs=0.0)
        off.append(abs(two.tangential_displacement - one.tangential_displacement))
    assert off[1] < 0.5 * off[0]


@pytest.mark.parametrize("method", METHODS)
def test_gross_slip(method):
    """requirement: beyond the limit of friction the force is mu N; more of it is refused."""
    slid = {"time": ["0 s", "1 s"], "tangential_displacement": ["0 um", "10 um"]}
    once = {"analysis.output_times": []}
    result = cylinder(method, elements=16, **once | {"load.history": slid})
    assert result.friction.rows[-1].tangential_force == pytest.approx(72.0, rel=1e-2)
    assert result.friction.rows[-1].stick_area == 0.0
    pushed = {"time": ["0 s", "1 s"], "tangential_force": ["0 N", "80 N"]}
    result = cylinder(method, elements=16, **once | {"load.history": pushed})
    assert isinstance(result.stopped, FullSliding)
    assert "friction carries 7" in str(result.stopped)


def worn(method, **analysis):
    """Gross slip of a cylinder that wears, and its flat."""
    history = {
        "time": [f"{t} s" for t in range(5)],
        "tangential_displacement": [f"{x} um" for x in (0, 25, 0, -25, 0)],
    }
    wear = {
        body: {"coefficient": f"{k} 1/Pa", "per": "pressure"}
        for body, k in (("cylinder", 1.9e-14), ("block", 2.9e-14))
    }
    changes = {
        "load": {"force": "18.5 N", "history": history},
        "wear": wear,
        "contact": {"friction": 0.9, "method": method},
        "geometry.zone": "0.22 mm",
        "mesh": {"degree": 2, "elements": 16, "grading": 1.0},
        "analysis": {"type": "fretting", "increments": 2} | analysis,
    }
    return solved(FRETTING, changes)


@pytest.mark.parametrize(
    "analysis",
    [
        {"cycles": 1},
        {"cycles": 40, "jump": 20},
        pytest.param({"cycles": 8, "tolerance": 0.1}, marks=pytest.mark.slow),
    ],
)
def test_wear_and_cycle_jumps(analysis):
    """requirement: volumes of the condensed method to 1e-3, k/mu times the energy to 1e-9, and a
    profile that is not rougher, the same but for the error of the mesh.
    """
    known, found = (worn(method, **analysis) for method in ("condensed", "nitsche"))
    assert found.stopped is None
    end, expected = found.friction.cycles[-1], known.friction.cycles[-1]
    for body in (1, 2):
        volume = getattr(end, f"wear_volume_{body}")
        assert volume == pytest.approx(getattr(expected, f"wear_volume_{body}"), rel=1e-3, abs=0.0)
    total = end.wear_volume_1 + end.wear_volume_2
    pressed = [row for row in found.friction.rows if row.time == 0.0][-1].dissipated
    energy = end.dissipated - pressed
    assert total == pytest.approx(4.8e-14 / 0.9 * energy, rel=1e-9, abs=0.0)
    (one, two), w = (r.interface.wear_2 for r in (found, known)), known.interface.weight
    assert np.abs(np.diff(one, 2)).max() < 1.5 * np.abs(np.diff(two, 2)).max()
    assert w @ np.abs(one - two) < 0.2 * (w @ two)


# ---- space ----


@pytest.mark.slow
def test_sphere_by_nitsche():
    """requirement: displacement of Cattaneo's sphere to 1 %, on a coarse mesh already; it sticks in
    the middle and slips around it; forces balance.
    """
    exact = spheres.EXACT
    push = {"tangential_force": ["0 N", f"{spheres.PUSH / 2!r} N"]}
    sizes = dict.fromkeys(("radius", "block_radius", "block_height"), f"{spheres.RADIUS!r} m")
    geometry = spheres.TurnedBall(type="ball-on-block", half=True, **sizes)
    _, found = spheres.rubbed(geometry, push, elements=4, increments=1, method="nitsche")
    row, f = found.tangential[-1], found.last
    assert row.displacement_x == pytest.approx(exact.displacement(spheres.PUSH), rel=1e-2)
    r, c = np.hypot(f.x, f.y), exact.stick_radius(spheres.PUSH)
    for inside, sticking in ((r < 0.6 * c, 0.8), ((r > 1.1 * c) & (f.pressure > 0), 0.1)):
        found = np.average(f.status[inside] == 1, weights=f.weight[inside])
        assert (found > sticking) == (sticking > 0.5)
    assert f.weight @ f.shear_x == pytest.approx(-spheres.PUSH / 2, rel=1e-4)
    assert np.all(f.shear <= spheres.FRICTION * f.pressure * (1 + 1e-9))

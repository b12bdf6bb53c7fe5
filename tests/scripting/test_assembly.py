"""Models in Python of more than two bodies: several interfaces and holders, glued faces."""

from dataclasses import replace

from mpi4py import MPI

import dolfinx
import numpy as np
import pytest
from dolfinx.mesh import CellType, locate_entities_boundary, meshtags

import thermowear as tw

BELOW, ABOVE, END = 7, 8, 9
WIDTH, THICKNESS, FORCE, SPEED, K, FRICTION = 0.03, 0.02, 600.0, 0.1, 2e-14, 0.3
STEEL = tw.Material("2 GPa", 0.3, expansion=1e-5, conductivity=20.0)


def block(name, bottom, top, columns=6, rows=3, **sides):
    """Rectangle of quadrilaterals between two heights."""
    ends = [[0.0, bottom], [WIDTH, top]]
    divisions = columns, rows
    mesh = dolfinx.mesh.create_rectangle(MPI.COMM_SELF, ends, divisions, CellType.quadrilateral)
    below, above = (
        locate_entities_boundary(mesh, 1, lambda x, y=y: np.isclose(x[1], y)) for y in (bottom, top)
    )
    end = locate_entities_boundary(mesh, 1, lambda x: np.isclose(x[0], 0.0))
    facets = np.concatenate([below, above, end])
    order = np.argsort(facets)
    counts = [len(below), len(above), len(end)]
    tags = np.repeat(np.array([BELOW, ABOVE, END], np.int32), counts)
    marks = meshtags(mesh, 1, facets[order], tags[order])
    return tw.Body(name, mesh, None, marks, STEEL, **sides)


def settings(heat=None):
    return {"kinematics": "plane-strain", "thickness": THICKNESS, "heat": heat, "degree": 3}


def sliding(one, other, **given):
    return tw.Interface(
        one, other, friction=FRICTION, conductance=1e4, wear={one.body: tw.PowerWear(K)}, **given
    )


@pytest.fixture(scope="module")
def between():
    """A strip that slides between two blocks, and its faces."""
    left = block("left", 0.01, 0.02)
    strip, right = block("strip", 0.0, 0.01), block("right", -0.01, 0.0)
    upper = sliding(left.surface(BELOW), strip.surface(ABOVE))
    lower = sliding(right.surface(ABOVE), strip.surface(BELOW))
    model = tw.Model(
        [upper, lower],
        [
            tw.Holder(left.surface(ABOVE), force=FORCE),
            tw.Holder(right.surface(BELOW), free=()),
            tw.Holder(strip.surface(END), force=0.0),
        ],
        motions={strip: tw.Translation(SPEED, across=True)},
        **settings(),
    )
    return model, upper, lower


def test_a_strip_between_two_blocks(between):
    """requirement: each interface by itself: pressures, wear, and the names of the results."""
    model, upper, lower = between
    solution = model.steady()
    mean = FORCE / (WIDTH * THICKNESS)
    for face in (upper, lower):
        np.testing.assert_allclose(solution.pressure(face).values, mean, rtol=1e-9)
    assert set(solution.summary["contacts"]) == {"left-strip", "right-strip"}
    speeds = {
        name: holder["rigid_wear_velocity_m_per_s"]
        for name, holder in solution.summary["holders"].items()
    }
    rate = K * mean * SPEED
    assert speeds["left"] == pytest.approx(2 * rate, rel=1e-9)
    assert speeds["strip"] == pytest.approx(rate, rel=1e-9)
    with pytest.raises(tw.CaseError, match="must be an interface of the model"):
        solution.pressure(replace(upper, other=lower.one))
    with pytest.raises(tw.CaseError, match="is no body of this interface"):
        solution.wear(upper, lower.one.body)


def test_a_holder_that_bears_the_force_of_another(between):
    """requirement: the lower block is pressed by the reaction; faults in one line."""
    model, upper, lower = between
    left, right, strip = model.holders
    caliper = replace(right, free=("z",), direction=(0.0, 1.0))
    piston, hub = replace(left, reaction=caliper), replace(strip, free=(), force=None)
    floating = replace(model, holders=[piston, caliper, hub])
    solution, expected = floating.initial(), model.initial()
    for face in (upper, lower):
        found = solution.pressure(face).values
        np.testing.assert_allclose(found, expected.pressure(face).values, rtol=1e-9)
    for holders in ([piston, hub, right], [replace(left, reaction=right), right, strip]):
        with pytest.raises(tw.CaseError, match=r"^model: the reaction of the holder 'left' needs"):
            replace(model, holders=holders).initial()


def test_wear_in_time_of_two_interfaces(between):
    """requirement: worn volumes V = k F s at each interface."""
    model, upper, lower = between
    solution = model.transient(until="500 s")
    volume = K * FORCE * SPEED * 500.0
    for face in (upper, lower):
        worn = solution.wear(face, face.one.body)
        assert worn.weights @ worn.values == pytest.approx(volume, rel=1e-6)


@pytest.mark.parametrize("columns", [6, 7])
def test_a_glued_block_is_one_block(columns):
    """
    requirement: a block of two halves glued on each other, with meshes that match or not, presses,
    heats up and wears as one block does; heat passes the joint.
    """
    found = []
    for glued in (False, True):
        lower = block("lower", -0.01, 0.0, fixed=BELOW)
        whole = block("upper", 0.0, *((0.01, 6, 3) if glued else (0.02, 6, 6)))
        back = block("back", 0.01, 0.02, columns) if glued else whole
        ties = [tw.Tie(back.surface(BELOW), whole.surface(ABOVE))] if glued else []
        face = sliding(whole.surface(BELOW), lower.surface(ABOVE), partition=0.5)
        cooling = {back.surface(ABOVE): 2000.0, lower.surface(BELOW): 300.0}
        model = tw.Model(
            [face],
            [tw.Holder(back.surface(ABOVE), force=FORCE)],
            motions={whole: tw.Translation(SPEED, across=True)},
            ties=ties,
            **settings(tw.Heat(cooling=cooling)),
        )
        solution = model.initial()
        found.append(
            [
                solution.pressure(face),
                solution.surface_temperature(face, whole),
                solution.shape(face),
            ]
        )
    for one, other in zip(*found, strict=True):
        order = (np.argsort(v.points[:, 0], kind="stable") for v in (one, other))
        a, b = (v.values[k] for v, k in zip((one, other), order, strict=True))
        scale = np.ptp(a) if one.name == "temperature" else np.abs(a).max()
        np.testing.assert_allclose(b, a, rtol=0.0, atol=2e-3 * (scale or 1.0), err_msg=one.name)


def test_a_tie_needs_two_bodies():
    """requirement: faults of glued faces in one line."""
    body = block("one", 0.0, 0.01)
    with pytest.raises(tw.CaseError, match=r"^Tie: both faces are on the same body"):
        tw.Tie(body.surface(ABOVE), body.surface(BELOW))
    with pytest.raises(tw.CaseError, match=r"^Tie\.conductance: "):
        tw.Tie(body.surface(ABOVE), block("two", 0.0, 1.0).surface(BELOW), -1.0).in_model([body])


def test_a_strip_that_frets_between_two_blocks(between):
    """requirement: gross slip of both contacts: 2 mu F, V = k E / mu but for the energy lost while
    the first loads are applied at once; sliding motions are refused.
    """
    model, _, _ = between
    press, base, strip = model.holders
    pulled = tw.LoadHistory(["0 s", "1 s"], tangential_displacement=["0 um", "80 um"])
    still = replace(model, motions={}, holders=[press, base, replace(strip, history=pulled)])
    solution = still.fretting(increments=4)
    assert solution.summary["tangential_force_N"] == pytest.approx(2 * FRICTION * FORCE, rel=1e-6)
    for name in ("left-strip", "right-strip"):
        found = solution.summary["contacts"][name]
        assert found["friction_force_N"] == pytest.approx(FRICTION * FORCE, rel=1e-6)
        worn = K / FRICTION * found["dissipated_energy_J"]
        assert found["wear_volume_1_m3"] == pytest.approx(worn, rel=1e-4, abs=0.0)
    with pytest.raises(tw.CaseError, match="motions: not supported in a fretting analysis"):
        replace(still, motions=model.motions).fretting(increments=4)

"""Running-in step by step: looking, changing loads, stopping."""

from dataclasses import astuple, replace
from itertools import pairwise

import numpy as np
import pytest

import thermowear as tw

from ..case.starter import STEADY
from .from_case import python_model

SPEED, FORCE, WEAR = 0.1, 50e6 * np.pi * (0.12**2 - 0.02**2), 5e-14


@pytest.fixture(scope="module")
def cold():
    """The cold ring, its face and its law of wear as a function."""
    model, face, _ = python_model(STEADY, "mesh.degree=2", "mesh.elements=4")
    punch = model.bodies[0]
    worn = replace(face, wear={punch: lambda p, v: WEAR * p * v})
    return replace(model, interfaces=[worn], heat=None), worn, punch


def spent(state, face):
    """Wear volume of a power that is linear in the pressure and in the speed."""
    pressure = state.pressure(face)
    rates = WEAR * np.asarray(pressure) * SPEED * pressure.points[:, 0]
    return rates @ pressure.weights


def test_other_loads_and_speeds_on_the_way(cold):
    """requirement: wear goes on from the state of an earlier march, at the new load and speed.

    The pressure shifts between radii while the rate of volume stays Σ w k p v.
    """
    model, face, _ = cold
    first = list(model.march("100 s"))
    assert model.march("100 s").__next__().time == 0.0
    doubled = replace(
        model,
        holders=[replace(model.holders[0], force=2 * FORCE)],
        motions={model.bodies[0]: tw.Rotation(3 * SPEED)},
    )
    then = list(doubled.march("200 s", start=first[-1]))
    assert then[0].time > 100.0
    assert then[-1].time == 200.0
    assert np.asarray(then[-1].pressure(face)) @ then[-1].pressure(face).weights == pytest.approx(
        2 * FORCE, rel=1e-9
    )
    volumes = [
        sum(
            step.row.step * (spent(one, face) + spent(step, face)) / 2 * factor
            for one, step in pairwise(states)
        )
        for states, factor in ((first, 1), (then, 3))
    ]
    gained = first[-1].row.wear_volume_1, then[-1].row.wear_volume_1 - then[0].row.wear_volume_1
    assert gained == pytest.approx(volumes, rel=2e-3)


def test_a_law_of_one_s_own_wears_as_the_power_does(cold):
    """requirement: a plain function of arrays in place of a power gives its results."""
    model, face, punch = cold
    power = replace(model, interfaces=[replace(face, wear={punch: tw.PowerWear(WEAR)})])
    one, other = (list(m.march("steady", steady_tolerance=0.05))[-1] for m in (model, power))
    assert one.time == pytest.approx(other.time, rel=1e-6)
    np.testing.assert_allclose(one.pressure(face), other.pressure(face), rtol=1e-6)
    np.testing.assert_allclose(one.wear(face, punch), other.wear(face, punch), rtol=1e-6)


def test_saved_states(cold, tmp_path):
    """requirement: from the file of a state a march goes on bit by bit as from the state."""
    model, face, _ = cold
    kept = next(state for state in model.march("200 s") if state.time > 20)
    kept.save(tmp_path / "state.npz")
    again, other = (
        list(model.march("200 s", start=start)) for start in (kept, tmp_path / "state.npz")
    )
    rows = ([astuple(state.row) for state in states] for states in (again, other))
    np.testing.assert_array_equal(*rows)
    np.testing.assert_array_equal(again[-1].pressure(face), other[-1].pressure(face))
    with pytest.raises(tw.CaseError, match=r"state\.npz: is a state of other bodies"):
        next(replace(model, degree=3).march("200 s", start=tmp_path / "state.npz"))
    with pytest.raises(tw.CaseError, match=r"^march: .*none\.npz: there is no such file"):
        next(model.march("200 s", start=tmp_path / "none.npz"))


def test_states_stay_valid(cold):
    """requirement: a state answers after the loop has gone on, and the march may be left."""
    model, face, punch = cold
    kept, before = [], []
    for state in model.march("100 s"):
        kept.append(state)
        before.append(np.asarray(state.pressure(face)))
        if len(kept) == 4:
            break
    again = [np.asarray(state.pressure(face)) for state in kept]
    np.testing.assert_array_equal(before, again)
    assert np.all(np.diff([np.max(state.wear(face, punch)) for state in kept]) > 0)


def test_a_hot_march_in_parts():
    """requirement: in parts to the millisecond, each from the last state: all are reached."""
    model, _, _ = python_model("disk-brake-stop", "mesh.degree=2", "mesh.elements=3")
    state = None
    for end in (0.713, 0.713 + 0.713, 3 * 0.713, 2.5):
        states = list(model.march(end, start=state, tolerance=1e-2))
        state = states[-1]
        assert state.time == pytest.approx(end, rel=1e-9)
        assert len(states) < 40
    assert not list(model.march(2.5 + 3e-13, start=state, tolerance=1e-2))

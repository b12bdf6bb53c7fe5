"""Coated faces of models in Python."""

import numpy as np
import pytest

import thermowear as tw

from .test_composite_wear import FORCE, HEIGHT, LEFT, RIGHT, SPEED, WIDTH, block, with_wear

THICK = ["2 um", 1e-6]


@pytest.fixture(scope="module")
def model():
    upper, lower = block("upper", 0.0), block("lower", -HEIGHT, fixed=7)
    return tw.Model(
        [tw.Interface(upper.surface(7), lower.surface(8), wear={upper: tw.PowerWear(5e-13)})],
        [tw.Holder(upper.surface(8), force=FORCE)],
        motions={upper: tw.Translation(SPEED)},
        kinematics="plane-strain",
        thickness=0.02,
    )


def coated(substrate):
    """Layers by a law with units and by a function."""
    laws = [tw.PowerWear("2e-8 1/MPa"), lambda p, v: 8e-14 * p * v]
    return tw.LayeredWear(THICK, laws, substrate)


@pytest.mark.parametrize("substrate", [tw.PowerWear(5e-13), "5e-13/Pa*p*v"])
def test_layers(model, substrate):
    """
    requirement: Σ V_i/k_i = F s, whatever kind of law each layer has; steady by the substrate.
    """
    layered, end = with_wear(model, coated(substrate)), 3e3
    result = layered.transient(end).result
    volumes = result.summary["layer_volumes_1_m3"]
    assert min(volumes) > 0
    done = np.array(volumes) @ (1 / np.array([2e-14, 8e-14, 5e-13]))
    assert done == pytest.approx(FORCE * SPEED * end, rel=1e-9)
    assert volumes[:2] == pytest.approx([2e-6 * WIDTH * 0.02, 1e-6 * WIDTH * 0.02], rel=1e-9)
    found, known = (each.steady().result for each in (layered, model))
    np.testing.assert_allclose(found.interface.pressure, known.interface.pressure, rtol=1e-9)
    np.testing.assert_allclose(found.interface.wear_rate_1, known.interface.wear_rate_1, rtol=1e-9)


@pytest.mark.slow
def test_the_loop_shows_what_is_left(model):
    """
    requirement: state by state, of the layers that are given.
    """
    layered, left = with_wear(model, coated("5e-13/Pa*p*v")), []
    for state in layered.march("3e3 s"):
        left.append(state.snapshot.interface.coating_left_1.max())
    assert left[0] == pytest.approx(3e-6, rel=1e-12, abs=0.0)
    assert left[-1] == 0.0
    assert np.all(np.diff(left) <= 0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((["2 um"], ["1e-14/Pa*p*v"] * 2), "LayeredWear: has 2 laws for 1 layers"),
        (([], []), "LayeredWear: has 0 laws for 0 layers"),
        ((["0 um"], ["1e-14/Pa*p*v"]), r"LayeredWear\.thickness: found .*; must be greater than 0"),
        ((["2 s"], ["1e-14/Pa*p*v"]), r"LayeredWear\.thickness: "),
        ((["2 um"], ["1e-14 m/s"]), r"LayeredWear\.laws: there is wear without pressure"),
    ],
)
def test_faults(arguments, message):
    with pytest.raises(tw.CaseError, match=message):
        tw.LayeredWear(*arguments, "1e-13/Pa*p*v")


def test_refused_combinations(model):
    """
    requirement: no layers inside layers, nor on faces of several materials.
    """
    one = tw.LayeredWear([1e-6], ["1e-14/Pa*p*v"], "1e-13/Pa*p*v")
    with pytest.raises(tw.CaseError, match="a layer cannot have layers"):
        tw.LayeredWear([1e-6], [one], "1e-13/Pa*p*v")
    with pytest.raises(tw.CaseError, match="tag 12: must wear in place, without layers"):
        with_wear(model, {LEFT: one, RIGHT: "1e-13/Pa*p*v"}).steady()
    with pytest.raises(tw.CaseError, match="does not support contact faces with layers"):
        with_wear(model, one).reciprocating("1 mm", "2 Hz", end_time=10.0)

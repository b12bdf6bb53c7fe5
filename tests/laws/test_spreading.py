"""Where wear goes."""

import numpy as np
import pytest

from thermowear import ComputationError
from thermowear.laws import (
    InPlace,
    Share,
    Track,
    WearLaw,
    contact_patch,
    rotation,
    steady_pressure,
    translation,
)

LOCAL = np.array([1.0, 4.0, 0.0, 2.5])
LENGTHS = np.array([0.1, 0.2, 0.2, 0.1])


@pytest.mark.parametrize(
    ("way", "expected"),
    [
        (InPlace(), LOCAL),
        (Share(0.125), LOCAL / 8),
        (Track(LENGTHS / 3.0), np.full(4, (0.1 + 0.8 + 0.25) / 3)),
    ],
)
def test_rates(way, expected):
    """requirement: in place, a share of the time, or the mean over the length of the track."""
    np.testing.assert_allclose(way.rate(LOCAL), expected, rtol=1e-14)
    np.testing.assert_allclose(way.operator(4) @ LOCAL, expected, rtol=1e-14)
    assert way.operator(4).shape == (4, 4)


def test_volume_is_kept():
    """requirement: what a strip loses over its whole track is what the contact takes off it."""
    track = 3.0
    rate = Track(LENGTHS / track).rate(LOCAL)
    assert track * rate[0] == pytest.approx(LENGTHS @ LOCAL, rel=1e-14)


def test_share_and_row_say_the_same():
    """requirement: ``rate = share local + row·local``, of which the principle makes use."""
    for way in (InPlace(), Share(0.3), Track(LENGTHS)):
        common = 0.0 if way.row is None else way.row @ LOCAL
        np.testing.assert_allclose(way.rate(LOCAL), way.share * LOCAL + common)


def test_a_share_of_the_wear():
    """requirement: under a pad of angle θ the disk wears θ/2π of what it would in place."""
    laws = [WearLaw(5e-14), WearLaw(8e-21, 2.0)]
    x, w = np.polynomial.legendre.leggauss(40)
    r = 0.07 + 0.05 * x
    weights, down, load = 2 * np.pi * r * w * 0.05, np.ones((40, 1)), np.array([4e6])
    shared = steady_pressure(
        weights, down, down, load, laws, 10 * r, spread=[InPlace(), Share(0.1)]
    )
    tenth = steady_pressure(weights, down, down, load, [laws[0], WearLaw(8e-22, 2.0)], 10 * r)
    np.testing.assert_allclose(shared.pressure, tenth.pressure, rtol=1e-11)
    np.testing.assert_allclose(shared.rates[1], tenth.rates[1], rtol=1e-11)


def block_on_strip(tilting):
    x, w = np.polynomial.legendre.leggauss(30)
    z, length = 0.1 + 0.05 * x, 0.05 * w
    motions = [rotation((0, 1, 0), (0, 0, 0))]
    if tilting:
        motions.append(translation((1, 0, 0)))
    patch = contact_patch(
        np.column_stack([np.full(30, 0.04), 0 * z, z]), length * 0.01, (1, 0, 0), motions, 1.0,
        0.3, (0, 0, -1),
    )  # fmt: skip
    return z, patch, Track(length / 2.0)


@pytest.mark.parametrize("tilting", [False, True])
@pytest.mark.parametrize(
    ("b_1", "b_2", "κ_2"), [(1.0, 1.0, 4e-12), (2.0, 0.5, 4e-12), (0.5, 3.0, 1e-13)]
)
def test_wear_that_is_spread_over_a_track(tilting, b_1, b_2, κ_2):
    """requirement: the strip wears everywhere at ``1/L ∫ Z p^b ds``; both rates add up to V·n."""
    z, patch, track = block_on_strip(tilting)
    laws = [WearLaw(1e-13 * 1e6 ** (1 - b_1), b_1), WearLaw(κ_2 * 1e6 ** (1 - b_2), b_2)]
    load = patch.force_modes.T @ (patch.weights * 1e6 * (z / 0.1) ** 2)
    steady = patch.steady(load, laws, [InPlace(), track])
    p = steady.pressure
    mean = track.row @ laws[1].rate(p, patch.speed)
    np.testing.assert_allclose(steady.rates[1], mean, rtol=1e-12)
    assert mean > 0.05 * steady.approach.max()
    touching = p > 0
    total = laws[0].rate(p, patch.speed) + mean
    scale = steady.approach.max()
    np.testing.assert_allclose(total[touching], steady.approach[touching], atol=1e-12 * scale)
    assert np.all(steady.approach[~touching] <= mean + 1e-12 * scale)
    np.testing.assert_allclose(
        patch.force_modes.T @ (patch.weights * p), load, atol=1e-11 * np.abs(load).max()
    )
    assert steady.dissipation == pytest.approx(load @ steady.velocity, rel=1e-10)


def test_a_track_does_not_shape_what_only_descends():
    """requirement: a uniform rate of the strip adds to the descent and leaves the pressure."""
    z, patch, track = block_on_strip(tilting=True)
    laws = [WearLaw(1e-13), WearLaw(4e-12)]
    load = patch.force_modes.T @ (patch.weights * 1e6 * (z / 0.1))
    both = patch.steady(load, laws, [InPlace(), track])
    alone = patch.steady(load, laws[:1])
    np.testing.assert_allclose(both.pressure, alone.pressure, rtol=1e-10)
    assert both.velocity[1] == pytest.approx(alone.velocity[1] + both.rates[1][0], rel=1e-10)


def test_wear_of_tracks_only_leaves_the_pressure_open():
    """requirement: what does not determine a pressure is said, not made up."""
    _, patch, track = block_on_strip(tilting=False)
    with pytest.raises(ComputationError, match="spread over a track"):
        patch.steady([10.0], [WearLaw(1e-13)], [track])

"""Distribution of wear: in place, as a share of the time, or along a track."""

import numpy as np
import pytest

from thermowear import ComputationError
from thermowear.laws import (
    Distribution,
    InPlace,
    LocalState,
    PowerWear,
    contact_patch,
    rings,
    rotation,
    round_duty,
    steady_pressure,
    translation,
    uniform_track,
)

LOCAL = np.array([1.0, 4.0, 0.0, 2.5])
LENGTHS = np.array([0.1, 0.2, 0.2, 0.1])


@pytest.mark.parametrize(
    ("way", "expected"),
    [
        (InPlace(), LOCAL),
        (Distribution(0.125), LOCAL / 8),
        (uniform_track(LENGTHS / 3.0), np.full(4, (0.1 + 0.8 + 0.25) / 3)),
    ],
)
def test_rates(way, expected):
    """requirement: in place, a share of the time, or the mean over the length of the track."""
    np.testing.assert_allclose(way.rate(np.eye(4)) @ LOCAL, expected, rtol=1e-14)
    assert way.rate(np.eye(4)).shape == (4, 4)


def test_volume_is_kept():
    """requirement: what a strip loses over its whole track is what the contact takes off it."""
    track = 3.0
    rate = uniform_track(LENGTHS / track).rate(np.eye(4)) @ LOCAL
    assert track * rate[0] == pytest.approx(LENGTHS @ LOCAL, rel=1e-14)


def test_share_and_rows_say_the_same():
    """requirement: ``rate = share local + reach (rows·local)``, as the principle has it."""
    turning = rings(np.array([1.0, 2.0, 2.0, 3.0]), np.array([1.0, 2.0, 1.0, 2.0]), 0.2)
    for way in (InPlace(), Distribution(0.3), uniform_track(LENGTHS), turning):
        common = 0.0 if way.means is None else way.means.reach @ (way.means.rows @ LOCAL)
        np.testing.assert_allclose(way.rate(np.eye(4)) @ LOCAL, way.share * LOCAL + common)


def test_circles_under_a_round_pin():
    """requirement: a uniform rate wears each circle for the time that it is under the pin."""
    d, a = 20e-3, 4e-3
    x, w = np.polynomial.legendre.leggauss(30)
    r, θ = np.meshgrid(a * (x + 1) / 2, 2 * np.pi * np.arange(60) / 60, indexing="ij")
    weights = (np.repeat(w[:, None], 60, axis=1) * a / 2 * r * 2 * np.pi / 60).ravel()
    radii = np.hypot(d + r * np.cos(θ), r * np.sin(θ)).ravel()
    duty = round_duty(radii, d, a)
    at_axis = 2 * np.arcsin(a / 2 / d) * 2 / (2 * np.pi)
    assert round_duty(np.array([d]), d, a)[0] == pytest.approx(at_axis, rel=1e-12)
    assert (weights / duty).sum() == pytest.approx(np.pi * ((d + a) ** 2 - (d - a) ** 2), rel=1e-2)
    way = rings(radii, weights, duty)
    even = way.rate(np.ones(len(radii)))
    inner = np.abs(radii - d) < 0.7 * a
    np.testing.assert_allclose(even[inner], duty[inner], rtol=0.03)
    local = 1.0 + np.cos(40 * radii / d)
    assert weights / way.coverage @ way.rate(local) == pytest.approx(weights @ local, rel=1e-12)


def test_a_share_of_the_wear():
    """requirement: under a pad of angle θ the disk wears θ/2π of what it would in place."""
    laws = [PowerWear(5e-14), PowerWear(8e-21, 2.0)]
    x, w = np.polynomial.legendre.leggauss(40)
    r = 0.07 + 0.05 * x
    weights, down, load = 2 * np.pi * r * w * 0.05, np.ones((40, 1)), np.array([4e6])
    shared = steady_pressure(
        weights, down, down, load, laws, 10 * r, spread=[InPlace(), Distribution(0.1)]
    )
    tenth = steady_pressure(weights, down, down, load, [laws[0], PowerWear(8e-22, 2.0)], 10 * r)
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
    return z, patch, uniform_track(length / 2.0)


@pytest.mark.parametrize("tilting", [False, True])
@pytest.mark.parametrize(
    ("b_1", "b_2", "κ_2"), [(1.0, 1.0, 4e-12), (2.0, 0.5, 4e-12), (0.5, 3.0, 1e-13)]
)
def test_wear_that_is_spread_over_a_track(tilting, b_1, b_2, κ_2):
    """requirement: the strip wears everywhere at ``1/L ∫ Z p^b ds``; both rates add up to V·n."""
    z, patch, track = block_on_strip(tilting)
    laws = [PowerWear(1e-13 * 1e6 ** (1 - b_1), b_1), PowerWear(κ_2 * 1e6 ** (1 - b_2), b_2)]
    load = patch.force_modes.T @ (patch.weights * 1e6 * (z / 0.1) ** 2)
    steady = patch.steady(load, laws, [InPlace(), track])
    p = steady.pressure
    mean = track.means.rows[0] @ laws[1].value(LocalState(p, patch.speed))
    np.testing.assert_allclose(steady.rates[1], mean, rtol=1e-12)
    assert mean > 0.05 * steady.approach.max()
    touching = p > 0
    total = laws[0].value(LocalState(p, patch.speed)) + mean
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
    laws = [PowerWear(1e-13), PowerWear(4e-12)]
    load = patch.force_modes.T @ (patch.weights * 1e6 * (z / 0.1))
    both = patch.steady(load, laws, [InPlace(), track])
    alone = patch.steady(load, laws[:1])
    np.testing.assert_allclose(both.pressure, alone.pressure, rtol=1e-10)
    assert both.velocity[1] == pytest.approx(alone.velocity[1] + both.rates[1][0], rel=1e-10)


def test_wear_of_tracks_only_leaves_the_pressure_open():
    """requirement: what does not determine a pressure is said, not made up."""
    _, patch, track = block_on_strip(tilting=False)
    with pytest.raises(ComputationError, match="spread uniformly along tracks"):
        patch.steady([10.0], [PowerWear(1e-13)], [track])


def disk_under_a_pad(n=12, m=9):
    """Points of a sector of 60 degrees in polar coordinates, its areas, and where they lie."""
    x, w = np.polynomial.legendre.leggauss(n)
    y, v = np.polynomial.legendre.leggauss(m)
    r, angle = 0.1 + 0.02 * x, np.pi / 6 * y
    weights = np.outer(r * w * 0.02, v * np.pi / 6)
    radii, angles = np.meshgrid(r, angle, indexing="ij")
    return radii.ravel(), angles.ravel(), weights.ravel()


def test_a_disk_wears_at_each_radius_by_the_mean_along_its_circle():
    """requirement: the mean of the local rate round the axis, by quadrature; no volume is lost."""
    r, angle, w = disk_under_a_pad()
    local = r * (1 + 0.5 * angle + angle**2)
    found = rings(r, w, 1 / 6).rate(np.eye(len(r))) @ local
    mean = r * (1 + (np.pi / 6) ** 2 / 3) / 6
    np.testing.assert_allclose(found, mean, rtol=1e-12)
    assert w @ found == pytest.approx(w @ local / 6, rel=1e-13)


def test_rings_of_scattered_points():
    """requirement: the same where no two points have one radius, to the width of the rings."""
    rng = np.random.default_rng(1)
    r, angle = np.sqrt(rng.uniform(0.08**2, 0.12**2, 4000)), rng.uniform(-0.5, 0.5, 4000)
    way = rings(r, np.ones(4000), 0.2)
    np.testing.assert_allclose(
        way.means.reach @ (way.means.rows @ np.full(4000, 3.0)), 0.6, rtol=1e-12
    )
    local = r * (1 + angle)
    found = way.means.reach @ (way.means.rows @ local)
    assert found.min() > 0
    assert found.sum() == pytest.approx(0.2 * local.sum(), rel=1e-12)
    np.testing.assert_allclose(found, 0.2 * r, rtol=0.1)


@pytest.mark.parametrize(("b_1", "b_2"), [(1.0, 1.0), (2.0, 0.5)])
def test_the_principle_with_a_disk_that_wears_along_its_track(b_1, b_2):
    """requirement: where it presses, pad and disk together wear as the pad approaches."""
    r, angle, w = disk_under_a_pad()
    way = rings(r, w, 1 / 6)
    laws = [PowerWear(1e-13 * 1e6 ** (1 - b_1), b_1), PowerWear(9e-13 * 1e6 ** (1 - b_2), b_2)]
    x, y = r * np.cos(angle), r * np.sin(angle)
    modes = np.column_stack([np.ones(len(r)), x - 0.1, y])
    load = np.array([1e3, 2.0, 1.0])
    steady = steady_pressure(w, modes, modes, load, laws, 10 * r, [InPlace(), way])
    p = steady.pressure
    disk = way.rate(np.eye(len(r))) @ laws[1].value(LocalState(p, 10 * r))
    np.testing.assert_allclose(steady.rates[1], disk, rtol=1e-12)
    total, scale = laws[0].value(LocalState(p, 10 * r)) + disk, steady.approach.max()
    np.testing.assert_allclose(total[p > 0], steady.approach[p > 0], atol=1e-10 * scale)
    np.testing.assert_allclose(modes.T @ (w * p), load, atol=1e-9 * 1e3)
    assert np.ptp(p[np.isclose(r, r[0])]) > 0.1 * p.max()

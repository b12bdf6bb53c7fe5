"""Where wear goes."""

import numpy as np
import pytest

from thermowear.laws import InPlace, Share, Track

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

"""Half-spaces under a flux that falls to zero."""

import numpy as np
import pytest
from scipy.integrate import quad

from thermowear.reference.heat import braking_peak, braking_rise

EFFUSIVITY, FLUX, STOP = 13400.0, 2e6, 4.0


@pytest.mark.parametrize("time", [0.01, 1.0, 4.0, 4.5, 40.0])
def test_duhamel(time):
    """requirement: the sum of what every moment's flux leaves behind, q/(e √(π (t - t')))."""

    def left(root):  # t' = t - root²
        return 2 * FLUX * max(1 - (time - root**2) / STOP, 0.0)

    kink = np.sqrt(max(time - STOP, 0.0))
    total, _ = quad(left, 0.0, np.sqrt(time), points=[kink] if kink else None)
    expected = total / (EFFUSIVITY * np.sqrt(np.pi))
    assert braking_rise(EFFUSIVITY, FLUX, STOP, time) == pytest.approx(expected, rel=1e-8)


def test_hottest_half_way():
    time = np.linspace(0.0, 20.0, 2001)
    rises = braking_rise(EFFUSIVITY, FLUX, STOP, time)
    assert time[rises.argmax()] == pytest.approx(STOP / 2)
    assert rises.max() == pytest.approx(braking_peak(EFFUSIVITY, FLUX, STOP), rel=1e-12)

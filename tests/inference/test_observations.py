"""Measured values."""

import numpy as np
import pytest

from thermowear.inference import Observations


def test_residuals_in_standard_deviations():
    """requirement: (predicted - observed)/σ, also of several predictions, with a common σ."""
    observed = Observations([1.0, 2.0], 0.5, ("depth", "mass"))
    assert observed.residuals([2.0, 2.0]).tolist() == [2.0, 0.0]
    assert observed.residuals(np.ones((3, 2))).shape == (3, 2)
    assert len(observed) == 2


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([1.0, np.nan], 1.0, ("a", "b")), "b: observed value nan"),
        (([1.0, 2.0], [1.0, 0.0], ("a", "b")), "b: standard deviation 0; must be positive"),
        (([1.0, 2.0], 1.0, ("a",)), "1 labels for 2 observations"),
        (([], 1.0, ()), "must be a list"),
    ],
)
def test_invalid_observations_are_refused(arguments, message):
    """requirement: one sentence with the label and the fault."""
    with pytest.raises(ValueError, match=message):
        Observations(*arguments)

"""Keys of a stability analysis with hot spots."""

import pytest

from thermowear.case import load
from thermowear.errors import CaseError
from thermowear.model.analyses import StabilityAnalysis
from thermowear.simulation.from_case.analysis import analysis_of

from .starter import tables

NAME = "disk-brake-stability"


def analysis(**keys):
    return analysis_of(load(tables(NAME, {f"analysis.{key}": v for key, v in keys.items()})))


def test_numbers():
    """requirement: a number stands for all up to it; a list for itself."""
    assert analysis(hot_spots=3).hot_spots == (0, 1, 2, 3)
    assert analysis(hot_spots=[5, 2]).hot_spots == (5, 2)
    assert analysis(hot_spots=3).mirror == ("disk_middle",)
    assert analysis(hot_spots=3, mirror="disk_outside").mirror == ("disk_outside",)
    assert analysis().waves == ()


def test_wave_lengths():
    """requirement: wave lengths give wave numbers."""
    found = StabilityAnalysis(wave_lengths=(0.5,))
    assert found.waves == (pytest.approx(12.566370614359172),)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"hot_spots": [2, 2]}, "analysis.hot_spots: .*contains 2 twice"),
        ({"hot_spots": -1}, "analysis.hot_spots"),
        ({"hot_spots": True}, "analysis.hot_spots"),
        ({"hot_spots": 2.5}, "analysis.hot_spots"),
        ({"hot_spots": [1.5]}, r"analysis.hot_spots.0"),
        ({"hot_spots": 5000}, "analysis.hot_spots"),
        ({"hot_spots": 3, "wave_lengths": ["1 m"]}, "analysis.wave_lengths: only one of"),
        ({"mirror": "disk_middle"}, "analysis.mirror: needs hot_spots or wave_lengths"),
        ({"wave_lengths": ["-1 m"]}, "analysis.wave_lengths"),
    ],
)
def test_refused(keys, message):
    """requirement: faults are reported with the path of the key."""
    with pytest.raises(CaseError, match=message):
        analysis(**keys)

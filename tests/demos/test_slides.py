"""The comparisons of the gallery: what each of them shows, asserted."""

from __future__ import annotations

import numpy as np
import pytest

from ..case.starter import solved
from ..conftest import demo_script

COARSE = ("mesh.degree=3", "mesh.elements=8")


@pytest.fixture(scope="module")
def slides():
    """The script as a module."""
    return {slide.name: slide for slide in demo_script("slides").SLIDES}


def runs(slide):
    """Results of the runs of a slide on coarse meshes, by their labels."""
    case = slide.case.replace("_", "-")
    return {label: solved(case, None, *COARSE, *sets) for label, sets in slide.runs.items()}


def peaks(results):
    return np.array([result.summary["max_pressure_Pa"] for result in results.values()])


def test_friction_of_a_block_on_a_disk(slides):
    """requirement: one pressure, as many shapes as frictions."""
    results = runs(slides["block_on_disk-friction"])
    assert np.ptp(peaks(results)) < 1e-6 * peaks(results)[0]
    shapes = [result.interface.shape for result in results.values()]
    tilts = [shape[0] - shape[-1] for shape in shapes]
    assert np.all(np.diff(tilts) > 0)  # the leading end, on the left, wears less in shape


def test_heat_of_a_block_on_a_disk(slides):
    """requirement: faster is hotter and bulges more; clockwise mirrors."""
    results = runs(slides["block_on_disk-heat"])
    assert np.ptp(peaks(results)) < 1e-6 * peaks(results)[0]
    hottest = [result.summary["max_temperature_K"] for result in results.values()]
    assert hottest[0] == pytest.approx(293.15, abs=1e-3)
    assert np.all(np.diff(hottest[:3]) > 0.5)
    last, mirrored = (result.interface.shape for result in list(results.values())[2:])
    assert last == pytest.approx(mirrored[::-1], abs=1e-6 * np.ptp(last))


def test_senses_of_a_ring_segment(slides):
    """requirement: the sense of rotation decides how hard it presses; wear evens the corner out."""
    unworn, left, right = peaks(runs(slides["ring_segment_on_disk-senses"]))
    assert left / right == pytest.approx(6.780719 / 5.882013, rel=1e-4)
    assert unworn > 2 * left


def test_senses_of_a_drum_brake(slides):
    """requirement: the leading shoe presses more than twice as hard as the trailing one."""
    leading, trailing = peaks(runs(slides["drum_brake-senses"]))
    assert 2.5 < leading / trailing < 4.0


def test_senses_of_a_pivoted_block(slides):
    """requirement: the figures of special case 5."""
    found = peaks(runs(slides["pivoted_block-senses"]))
    assert found == pytest.approx([3.114187e6, 2.493075e6, 2.12954e6], rel=1e-5)


def test_friction_of_a_tilting_block(slides):
    """requirement: the line tilts with friction until the trailing edge lifts off."""
    results = list(runs(slides["punch_on_strip-friction"]).values())
    last = [result.interface.pressure[-1] for result in results]
    assert np.all(np.diff(last) < 0)
    assert last[-1] == 0.0
    assert last[-2] > 0.0


def test_exponents_of_the_ring(slides):
    """requirement: pressures by the law of wear, hot or cold; heat turns the shape round."""
    results = runs(slides["annular_punch-exponents"])
    found = peaks(results)
    assert found[:3] == pytest.approx([488.347e6, 175e6, 95.8245e6], rel=1e-4)
    assert found[3:] == pytest.approx(found[:3], rel=1e-9)
    for k, result in enumerate(results.values()):
        outside_higher = result.interface.shape[-1] > result.interface.shape[len(found) * 3]
        assert outside_higher == (k >= 3)

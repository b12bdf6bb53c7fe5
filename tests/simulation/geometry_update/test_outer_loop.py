"""Bodies that are worn through: time and place against the wear depths of rigid bodies."""

import numpy as np
import pytest

from tests.simulation.space import PUNCH
from thermowear import load, run
from thermowear.simulation.geometry_update import outer_loop
from thermowear.simulation.runtime.observer import Observer

STRIP = {
    "title": "punch in a guide",
    "model": "plane-strain",
    "geometry": {
        "type": "punch-on-strip",
        "width": "40 mm",
        "height": "20 mm",
        "strip_length": "80 mm",
        "strip_height": "20 mm",
        "thickness": "10 mm",
    },
    "mesh": {"degree": 2, "elements": 6, "grading": 0.5},
    "bodies": {
        "punch": {"young_modulus": "200 GPa", "poisson_ratio": 0.3},
        "strip": {"like": "punch"},
    },
    "load": {"force": "4 kN"},  # 10 MPa
    "motion": {"velocity": "10 mm/s"},
    "contact": {"friction": 0.0},
    "wear": {"punch": {"coefficient": "1e-4 1/MPa", "per": "pressure"}},
    "analysis": {"type": "transient", "end_time": "1 h", "tolerance": 1e-2},
}
LEFT = 1 - outer_loop._NOTHING / 2
"""Part of the thickness whose loss ends a run, to the tolerance of the event."""


class Notes(Observer):
    def __init__(self):
        self.told = []

    def note(self, text):
        self.told.append(text)


def worn_through(tables, *overrides):
    notes = Notes()
    result = run(load(tables, overrides), observer=notes)
    assert result.stopped is None
    (told,) = [text for text in notes.told if "worn through" in text]
    return result, told


@pytest.mark.parametrize("update", ['"never"', '"auto"'])
def test_a_guided_punch_is_worn_through_when_its_height_is_used_up(update):
    """requirement: t = H / (k p v), whether the wear stays in the gap or the mesh follows it."""
    result, told = worn_through(STRIP, f"wear.update={update}")
    time = 20e-3 / (1e-4 / 1e6 * 10e6 * 10e-3)
    assert result.summary["time_s"] == pytest.approx(LEFT * time, rel=2e-3)
    assert "punch is worn through at t = " in told
    assert result.history[-1].max_wear_1 <= 20e-3
    steps = np.array([row.step for row in result.history[1:]])
    assert steps[-4:].max() > 2e-3 * time  # no creeping towards the end


def test_a_tilting_punch_in_space_is_worn_through_at_its_deepest_edge():
    """requirement: the steady pressure of a load off the middle by e is p_m (1 + 12 e x / b²)."""
    tables = PUNCH | {
        "wear": {"punch": {"coefficient": "1e-3 1/MPa", "per": "pressure"}, "update": "never"},
        "contact": {"friction": 0.0},
        "holder": {"free": ["z", "rotation-y"]},
        "mesh": {"degree": 2, "elements": 3, "grading": 0.5},
        "analysis": {"type": "transient", "end_time": "1000 h", "tolerance": 1e-2},
    }
    result, told = worn_through(tables)
    mean = 10e3 / (60e-3 * 80e-3)
    points = result.interface.x
    deepest = 1 + 12 * 5 * np.abs(points).max() * 1e3 / 60**2
    time = 50e-3 / (1e-3 / 1e6 * mean * 5e-3) / deepest
    assert result.summary["time_s"] == pytest.approx(LEFT * time, rel=5e-3)
    assert "punch is worn through" in told
    assert f"x = {-np.abs(points).max():.3g}"[:9] in told


def test_a_disk_worn_on_both_sides_is_worn_through_at_half_the_depth():
    """requirement: both faces of a strip share its thickness: t = H / (2 k p v)."""
    block = {"x": ["0 mm", "40 mm"], "height": "20 mm"}
    tables = {
        "title": "strip between blocks",
        "model": "plane-strain",
        "geometry": {
            "type": "stack",
            "thickness": "10 mm",
            "layers": {"upper": block, "strip": block | {"height": "6 mm"}, "lower": block},
        },
        "mesh": {"degree": 2, "elements": 4, "grading": 0.5},
        "bodies": {
            "upper": {"young_modulus": "200 GPa", "poisson_ratio": 0.3},
            "strip": {"like": "upper"},
            "lower": {"like": "upper"},
        },
        "contact": {"friction": 0.0},
        "contacts": {
            "top": {"between": ["upper_bottom", "strip_top"]},
            "bottom": {"between": ["strip_bottom", "lower_top"]},
        },
        "holders": {
            "press": {"surface": "upper_top", "force": "4 kN"},
            "frame": {"surface": "lower_bottom", "free": []},
            "guide": {"surface": "strip_inside", "free": ["z"], "force": "0 N"},
        },
        "motions": {"strip": {"velocity": "10 mm/s"}},
        "wear": {"strip": {"coefficient": "1e-4 1/MPa", "per": "pressure"}, "update": "never"},
        "analysis": {"type": "transient", "end_time": "1 h", "tolerance": 1e-2},
    }
    result, told = worn_through(tables)
    time = 6e-3 / (2 * 1e-4 / 1e6 * 10e6 * 10e-3)
    assert result.summary["time_s"] == pytest.approx(LEFT * time, rel=2e-2)
    assert "strip is worn through" in told


def test_rays_end_at_the_far_side_of_a_tilted_body():
    """requirement: lengths of rays across a wedge, and none along a side, by trigonometry."""
    corners = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 1.0]])
    pieces = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)[1:]
    x = np.linspace(0.1, 3.9, 7)
    starts = np.column_stack([x, np.zeros_like(x)])
    found = outer_loop._lengths(pieces, starts, np.tile([0.0, 1.0], (7, 1)))
    assert found == pytest.approx(1 + x / 2)

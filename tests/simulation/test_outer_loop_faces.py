"""Moved meshes whose faces are round, upright, tilted or grow: how nodes, order and ends behave."""

import numpy as np
import pytest

from thermowear.simulation import Observer
from thermowear.simulation.from_case import run
from thermowear.verification.check import run_starter, starter

SMALL = ("mesh.degree=3", "mesh.elements=12")


def until(time):
    return f'analysis={{type="transient", end_time="{time} s", tolerance=1e-3}}'


def assert_sound(result, least_updates, largest_change):
    """Updates lose no volume, spoil no cells, and hardly disturb what wears in after them."""
    summary = result.summary
    assert summary["geometry_change"] < largest_change
    assert result.stopped is None
    assert summary["geometry_updates"] >= least_updates
    assert summary["geometry_volume_error"] < 1e-6
    assert summary["geometry_smallest_scaled_jacobian"] > 0.5


def test_a_face_keeps_its_order_while_it_wears():
    """The lining of a shoe ends at the same x on both sides, until wear makes one end come first.

    requirement: the mesh is where it was worn to; the pressure of the leading shoe in the end.
    """
    shoe = 'wear.shoe.coefficient="1e-5 1/MPa"'
    worn = run_starter("drum-brake", *SMALL, until(2000), shoe, "wear.update=0.005")
    assert_sound(worn, 8, 0.1)
    i = worn.interface
    radius = np.hypot(i.x, i.y)
    assert radius == pytest.approx(0.1 - i.wear_1, abs=0.01 * i.wear_1.max())
    lost = worn.summary["geometry_volume_1_m3"]
    assert lost == pytest.approx(worn.summary["wear_volume_1_m3"], rel=1e-3)
    # a shoe that turns about its pivot presses with the sine of the angle from the pivot
    angle = np.arctan2(i.x, i.y)
    lever = np.sin(np.pi - angle)
    assert i.pressure / lever == pytest.approx((i.pressure / lever).mean(), rel=0.2)


@pytest.mark.slow
def test_updates_are_as_frequent_as_they_must_be():
    """requirement: chosen by what they change: far more than fixed ones where that is much."""
    shoe = 'wear.shoe.coefficient="1e-5 1/MPa"'
    fixed, automatic = (
        run_starter("drum-brake", *SMALL, until(1000), shoe, f"wear.update={update}").summary
        for update in (0.01, '"auto"')
    )
    assert fixed["geometry_updates"] <= 4
    assert automatic["geometry_updates"] > 2 * fixed["geometry_updates"]


@pytest.mark.slow
def test_nodes_of_a_round_face_do_not_cross_its_sides():
    """A block on a disk: its sides are upright, its normals are not; a tenth of it worn off."""
    block = 'wear.block.coefficient="1e-5 1/MPa"'
    worn = run_starter("block-on-disk", *SMALL, until(1e4), block, "wear.update=0.01")
    assert_sound(worn, 4, 0.01)
    i = worn.interface
    assert np.abs(i.x).max() == pytest.approx(0.02 * np.sin(0.5), rel=1e-6)  # along its sides
    # it sinks straight down on a disk that stays round
    across = np.sqrt(1 - (i.x / 0.02) ** 2)
    assert i.wear_1 / across == pytest.approx(np.full(len(i.x), 1e-3), rel=5e-3)
    assert i.y == pytest.approx(np.sqrt(0.02**2 - i.x**2) + 1e-3, abs=1e-5)


def test_a_tilting_block_wears_into_a_wedge():
    """The rotation of the block moves its face along the strip, beyond the strip's contact face.

    requirement: Archard's law, and forces and moments in balance about the pin.
    """
    worn = run_starter(
        "punch-on-strip-tilting", *SMALL, until(4e4), "motion.velocity=-1 m/s", "wear.update=0.02"
    )
    assert_sound(worn, 4, 0.02)
    i, volume = worn.interface, 1e-13 * 0.3 * 3e3 * 1.0 * 4e4  # k F s
    assert worn.summary["geometry_smallest_scaled_jacobian"] > 0.999
    assert worn.summary["geometry_volume_1_m3"] == pytest.approx(volume, rel=1e-4)
    assert i.x[[0, -1]] == pytest.approx([-0.03, 0.03])
    assert i.weight @ i.pressure == pytest.approx(3e3, rel=1e-3)
    height = np.polyfit(i.x, i.y, 1)
    assert height[0] < -0.02  # a wedge
    assert np.polyval(height, i.x) == pytest.approx(i.y, abs=2e-5)


class Notes(Observer):
    def __init__(self):
        self.found = []

    def note(self, text):
        self.found.append(text)


def grown(time, *more):
    """A cylinder on a block, its contact grown past the zone that was meshed for it."""
    keys = (
        "mesh.elements=30",
        "load.force=200 N",
        "wear.block.coefficient=2e-7 1/MPa",
        "geometry.zone=1 mm",
        "analysis.output_times=[]",
        "wear.update=0.005",
        f"analysis.end_time={time} s",
        *more,
    )
    notes = Notes()
    return run(starter("cylinder-on-block-growing", *keys), observer=notes), notes.found


@pytest.mark.slow
def test_a_contact_may_grow_past_its_zone():
    """requirement: over elements that were not made for it; a³ = a0³ + 1.5 k P' R s."""
    result, notes = grown(100)
    assert_sound_growth(result)
    i = result.interface
    known = (1.5 * 2e-13 * 2e5 * 0.01 * 5.0) ** (1 / 3)
    assert known > 1.4e-3
    assert i.x[i.pressure > 0].max() == pytest.approx(known, rel=0.05)
    assert i.wear_2[0] == pytest.approx(known**2 / (2 * 0.01), rel=0.02)
    assert not any("end of the contact face" in note for note in notes)


@pytest.mark.slow
def test_a_contact_grows_on_over_a_mesh_for_a_wider_zone():
    """requirement: by the same law, with as few updates lost from the count as volume."""
    result, notes = grown(400)
    assert_sound_growth(result)
    assert sum("beyond the zone" in note for note in notes) == 1
    assert result.summary["geometry_updates"] > 25  # 17 of them before the zone is wider
    i = result.interface
    known = (1.5 * 2e-13 * 2e5 * 0.01 * 20.0) ** (1 / 3)
    assert np.sqrt(5 * np.average(i.x**2, weights=i.weight * i.wear_2)) == pytest.approx(
        known, rel=0.02
    )
    volume = 2e-13 * 200 * 20.0 * (1 + (known / 0.01) ** 2 / 6)  # the pressure acts across the face
    assert i.weight @ i.wear_2 == pytest.approx(volume, rel=5e-3)


@pytest.mark.slow
def test_a_contact_that_fills_its_face_is_said_to():
    """requirement: beyond the end of the face there is nothing to wear; the run says so."""
    narrow = "geometry.block_width=3 mm", "mesh.elements=20", 'wear.update="never"'
    result, notes = grown(200, *narrow)
    assert result.stopped is None
    assert any("end of the contact face" in note for note in notes)


def assert_sound_growth(result):
    assert result.stopped is None
    assert result.summary["geometry_updates"] >= 4
    assert result.summary["geometry_volume_error"] < 1e-6

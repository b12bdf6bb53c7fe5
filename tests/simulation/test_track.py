"""Wear of a body that passes by, spread over its track."""

import numpy as np
import pytest

from ..case.starter import GONE, solved

STRIP, PADS = "punch-on-strip", "disk-brake"
COARSE = ("mesh.degree=4", "mesh.elements=8")
BOTH = ("wear.strip.coefficient=3e-7 1/MPa", "wear.punch.coefficient=1e-7 1/MPa")
TRACK = ("wear.strip.spread=track",)


def cold(name, *overrides):
    return solved(name, {"heat": GONE}, *COARSE, *overrides)


def test_a_strip_wears_evenly_along_its_track():
    """requirement: the steady rates are the punch's own and the mean over the strip's length."""
    result = cold(STRIP, *BOTH, *TRACK)
    pressure, speed, friction = 4e3 / 400e-6, 3e-3, 0.3
    punch, strip = 1e-13 * friction * pressure * speed, 3e-13 * friction * pressure * speed
    part = 40.0 / 160.0
    assert result.interface.wear_rate_1 == pytest.approx(punch, rel=1e-9, abs=0.0)
    assert result.interface.wear_rate_2 == pytest.approx(part * strip, rel=1e-9, abs=0.0)
    velocity = result.summary["rigid_wear_velocity_m_per_s"]
    assert velocity == pytest.approx(punch + part * strip, rel=1e-9)


def test_what_the_track_loses():
    """requirement: Archard's volume, whichever way it is spread."""
    end = "analysis={type='transient', end_time='1000 s'}"
    slid = 3e-3 * 1000.0
    for more in ((), TRACK):
        result = cold(STRIP, *BOTH, *more, end)
        summary, last = result.summary, result.history[-1]
        assert last.wear_volume_2 == pytest.approx(summary["wear_volume_2_m3"], rel=1e-9)
        assert summary["wear_volume_1_m3"] == pytest.approx(
            1e-13 * 0.3 * 4e3 * slid, rel=1e-6, abs=0.0
        )
        assert summary["wear_volume_2_m3"] == pytest.approx(
            3e-13 * 0.3 * 4e3 * slid, rel=1e-6, abs=0.0
        )


def test_running_in_with_a_track_ends_in_the_steady_state():
    """requirement: transient and principle agree; b differs, so the mean is no constant."""
    law = (
        "wear.strip.pressure_exponent=2.0",
        "wear.strip.coefficient=3e-7 1/MPa^2",
        "wear.punch.coefficient=1e-7 1/MPa",
        "holder={free=['z','rotation'],pivot=['0 mm','10 mm']}",
        "load.point=['-2 mm']",
    )
    end = "analysis={type='transient', until='steady', steady_tolerance=1e-3}"
    direct, reached = cold(STRIP, *law, *TRACK), cold(STRIP, *law, *TRACK, end)
    assert np.ptp(direct.interface.pressure) > 0.2 * direct.interface.pressure.max()
    assert reached.interface.pressure == pytest.approx(
        direct.interface.pressure, abs=2e-3 * direct.interface.pressure.max()
    )
    assert np.ptp(reached.interface.wear_2) < 1e-12 * reached.interface.wear_2.max()


def test_pads_take_up_a_sector_of_their_disk():
    """requirement: a disk under pads of 60 degrees wears for a sixth of the time."""
    both = ("wear.disk.coefficient=1e-7 1/MPa", "wear.disk.spread=track")
    result = cold(PADS, *both)
    assert result.interface.wear_rate_2 == pytest.approx(result.interface.wear_rate_1 / 6)
    end = "analysis={type='transient', end_time='1e5 s'}"
    worn = cold(PADS, *both, end)
    volumes = worn.summary["wear_volume_1_m3"], worn.summary["wear_volume_2_m3"]
    # once the pads' mesh is moved, depths of the disk are summed up over the pads' slanted face
    slant = np.abs(np.gradient(worn.interface.wear_1, worn.interface.x)).max()
    assert 0.0 < slant < 2e-4
    assert volumes[1] == pytest.approx(volumes[0], rel=slant**2 / 2, abs=0.0)


def test_the_whole_disk_cools_what_the_pads_heat():
    """requirement: heat of a sector leaves by the whole rim, through a disk that conducts well."""
    changes = {"heat.cooling": {"disk_outside": "60 W/(m^2 K)"}}
    summary = solved(PADS, changes, *COARSE, "bodies.disk.conductivity=1e6 W/(m K)")
    power = summary.summary["friction_power_W"]
    rim = 2 * np.pi * 0.135 * 0.006  # of the half of the disk that is modelled
    rise = summary.interface.temperature_2 - 293.15
    assert rise == pytest.approx(power / (60 * rim), rel=1e-3)


def test_a_sector_heats_like_a_ring_of_another_disk():
    """requirement: a sixth of the pads, a sixth of the heat per conductivity and cooling."""
    cooling = {"disk_outside": 60, "disk_inside": 100, "disk_rest": 60}
    sector = {f"heat.cooling.{name}": f"{h} W/(m^2 K)" for name, h in cooling.items()}
    ring = {f"heat.cooling.{name}": f"{6 * h} W/(m^2 K)" for name, h in cooling.items()}
    ring |= {"geometry.pad_angle": "360 deg", "load.force": "3 kN"}
    ring |= {"bodies.disk.conductivity": "288 W/(m K)"}
    by_sector, by_ring = (solved(PADS, changes, *COARSE) for changes in (sector, ring))
    assert np.ptp(by_sector.interface.temperature_2) > 1.0
    for body in (1, 2):
        found, known = (getattr(r.interface, f"temperature_{body}") for r in (by_sector, by_ring))
        assert found == pytest.approx(known, rel=1e-9)

"""Running-in that steady temperatures end: the message names the cause."""

import pytest
import tomli_w

import thermowear as tw
from thermowear.errors import ComputationError, StandstillError
from thermowear.simulation.analyses.transient import cause_of

from ..case.starter import STEADY, changed, tables
from ..geometry.plain import NAMES, blocks, msh


def result(folder, velocity, **analysis):
    """Result of a hot punch on a plate, with steady temperatures."""
    (folder / "blocks.msh").write_text(msh(blocks((8, 12), (4, 4))), encoding="utf-8")
    case = tables(STEADY)
    case["heat"] = {
        "ambient": "20 degC",
        "conductance": "2e4 W/(m^2 K)",
        "advection": "none",
        "cooling": {"PUNCH_TOP": "500 W/(m^2 K)", "PLATE_BOTTOM": "500 W/(m^2 K)"},
    }
    case |= {
        "model": "plane-strain",
        "geometry": {"type": "file", "path": "blocks.msh", "thickness": "25 mm"} | NAMES,
        "mesh": {"degree": 2},
        "load": {"force": "2 kN"},
        "motion": {"velocity": f"{velocity} m/s"},
        "analysis": analysis,
    }
    (folder / "case.toml").write_text(tomli_w.dumps(case), encoding="utf-8")
    return tw.run(tw.load(folder / "case.toml"))


def test_beyond_the_critical_speed(tmp_path):
    """requirement: a running-in that steady temperatures stop is told by its cause."""
    critical = result(tmp_path, 0.01, type="stability").summary["critical_speed_m_per_s"]
    running_in = {"type": "transient", "until": "steady"}
    assert result(tmp_path, 0.5 * critical, **running_in).stopped is None
    for times in (2.0, 5.0):
        reason = str(result(tmp_path, times * critical, **running_in).stopped)
        assert "states may jump beyond the critical speed" in reason
        assert "heat.transient = true" in reason


def test_unworn_faces_beyond_the_critical_speed_of_a_stable_steady_state():
    """requirement: the unworn state is named, and temperatures in time lead to the steady one."""
    coarse = {"mesh.degree": 3, "mesh.elements": 6}
    until = {"type": "transient", "until": "steady", "tolerance": 2e-2, "steady_tolerance": 1e-2}
    case = changed(tables("block-on-disk-turning"), {"analysis": until})
    with pytest.raises(ComputationError, match="it is the unworn state that is critical"):
        tw.run(tw.load(case))
    in_time = tw.run(tw.load(changed(case, coarse | {"heat.transient": True})))
    assert in_time.stopped is None
    assert in_time.summary["distance_from_steady"] <= 1e-2


def test_a_regular_state_is_not_called_critical():
    """requirement: the critical speed is the cause only beyond it, by that state's stability."""
    still = StandstillError("transient: no step is small enough at 9 s")
    assert "at 1.25 times it" in (cause_of(still, [], 0.8) or "")
    regular = cause_of(still, [], 4.0) or ""
    assert "beyond" not in regular
    assert "at 0.25 times its critical speed" in regular
    assert cause_of(still, [], None) is None

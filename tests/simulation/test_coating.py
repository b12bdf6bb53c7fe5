"""Coatings that are worn through, point by point."""

from dataclasses import replace

import numpy as np
import pytest

import thermowear as tw
from thermowear.case import load
from thermowear.simulation import run
from thermowear.simulation.from_case import model_of
from thermowear.simulation.runtime.observer import Observer
from thermowear.verification.cases.wear.coating import (
    COEFFICIENTS,
    HARD,
    LIFE,
    PRESSURE,
    SOFT,
    SPEED,
    compared_flat,
    flat_face,
)
from thermowear.verification.check import starter

from ..case.starter import GONE, solved, tables

COARSE = ("mesh.elements=24",)
SHORT = replace(HARD, multiples=(0.5, 1.7))


def passed(checks):
    found = list(checks)
    assert found
    assert not [check for check in found if not check.passed], found


@pytest.mark.parametrize("update", ["never", "0.0005"])
def test_flat_face(update):
    """
    requirement: a layer lasts h/(k p v), with an exact kink, also where the mesh follows the wear.
    """
    result = flat_face(f"wear.update={update}")
    passed(compared_flat(result, ""))
    left = [state.coating_left_1.max() for state in result.outputs.values()]
    assert left == pytest.approx([4.5e-6, 2e-6, 1.2e-6, 0.0], rel=1e-9, abs=1e-15)
    assert np.isnan(result.interface.coating_left_2).all()
    assert (result.summary.get("geometry_updates", 0) > 0) == (update != "never")
    assert max(row.error for row in result.history) < 1e-6


@pytest.mark.parametrize(("case", "allowed"), [(SHORT, 0.06), (SOFT, 0.02)])
def test_ball_on_a_flat(case, allowed):
    """
    requirement: V_c/k_c + V_s/k_s = F s whichever is coated; the volumes of a ball crater.
    """
    result = case.run(*COARSE)
    passed(case.compared(result, "", allowed))
    number = 1 if case.body == "sphere" else 2
    through = result.summary[f"worn_through_distance_{number}_m"]
    assert through == pytest.approx(case.ball.begin, rel=0.06)  # elastic: more depth at the edge
    first = next(iter(result.outputs.values()))
    left, lost = (getattr(state, f"coating_left_{number}") for state in (first, result.interface))
    assert left.min() > 0
    i, thickness = result.interface, case.ball.thickness
    depth = getattr(i, f"wear_{number}")
    bare = i.x[depth >= thickness].max()
    assert bare == pytest.approx(case.ball.bare_radius(case.distances[-1]), rel=0.12)
    assert lost[i.pressure == 0.0] == pytest.approx(thickness)
    # no ripples where the border has passed, in spite of few elements
    conforming = depth + i.x**2 / (2 * case.ball.radius)
    bare_points = (lost == 0.0) & (i.weight > 0.0)
    smooth = np.polynomial.Polynomial.fit(i.x[bare_points], conforming[bare_points], 4)
    ripples = np.abs(conforming - smooth(i.x))[bare_points].max()
    assert ripples < 5e-4 * depth.max()
    # the pressure is k_s/k_c times as large on the coating, next to points that it covers in part
    inside, covered = (lost == 0.0) & (i.x > 0), np.isclose(lost, thickness - depth, 1e-12, 0)
    rate, ring = i.wear_rate_1 + i.wear_rate_2, covered & (i.pressure > 0.0)
    k_s, k_c = case.ball.substrate, case.ball.coating
    factor = rate / np.where(i.pressure > 0.0, case.speed * i.pressure, np.inf)
    np.testing.assert_allclose(factor[inside], k_s, rtol=1e-9)
    np.testing.assert_allclose(factor[ring], k_c, rtol=1e-9)
    part = factor[(lost > 0.0) & ~covered]
    assert 1 <= len(part) <= 8
    assert np.all((part > min(k_s, k_c)) & (part < max(k_s, k_c)))


def test_the_largest_pressure_does_not_saw():
    """
    requirement: the border of a layer passes the area of each point continuously: the largest
    pressure, on the layer next to it, falls without jumps of the order of a point's share of it.
    """
    result = HARD.run("mesh.elements=40", "analysis.tolerance=3e-3")
    times, peaks = np.array([(row.time, row.max_pressure) for row in result.history]).T
    late = times > times[-1] / 2
    smooth = np.polynomial.Polynomial.fit(times[late], peaks[late], 2)(times[late])
    assert np.abs(peaks[late] / smooth - 1).max() < 0.1


@pytest.mark.slow
@pytest.mark.parametrize("method", ["penalty", "nitsche"])
def test_ball_by_other_methods(method):
    """
    requirement: balance and volumes by all contact methods.
    """
    passed(SHORT.compared(SHORT.run(*COARSE, f"contact.method={method}"), "", 0.06))


@pytest.mark.slow
def test_ball_on_moved_meshes():
    """
    requirement: layers are measured by the whole depth of each point, wherever the mesh is.
    """
    fixed, moved = (SHORT.run(*COARSE, f"wear.update={size}") for size in ("never", "0.0002"))
    assert moved.summary["geometry_updates"] > 5
    volumes = [result.summary["layer_volumes_1_m3"] for result in (fixed, moved)]
    assert volumes[1] == pytest.approx(volumes[0], rel=2e-3, abs=0.0)
    assert sum(volumes[1]) == pytest.approx(moved.summary["wear_volume_1_m3"], rel=1e-12, abs=0.0)
    times = [result.summary["worn_through_time_1_s"] for result in (fixed, moved)]
    assert times[1] == pytest.approx(times[0], rel=2e-2)


RAMP = 8000.0
"""Time in which the load doubles [s]."""


def ramped(tolerance):
    """Depth under a rising load, with exponents that differ between layers, over the exact one."""
    b, k1, k2 = 1.5, 2e-15, 3e-20
    changes = {
        "heat": GONE,
        "wear": {
            "upper": {
                "coefficient": f"{k2} 1/Pa^{b}",
                "pressure_exponent": b,
                "per": "pressure",
                "layers": {
                    "thickness": ["5 um"],
                    "coefficient": [f"{k1} 1/Pa"],
                    "pressure_exponent": [1],
                },
            }
        },
        "load": {"history": {"time": ["0 s", f"{RAMP} s"], "force": ["500 N", "1 kN"]}},
        "analysis": {"type": "transient", "end_time": f"{RAMP} s", "tolerance": tolerance},
    }
    result = solved("stacked-blocks", changes, "mesh.degree=2", "mesh.elements=2")
    # k1 v ∫ p dt = h at x = 1 + t/RAMP, then k2 v ∫ p^b dt
    x = np.sqrt(1 + 2 * 5e-6 / (k1 * SPEED * PRESSURE * RAMP))
    substrate = k2 * SPEED * PRESSURE**b * RAMP * (2 ** (b + 1) - x ** (b + 1)) / (b + 1)
    exact, time = 5e-6 + substrate, (x - 1) * RAMP
    found = result.interface.wear_1
    assert result.summary["worn_through_time_1_s"] == pytest.approx(time, rel=2e-2)
    return len(result.history), float(np.abs(found / exact - 1).max())


def test_errors_of_the_steps_at_a_kink():
    """
    requirement: the error stays near the tolerance of a step, for laws of different exponents, too.
    """
    for tolerance in (1e-2, 1e-4, 1e-5, 1e-6):
        steps, error = ramped(tolerance)
        assert error < 1.5 * tolerance
        assert steps < 20


def test_the_steady_state_is_that_of_the_substrate():
    """
    requirement: with a note; the pressures and the rate are those of the uncoated face.
    """
    notes = []

    class Watched(Observer):
        def note(self, text):
            notes.append(text)

    wear = {"coefficient": "1e-7 1/MPa^2", "pressure_exponent": 2, "per": "pressure"}
    layers = {"thickness": ["5 um"], "coefficient": ["4e-9 1/MPa^2"]}
    found, known = (
        run(
            load(tables("annular-punch", {"wear.punch": own, "mesh.degree": 4})), observer=Watched()
        )
        for own in (wear | {"layers": layers}, wear)
    )
    coated = [note for note in notes if "all layers are worn through" in note]
    assert len(coated) == 1
    np.testing.assert_array_equal(found.interface.pressure, known.interface.pressure)
    np.testing.assert_array_equal(found.interface.wear_rate_1, known.interface.wear_rate_1)
    key = "rigid_wear_velocity_m_per_s"
    assert found.summary[key] == known.summary[key] > 0
    assert "layer_volumes_1_m3" not in found.summary


def test_running_in_to_the_steady_state():
    """
    requirement: a uniform pressure is steady from the start, but not before the coating is lost.
    """
    result = flat_face("analysis={type='transient', until='steady'}")
    assert LIFE <= result.summary["time_s"] < 3 * LIFE
    assert result.summary["distance_from_steady"] < 1e-3
    rate = COEFFICIENTS[-1] * PRESSURE * SPEED
    assert result.summary["rigid_wear_velocity_m_per_s"] == pytest.approx(rate, rel=1e-9)
    short = flat_face(f"analysis={{type='transient', end_time='{0.9 * LIFE} s'}}")
    assert short.summary["distance_from_steady"] is None
    assert short.summary["worn_through_time_1_s"] is None
    assert short.interface.coating_left_1.min() > 0.0


def test_hot_ring():
    """
    requirement: a coated ring runs in to the state that its substrate runs in to, with heat.
    """
    until = {"analysis": {"type": "transient", "until": "steady", "steady_tolerance": 1e-4}}
    layers = {"thickness": ["4 um"], "coefficient": ["4e-8 1/MPa"]}
    coated = until | {"wear.punch.layers": layers}
    found, known = (solved("annular-punch", c, "mesh.degree=3") for c in (coated, until))
    largest = known.interface.pressure.max()
    assert found.interface.pressure == pytest.approx(known.interface.pressure, abs=4e-4 * largest)
    shape = known.interface.shape
    assert found.interface.shape == pytest.approx(shape, abs=5e-3 * np.ptp(shape))
    assert found.interface.coating_left_1.max() == 0.0
    assert found.summary["worn_through_time_1_s"] < found.summary["time_s"]
    assert found.summary["heat_balance_relative_error"] < 1e-9


def test_coated_track():
    """
    requirement: a coating along the whole track of a strip is lost at the mean pressure.
    """
    end, friction, force, v = 3e4, 0.3, 4e3, 3e-3
    wear = {
        "coefficient": "3e-7 1/MPa",
        "spread": "track",
        "layers": {"thickness": ["0.4 um"], "coefficient": ["6e-8 1/MPa"]},
    }
    changes = {
        "heat": GONE,
        "wear": {"strip": wear, "punch": {"coefficient": "1e-7 1/MPa"}},
        "analysis": {"type": "transient", "end_time": f"{end} s"},
    }
    result = solved("punch-on-strip", changes, "mesh.degree=4", "mesh.elements=8")
    coating, substrate = result.summary["layer_volumes_2_m3"]
    assert substrate > coating
    done = coating / 6e-14 + substrate / 3e-13
    assert done == pytest.approx(friction * force * v * end, rel=1e-6)
    assert np.ptp(result.interface.wear_2) < 1e-9 * result.interface.wear_2.max()
    mean = friction * force / (160e-3 * 10e-3)  # friction stress over the whole track
    through = result.summary["worn_through_time_2_s"]
    assert through == pytest.approx(0.4e-6 / (6e-14 * mean * v), rel=1e-6)


def test_cyclic_analyses_refuse_layers():
    """
    requirement: in one line, also of a model that is no case file.
    """
    case = starter("punch-on-strip-reciprocating")
    model = model_of(case)
    wear = {i: replace(own, law=tw.LayeredWear([1e-6], [own.law], own.law))
            for i, own in model.interface.wear.items()}  # fmt: skip
    coated = replace(model, interfaces=(replace(model.interface, wear=wear),))
    from thermowear.simulation.analyses.run import run as run_model
    from thermowear.simulation.from_case.analysis import analysis_of

    with pytest.raises(tw.CaseError, match="a reciprocating analysis does not support contact fac"):
        run_model(coated, analysis_of(case))

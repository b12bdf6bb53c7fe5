"""Reciprocating sliding in space: the extruded section, a round pin, volumes, and refusals."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main
from thermowear.errors import CaseError
from thermowear.geometry.meshing.cells import level, mesh_lattice, tagged_bodies
from thermowear.laws import PowerWear
from thermowear.laws.interfaces import Constant
from thermowear.model import (
    Body,
    Discretisation,
    FaceWear,
    Holder,
    Interface,
    Material,
    Model,
    Motion,
)
from thermowear.model.analyses import ReciprocatingAnalysis
from thermowear.simulation.analyses.run import run
from thermowear.verification.cases.cycles.reciprocating_in_space import (
    HALF,
    arched_pin,
    length,
    steady_rates,
)

from ..case.starter import GONE, changed
from ..test_parallel import summaries
from .extruded import Blocks, Meshed
from .space import PUNCH

FORCE, AMPLITUDE, FREQUENCY, BREADTH = 1000.0, 5e-3, 2.0, 5e-3
SPEED = 4 * AMPLITUDE * FREQUENCY
K = (1e-13, 4e-14)
STEEL = Material(2e11, 0.3, label="upper")
UP = np.array([0.0, 2.5e-3, 1e-2])
BLOCKS = Blocks(
    upper=(np.linspace(-5e-3, 5e-3, 5), UP),
    lower=(np.linspace(-15e-3, 15e-3, 13), -UP[::-1]),
)
SETTINGS = {"end_time": 100.0, "positions": 4, "amplitude": AMPLITUDE, "frequency": FREQUENCY}


def close(value, tolerance=1e-9):
    return pytest.approx(value, rel=tolerance, abs=0.0)


def model(meshes, kinematics, friction=0.2, rollers=(), wear=(0, 1), k=None):
    down = (0.0, 0.0, -1.0) if kinematics == "3d" else (0.0, -1.0)
    guided = {n: tuple(f"{n}_{end}" for end in rollers) for n in ("upper", "lower")}
    return Model(
        kinematics=kinematics,
        bodies=tuple(
            Body(n, {n: STEEL}, fixed=(f"{n}_end",), rollers=on) for n, on in guided.items()
        ),
        interfaces=(
            Interface(
                faces=("upper_face", "lower_face"),
                motion=Motion(velocity=SPEED),
                friction=Constant(friction),
                wear={side: FaceWear(PowerWear(k or K[side], 1.0, 1.0)) for side in wear},
            ),
        ),
        holders=(
            Holder(
                load_direction=down,
                pivot=(0.0,) * len(down),
                point=(0.0,) * len(down),
                force=FORCE,
            ),
        ),
        meshes=meshes,
        discretisation=Discretisation(degree=2),
        thickness=None if kinematics == "3d" else BREADTH,
    )


def computed(chosen, **changes):
    result = run(chosen, ReciprocatingAnalysis(**(SETTINGS | changes)))
    assert result.stopped is None
    return result


@cache
def twins():
    """The section, and the block extruded from it between rollers."""
    solid = BLOCKS.extruded(np.array([0.0, BREADTH]), axis=1)
    return (
        computed(model(BLOCKS.section(), "plane-strain")),
        computed(model(solid, "3d", rollers=("low", "high"))),
    )


def test_an_extruded_section_wears_as_the_section():
    """requirement: pressures, depths and the track of the section at all y, to 1e-9."""
    flat, solid = twins()
    i, known = solid.interface, flat.interface
    same = np.abs(i.x[:, None] - known.x).argmin(axis=1)
    for name in ("pressure", "wear_1", "wear_2", "wear_rate_1", "wear_rate_2"):
        there = getattr(known, name)[same]
        atol = 1e-9 * np.abs(there).max()
        np.testing.assert_allclose(getattr(i, name), there, rtol=0, atol=atol, err_msg=name)
    track, line = solid.track.last, flat.track.last
    assert len(np.unique(track.y)) > 1
    depths = np.interp(track.x, line.x, line.wear_2)
    np.testing.assert_allclose(track.wear_2, depths, rtol=1e-9)
    for key, value in flat.summary.items():
        if key == "approach_m" or key.endswith(("_m3", "rate_1_m_per_s", "rate_2_m_per_s")):
            assert solid.summary[key] == close(value), key


EQUAL = 1e-13


def pin(elements, across):
    """Half of a pin with arched ends on a block."""
    mesh, names = arched_pin(elements, across), {"pin": "upper", "block": "lower"}
    renamed = (surface.split("_") for surface in mesh.surfaces)
    surfaces = tuple(f"{names[body]}_{side}" for body, side in renamed)
    return Meshed(replace(mesh, bodies=tuple(names.values()), surfaces=surfaces))


@cache
def steady():
    """The pin with the wear of both faces at its end."""
    chosen = model(pin(8, 21), "3d", friction=0.0, rollers=("middle",), k=EQUAL)
    ends = {"until": "steady", "end_time": np.inf, "steady_tolerance": 0.1}
    return computed(chosen, positions=12, **ends)


def test_lines_along_the_stroke_wear_by_their_length():
    """requirement: at the end W1' + W2' = V, W1' : W2' = k1/l : k2/(l + 2 A) on each line, with V
    from the load, but for the ends of the strokes.
    """
    result = steady()
    assert 0.05 < result.summary["distance_from_steady"] <= 0.1
    i, track = result.interface, result.track.last
    assert np.ptp(steady_rates(i.y)[0]) > 0.1 * steady_rates(0.0)[0]
    inner = (np.abs(i.x) < 0.8 * length(i.y) / 2) & (i.y < 0.9 * HALF)
    np.testing.assert_allclose(i.wear_rate_1[inner], steady_rates(i.y[inner])[0], rtol=2e-2)
    for row in np.unique(track.y)[:-1]:  # the side of the face is a corner of both bodies
        on = np.flatnonzero(track.y == row)
        mean = np.average(track.wear_rate_2[on], weights=track.weight[on])
        assert mean == close(steady_rates(row)[1], 1e-2)
        inner = np.abs(track.x[on]) < 0.8 * (length(row) / 2 + AMPLITUDE)
        np.testing.assert_allclose(track.wear_rate_2[on][inner], steady_rates(row)[1], rtol=8e-2)


def test_volumes_are_those_of_the_way():
    """requirement: V = k F s of both faces at every step, whatever the mesh, and of the tables."""
    result = steady()
    worn = EQUAL * FORCE * SPEED
    for body in (1, 2):
        for row in result.history[1:]:
            assert getattr(row, f"wear_volume_{body}") == close(worn * row.time, 1e-9)
    i, track = result.interface, result.track.last
    known = worn * result.history[-1].time
    assert track.weight @ track.wear_2 == close(known)
    assert i.weight @ i.wear_1 == close(known, 1e-6)
    assert track.weight.sum() == close((HALF - HALF / 6) * 2 * HALF + 2 * AMPLITUDE * HALF, 5e-3)
    np.testing.assert_allclose(track.z, 0.0, atol=1e-15)


def ball(elements, across, radius, end):
    """Half of a punch with a round bottom on a block."""

    def rounded(p):
        x, y, z = np.moveaxis(p, -1, 0)
        bottom = (x**2 + y**2) / (2 * radius)
        return np.stack([x, y, z + bottom * (1 - z / up[-1])], axis=-1)

    up = np.array([0.0, 3e-4, 1e-3, 3e-3, 1e-2])
    on_1, on_2 = (
        np.linspace(-end, end, elements + 1),
        np.linspace(-2.5 * end, 2.5 * end, across + 1),
    )
    upper = mesh_lattice((on_1, on_1[elements // 2 :], up), 2, rounded)
    lower = mesh_lattice((on_2, np.linspace(0.0, 1.2 * end, across // 4 + 1), -up[::-1]), 2)
    bodies = {"upper": upper, "lower": lower}

    def face(p):
        x, y, z = np.moveaxis(p, -1, 0)
        return np.all(np.abs(z - (x**2 + y**2) / (2 * radius)) < 1e-9, axis=1)

    levels = {f"{n}_low": level(1, 0.0) for n in bodies} | {"upper_face": face}
    levels |= {"lower_face": level(2, 0.0), "upper_end": level(2, up[-1])}
    return Meshed(tagged_bodies(bodies, levels | {"lower_end": level(2, -up[-1])}))


def test_a_ball_leaves_a_groove():
    """requirement: each pass over a place wears k ∫p dx, of Hertz k p0 π (a² - y²)/(2 a); areas are
    those of the flat block, not of the ball.
    """
    radius, end, amplitude = 0.05, 2e-3, 3e-3
    chosen = model(ball(12, 24, radius, end), "3d", friction=0.0, rollers=("low",), k=1e-16)
    motion = Motion(velocity=4 * amplitude * FREQUENCY)
    chosen = replace(chosen, interfaces=(replace(chosen.interface, motion=motion),))
    result = computed(chosen, end_time=1e-3, positions=4, amplitude=amplitude)
    whole, modulus = 2 * FORCE, STEEL.young_modulus / 2 / (1 - STEEL.poisson_ratio**2)
    a = (3 * whole * radius / (4 * modulus)) ** (1 / 3)
    track = result.track.last
    middle = (np.abs(track.x) < 1e-3) & (track.y < 0.4 * a)
    assert len(np.unique(track.y[middle])) > 1
    line = 3 * whole / (4 * a**3) * (a**2 - track.y[middle] ** 2)
    np.testing.assert_allclose(
        track.wear_rate_2[middle], 2 * FREQUENCY * 1e-16 * line, rtol=2e-2, atol=0.0
    )
    assert track.weight.sum() == close((2 * end + 2 * amplitude) * end, 1e-3)


def test_a_groove_has_the_area_of_its_arc():
    """requirement: areas of the track are those of the face of body 2, not of its projection."""
    radius, end, half = 2.5e-3, 2e-3, 4e-3
    up = np.array([0.0, 2.5e-3, 1e-2])

    def rounded(p):
        x, y, z = np.moveaxis(p, -1, 0)
        return np.stack([x, y, z + y**2 / (2 * radius) * (1 - np.abs(z) / up[-1])], axis=-1)

    def face(p):
        _, y, z = np.moveaxis(p, -1, 0)
        return np.all(np.abs(z - y**2 / (2 * radius)) < 1e-9, axis=1)

    across, ends = np.linspace(0.0, end, 5), {"upper": half, "lower": 3 * half}
    bodies = {
        n: mesh_lattice(
            (np.linspace(-x, x, 5), across, up if n == "upper" else -up[::-1]), 2, rounded
        )
        for n, x in ends.items()
    }
    levels = {f"{n}_low": level(1, 0.0) for n in bodies} | {f"{n}_face": face for n in bodies}
    levels |= {"upper_end": level(2, up[-1]), "lower_end": level(2, -up[-1])}
    meshes = Meshed(tagged_bodies(bodies, levels))
    chosen = model(meshes, "3d", friction=0.0, rollers=("low",), k=1e-16)
    track = computed(chosen, end_time=1e-3).track.last
    at = end / radius
    arc = radius / 2 * (at * np.hypot(1, at) + np.arcsinh(at))
    assert arc > 1.09 * end
    assert track.weight.sum() == close(arc * (2 * half + 2 * AMPLITUDE), 1e-3)


def test_both_ways_wear_alike():
    """requirement: friction reverses with the motion, so that depths are symmetric in x."""
    _, solid = twins()
    for found, name in ((solid.interface, "wear_1"), (solid.track.last, "wear_2")):
        depths = {
            (round(1e7 * x), round(1e7 * y)): d
            for x, y, d in zip(found.x, found.y, getattr(found, name), strict=True)
        }
        for (x, y), depth in depths.items():
            assert depths[-x, y] == close(depth)
    pressure = solid.interface.pressure
    mirrored = np.lexsort((solid.interface.y, -solid.interface.x))
    there = np.lexsort((solid.interface.y, solid.interface.x))
    assert np.abs(pressure[there] - pressure[mirrored]).max() > 0.05 * pressure.max()


def test_one_body_wears():
    """requirement: a pin that wears alone ends with a uniform mean pressure, W1' = k F v / A."""
    chosen = model(pin(6, 15), "3d", friction=0.1, rollers=("middle",), wear=(0,))
    result = computed(chosen, end_time=2000.0, positions=4)
    i = result.interface
    uniform = K[0] * FORCE * SPEED / (2 * HALF * (HALF - HALF / 6))
    inner = (np.abs(i.x) < 0.8 * length(i.y) / 2) & (i.y < 0.8 * HALF)
    np.testing.assert_allclose(i.wear_rate_1[inner], uniform, rtol=2e-2)
    assert not result.track.last.wear_2.any()


def test_a_pair_as_an_assembly():
    """requirement: pressures, depths and the track of the pair to 1e-9, by the joint path."""
    known = twins()[1]
    pair = model(BLOCKS.extruded(np.array([0.0, BREADTH]), axis=1), "3d", rollers=("low", "high"))
    named = replace(
        pair,
        interfaces=(replace(pair.interface, name="only"),),
        holders=(replace(pair.holder, name="arm"),),
    )
    joint = computed(named)
    for table, names in (
        ("interface", ("pressure_Pa", "wear_1_m", "wear_2_m")),
        ("track", ("x_m", "y_m", "weight_m2", "wear_2_m")),
    ):
        found, expected = joint.columns(f"{table}_only"), known.columns(table)
        for name in names:
            atol = 1e-9 * np.abs(expected[name]).max()
            np.testing.assert_allclose(found[name], expected[name], rtol=0, atol=atol)


def test_a_punch_that_tilts():
    """requirement: a tilting holder stays in balance: V = k F s, and the moment of the load."""
    solid = BLOCKS.extruded(np.array([0.0, BREADTH]), axis=1)
    fixed = model(solid, "3d")
    arm = replace(
        fixed.holder,
        free=("z", "rotation-x", "rotation-y"),
        point=(0.0, 0.6 * BREADTH, 0.0),
        pivot=(0.0, BREADTH / 2, 0.0),
    )
    result = computed(replace(fixed, holders=(arm,)))
    worn = K[0] * FORCE * SPEED * SETTINGS["end_time"]
    i, track = result.interface, result.track.last
    assert i.weight @ i.wear_1 == close(worn)
    assert track.weight @ track.wear_2 == close(worn * K[1] / K[0])
    assert i.weight @ (i.pressure * i.y) == close(0.6 * BREADTH * FORCE)
    middle = i.weight @ (i.wear_1 * i.y) / worn
    assert middle > 0.52 * BREADTH
    assert track.weight @ (track.wear_2 * track.y) == close(middle * worn * K[1] / K[0], 2e-2)


def test_what_is_refused():
    """requirement: a face that leaves the other one, and a stroke normal to the faces."""
    solid = BLOCKS.extruded(np.array([0.0, BREADTH]), axis=1)
    far = replace(
        model(solid, "3d"),
        interfaces=(
            replace(model(solid, "3d").interface, motion=Motion(velocity=4 * 12e-3 * FREQUENCY)),
        ),
    )
    with pytest.raises(CaseError, match=r"motion.amplitude: .* of upper_face leaves lower_face"):
        computed(far, amplitude=12e-3)


STEADY = {"type": "reciprocating", "until": "steady"}
CASE = changed(
    PUNCH,
    {
        "geometry.block_x": "140 mm",
        "geometry.stroke": "20 mm",
        "mesh.elements": 4,
        "holder": GONE,
        "load": {"force": "10 kN"},
        "motion": {"amplitude": "20 mm", "frequency": "1 Hz"},
        "wear": {n: {"coefficient": "1e-7 1/MPa", "per": "pressure"} for n in ("punch", "block")},
        "analysis": {
            "type": "reciprocating",
            "cycles": 100,
            "positions": 4,
            "output_times": ["50 s"],
        },
    },
)


@pytest.mark.usefixtures("bodies_not_drawn")
def test_a_case_and_its_files(tmp_path):
    """requirement: a case file in space; track.csv with places and areas, and a map of it."""
    file, folder = tmp_path / "case.toml", tmp_path / "results"
    file.write_text(tomli_w.dumps(CASE), encoding="utf-8")
    assert main(["run", str(file), "-o", str(folder)]) == 0
    for name, cycles in (("track.csv", 100), ("track_50.csv", 50)):
        with (folder / name).open() as opened:
            rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(opened)]
        x, y, weight, worn = (
            np.array([row[key] for row in rows]) for key in ("x_m", "y_m", "weight_m2", "wear_2_m")
        )
        assert (np.ptp(x), np.ptp(y)) == (close(0.1), close(0.08))
        assert weight @ worn == close(1e-13 * 1e4 * 4 * 0.02 * cycles)
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["wear_volume_2_m3"] == close(1e-13 * 1e4 * 8.0)
    assert (folder / "track.png").stat().st_size > 1000


@pytest.mark.parametrize(
    ("changes", "path", "text"),
    [
        ({"motion.amplitude": "25 mm"}, "motion.amplitude", "leaves block_face"),
        ({"geometry.stroke": "40 mm"}, "geometry.block_x", "twice the stroke 0.04 m"),
        ({"holder": {"free": ["z", "x"]}}, "holder.free", "along x is prescribed"),
        (
            {"holder": {"free": ["z", "rotation-y"]}, "analysis": STEADY},
            "analysis.until",
            'needs holder.free = ["z"]',
        ),
        ({"motion": {"velocity": "1 m/s"}}, "motion.velocity", "amplitude and frequency"),
        (
            {"motion.axis": {"direction": "z", "point": ["0 mm", "0 mm", "0 mm"]}},
            "motion.axis",
            "is along x",
        ),
        ({"contact.method": "nitsche"}, "contact.method", "use condensed"),
        ({"wear.block.spread": "track"}, "wear.block.spread", "leave it out"),
    ],
)
def test_faults_of_a_case(changes, path, text):
    """requirement: one line with the key, and what is wrong."""
    with pytest.raises(CaseError) as caught:
        tw.run(tw.load(changed(CASE, changes)))
    assert any(f.startswith(f"{path}: ") and text in f for f in caught.value.faults), caught.value


@pytest.mark.slow
def test_two_ranks_give_the_serial_numbers(tmp_path):
    """requirement: every number of the summary to 1e-8 of the serial run."""
    file = tmp_path / "case.toml"
    file.write_text(tomli_w.dumps(CASE), encoding="utf-8")
    (serial, _), (parallel, _) = summaries(tmp_path, file)
    for key in ("wear_volume_1_m3", "wear_volume_2_m3", "approach_m", "distance_from_steady"):
        assert parallel[key] == close(serial[key], 1e-8), key

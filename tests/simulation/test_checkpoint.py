"""Analyses that go on from a checkpoint, in one process."""

from dataclasses import astuple, replace

from mpi4py import MPI

import numpy as np
import pytest

import thermowear as tw
from thermowear.contact.operators.exchange_matrix import ThermalState
from thermowear.results import HistoryRow
from thermowear.serialise import pack
from thermowear.simulation import Observer
from thermowear.simulation.from_case import run

from ..conftest import COLD_RUNNING_IN, DEMOS, HOT

ALWAYS = "analysis.checkpoint_every=1e-9 s"
IN_TIME = 'analysis={type="transient", end_time="20 s", checkpoint_every="1e-9 s"}'
FADING = "bodies.{}.conductivity_factor={{at=['20 degC', '300 degC'], factor=[1.0, 0.5]}}"
SHORT = "analysis.output_times=['1 s']"


class Watched(Observer):
    """Keeps what a run could go on with at each step."""

    def __init__(self):
        self.checkpoints = []
        self.rows_again = []

    def checkpoint(self, saved):
        self.checkpoints.append(pack(MPI.COMM_WORLD, saved))

    def resumed(self, rows):
        self.rows_again += rows


def rows(result):
    """All rows of all tables that grow on the way."""
    found = [*result.history, *result.heat]
    if result.friction is not None:
        found += [*result.friction.rows, *result.friction.tangential, *result.friction.cycles]
    return [astuple(row) for row in found]


def assert_the_same(one, other):
    """Bitwise: steps are chosen by errors, which would enlarge any rounding."""
    assert len(rows(one)) == len(rows(other))
    np.testing.assert_array_equal(
        np.concatenate(rows(one)), np.concatenate(rows(other)), strict=True
    )
    np.testing.assert_array_equal(astuple(one.interface), astuple(other.interface))
    assert one.summary == other.summary
    for time, interface in other.outputs.items():
        np.testing.assert_array_equal(astuple(interface), astuple(one.outputs[time]))


@pytest.mark.parametrize(
    ("case", "overrides"),
    [
        pytest.param(COLD_RUNNING_IN, ("mesh.degree=4",), id="cold"),
        pytest.param(HOT, ("mesh.degree=4", IN_TIME), id="hot"),
        pytest.param(
            DEMOS / "sphere_on_block_coated.toml",
            ("mesh.elements=20", "analysis.end_time=100 s", "analysis.tolerance=1e-2", SHORT),
            id="coated",
        ),
        pytest.param(
            HOT,
            ("mesh.degree=2", IN_TIME, FADING.format("punch")),
            id="hot-varying",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            DEMOS / "disk_brake_stop.toml",
            ("mesh.degree=2", "analysis.end_time=6 s"),
            id="heat-in-time",
        ),
        pytest.param(
            DEMOS / "disk_brake_stop.toml",
            ("mesh.degree=2", "analysis.end_time=2 s", SHORT, FADING.format("pad")),
            id="heat-in-time-varying",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            DEMOS / "annular_punch_deep.toml",
            ("mesh.degree=3", "mesh.elements=2", "analysis.end_time=30 h")
            + ("analysis.output_times=[]",),
            id="moved-meshes",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            COLD_RUNNING_IN,
            ("mesh.degree=2", "contact.method=nitsche", "analysis.end_time=5 s", SHORT),
            id="nitsche",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            DEMOS / "tube_in_support.toml",
            ("mesh.elements=16", "analysis.cycles=10000", "analysis.output_times=['350 s']"),
            id="fretting",
        ),
        pytest.param(
            DEMOS / "tube_in_support.toml",
            ("mesh.elements=16", "analysis.cycles=100", "analysis.jump=20")
            + ("analysis.output_times=['2.01 s']",),
            id="fretting-fixed-jumps",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            DEMOS / "cylinder_fretting.toml",
            ("mesh={degree=2, elements=12}", "contact.method=nitsche", "wear.cycles=6")
            + ("analysis.increments=1", "analysis.jump=1", "analysis.output_times=['50 ms']"),
            id="fretting-by-nitsche",
        ),
        pytest.param(
            DEMOS / "sphere_fretting.toml",
            ("mesh.elements=4", "analysis.increments=2", "wear.cycles=200")
            + ("analysis.output_times=['0.0625 s']",),
            id="fretting-in-space",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            DEMOS / "punch_on_strip_reciprocating.toml",
            ("mesh.degree=2", "analysis.positions=4"),
            id="reciprocating",
        ),
    ],
)
def test_an_analysis_goes_on_bitwise(case, overrides):
    """requirement: from any checkpoint the same rows, interface and summary, to the last bit."""
    case, watched = tw.load(case, (ALWAYS, *overrides)), Watched()
    whole = run(case, None, watched)
    last = len(watched.checkpoints) - 1
    assert last >= 5
    for number in (0, 2 * last // 3, last):
        again = Watched()
        saved = watched.checkpoints[number].state(rank=0)
        assert_the_same(whole, run(case, None, again, None, saved))
        told = [str(astuple(row)) for row in again.rows_again]
        assert told
        assert told == [str(row) for row in rows(whole) if str(row) in told]  # in their order


def test_states_are_unpacked_as_they_were():
    """requirement: kinds, bits, order in memory; equal numbers are not enough for equal sums."""
    face = np.asfortranarray(np.random.default_rng(0).random((3, 4)))
    row = HistoryRow(0.1, 2.0, *np.arange(13.0).tolist())
    state = {
        0.1: (face, np.float64(1 / 3), None),
        "b": [True, -0.0, float("nan"), 7, np.array([False, True])],
        "rows": [row, replace(row, time=float("nan"))],
        "empty": ([], (), {}),
        "faces": ThermalState((face, face.T), (face, face)),
    }
    found = pack(MPI.COMM_SELF, state).state(0)
    kept = found[0.1][0]
    assert (kept.flags.f_contiguous, kept.tobytes("A")) == (True, face.tobytes("A"))
    assert isinstance(found[0.1][1], np.float64)
    assert found[0.1][1:] == (np.float64(1 / 3), None)
    assert repr(found["b"]) == repr(state["b"])
    assert repr(found["rows"]) == repr(state["rows"])
    assert type(found["rows"][0].time) is float
    assert found["empty"] == ([], (), {})
    np.testing.assert_array_equal(found["faces"].rise[1], face.T)


def test_what_is_not_known_is_not_packed():
    """requirement: nothing is left out in silence, and no code of others is run."""
    with pytest.raises(TypeError, match="object"):
        pack(MPI.COMM_SELF, {"a": object()})


def test_other_bodies_are_refused():
    """requirement: a mesh or an initial shape that has changed under the same name is noticed."""
    watched = Watched()
    run(tw.load(COLD_RUNNING_IN, ("mesh.degree=2", "analysis.end_time=2 s", SHORT)), None, watched)
    saved = watched.checkpoints[-1].state(0)
    others = {"gap": saved.gap + 1e-9, "nodes": saved.nodes + 1, "moment": saved.moment + 1e-6}
    case = tw.load(COLD_RUNNING_IN, ("mesh.degree=2", "analysis.end_time=4 s", SHORT))
    assert run(case, None, None, None, saved).summary["time_s"] == 4.0
    for name, other in others.items():
        with pytest.raises(tw.CaseError, match="meshed bodies"):
            run(case, None, None, None, replace(saved, **{name: other}))


@pytest.mark.parametrize("jump", ["auto", pytest.param(100, marks=pytest.mark.slow)])
def test_more_cycles_are_those_of_a_longer_run(jump):
    """requirement: a finished run of cycles may go on for more of them, within its tolerance."""
    few, many = (
        tw.load(
            DEMOS / "tube_in_support.toml",
            ("mesh.elements=16", "analysis.output_times=[]", f"analysis.jump={jump}")
            + (f"analysis.cycles={count}", "analysis.increments=4"),
        )
        for count in (300, 700)
    )
    watched = Watched()
    run(few, None, watched)
    longer = run(many, None, None, None, watched.checkpoints[-1].state(0)).summary
    known = run(many).summary
    assert longer["cycles"] == known["cycles"] == 700
    assert longer["time_s"] == pytest.approx(known["time_s"], rel=1e-12)
    for quantity in ("wear_volume_1_m3", "wear_volume_2_m3", "dissipated_energy_J"):
        assert longer[quantity] == pytest.approx(known[quantity], rel=1e-3, abs=0.0)

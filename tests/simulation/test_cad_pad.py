"""The starter of parts that begin as CAD, computed with large elements."""

import math
import subprocess
import sys
import tomllib
from importlib import resources

import numpy as np
import pytest

import thermowear as tw
from thermowear.app.cli import main
from thermowear.case import starters

from ..cad_parts import cad_pad
from ..conftest import DEMOS
from ..test_parallel import same_on_two_ranks
from .cad_pad_on_ranks import COARSE, columns

FORCE, FRICTION, SPEED, K = 900.0, 0.38, 10.0, 3e-14


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("cad-pad")
    assert main(["init", "cad-pad", "-o", str(place / "case.toml")]) == 0
    return place


def case(folder, *changes):
    return tw.load(folder / "case.toml", overrides=(*COARSE, *changes))


@pytest.fixture(scope="module")
def steady(folder):
    return tw.run(case(folder))


@pytest.mark.slow
def test_the_same_on_two_ranks(folder, steady, tmp_path):
    """requirement: two ranks give the serial results."""
    module = "tests.simulation.cad_pad_on_ranks"
    same_on_two_ranks(module, tmp_path, columns(steady), folder / "case.toml")


def test_hot_steady_state(steady):
    """
    requirement: pressure times speed is even over both halves of the lining, the moment of friction
    and the heat follow from it, and force, moment and heat balance.
    """
    result = steady
    s = result.summary
    face = result.interface
    r = np.hypot(face.x, face.y)
    level = FORCE / (face.weight @ (1 / r))
    assert face.pressure == pytest.approx(level / r, rel=1e-3)
    torque = FRICTION * level * face.weight.sum()
    rubbing = s["contacts"]["rubbing"]
    assert rubbing["friction_torque_Nm"] == pytest.approx(torque, rel=1e-3)
    assert s["friction_power_W"] == pytest.approx(torque * SPEED, rel=1e-3)
    assert s["heat_cooled_W"] == pytest.approx(s["friction_power_W"], rel=1e-8)
    wear = s["holders"]["piston"]["rigid_wear_velocity_m_per_s"]
    assert wear == pytest.approx(K * level * SPEED, rel=1e-3)
    for name in ("equilibrium", "moment_balance", "heat_balance"):
        assert abs(s[f"{name}_relative_error"]) < 1e-9
    script = cad_pad()
    inner, outer, half, _ = script.LINING
    whole = math.radians(half) * (outer**2 - inner**2)
    assert 0.7 * whole < 1e6 * face.weight.sum() < 0.8 * whole  # without chamfers and slot
    assert not np.any(np.abs(face.y) < 1e-3 * script.SLOT[0] / 2 - 1e-6)
    assert s["max_temperature_K"] > 293.15 + 30


def test_running_in(folder):
    """requirement: unworn faces wear in: the volume is that of the load, and the peak falls."""
    result = tw.run(
        case(folder, 'analysis={type = "transient", end_time = "200 s", tolerance = 1e-2}')
    )
    pressures = [row.max_pressure for row in result.history]
    assert pressures[-1] < 0.6 * pressures[0]
    face = result.interface
    volume = face.weight @ face.wear_1
    r = np.hypot(face.x, face.y)
    assert 0.9 * K * FORCE * SPEED * 200 * r.min() < volume < K * FORCE * SPEED * 200 * r.max()


def test_files_are_those_of_their_script(tmp_path):
    """requirement: the STEP files of the starter are drawn by the script in the repository."""
    # in a process of its own: OpenCASCADE numbers the shapes of a process
    script = DEMOS / "cad_pad.py"
    subprocess.run([sys.executable, script, tmp_path], check=True, capture_output=True)
    for name in ("cad-pad.step", "cad-disk.step"):
        shipped = (resources.files(starters) / name).read_text("ascii")
        written = (tmp_path / name).read_text("ascii")
        drawn, kept = ("".join(t.partition("ENDSEC;")[2].split()) for t in (written, shipped))
        assert drawn == kept, name


def test_the_starter_is_complete():
    """requirement: files by body are copied with the case."""
    names = tomllib.loads(starters.starter_text("cad-pad"))["geometry"]["paths"].values()
    assert set(starters.starter_files("cad-pad")) == set(names)

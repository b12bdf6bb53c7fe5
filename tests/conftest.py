"""Fixtures shared by all rooms: cases, two plain blocks, runs that several tests look at."""

from __future__ import annotations

import importlib.util
import os
import signal
import sys
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")  # before numpy: runs here and in processes agree
os.environ.setdefault("OMPI_MCA_mpi_yield_when_idle", "1")  # ranks wait for others off the core

import numpy as np
import pytest
from hypothesis import HealthCheck, settings

import thermowear as tw
from thermowear.app.cli import main
from thermowear.geometry.mesh.gmsh_session import gmsh_model

from .gmsh_meshes import Interval, add_grid, tagged_mesh

# the same examples every time, so that a red test is the change's own; `make verify` looks for more
_UNTIMED = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("fixed", _UNTIMED, derandomize=True)
settings.register_profile("explore", _UNTIMED, max_examples=500)
EXPLORES = os.environ.get("HYPOTHESIS_PROFILE") == "explore"
settings.load_profile("explore" if EXPLORES else "fixed")


def examples(number: int) -> int:
    """Set the number of random examples: all in `make verify`, a quarter in `make test`."""
    return number if EXPLORES else number // 4


DEMOS = Path(__file__).parent.parent / "demos"
HOT = DEMOS / "annular_punch.toml"
COLD_RUNNING_IN = DEMOS / "annular_punch_running_in.toml"


def demo_script(name: str):
    """Script of the demos as a module."""
    spec = importlib.util.spec_from_file_location(name, DEMOS / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses look it up
    spec.loader.exec_module(module)
    return module


def cold_tables(path: Path = HOT) -> dict:
    """The tables of a case file without heat."""
    import tomllib

    tables = tomllib.loads(path.read_text(encoding="utf-8"))
    tables.pop("heat", None)
    return tables


def wear_law(b: float) -> tuple[str, str]:
    """Overrides for another pressure exponent."""
    return (
        f"wear.punch.pressure_exponent={b}",
        f'wear.punch.coefficient="2e-7 1/MPa^{b}"',
    )


NAMES = {
    "bodies": {"upper": "upper", "lower": "lower"},
    "contact": ["upper_face", "lower_face"],
    "held": "upper_end",
    "fixed": "lower_end",
}
"""Names in a file of such bodies, see `two_blocks`."""


def two_blocks(
    inner=0.05,
    outer=0.09,
    heights=(0.02, 0.03),
    columns=(3, 3),
    rows=(2, 2),
    growth=(1.0, 1.0),
    triangles=False,
    order=1,
):
    """Two blocks of one width, one above the other; faces match if their columns do.

    Body 1 is ``upper`` with surfaces ``upper_face`` and ``upper_end``, body 2 ``lower``.
    """
    with gmsh_model("blocks") as gmsh:
        spans = ((0.0, heights[0]), (-heights[1], 0.0))
        grids = [
            add_grid(gmsh.model, [Interval(inner, outer, n, g)], [Interval(*span, m)])
            for span, n, m, g in zip(spans, columns, rows, growth, strict=True)
        ]
        gmsh.model.geo.synchronize()
        upper, lower = grids
        gmsh.model.addPhysicalGroup(2, upper.surfaces, name="upper")
        gmsh.model.addPhysicalGroup(2, lower.surfaces, name="lower")
        parts = {
            "upper_face": upper.bottom,
            "upper_end": upper.top,
            "upper_inside": upper.left,
            "lower_face": lower.top,
            "lower_end": lower.bottom,
            "lower_inside": lower.left,
            "upper_outside": upper.right,
            "lower_outside": lower.right,
        }
        for name, curves in parts.items():
            gmsh.model.addPhysicalGroup(1, curves, name=name)
        gmsh.model.mesh.generate(2)
        if triangles:
            gmsh.model.mesh.splitQuadrangles(1.0)
        gmsh.model.mesh.setOrder(order)
        return tagged_mesh(gmsh.model, ("upper", "lower"), tuple(parts))


def at(interface, radii, values):
    """Values of an interface quantity at radii, by a spline through the contact points."""
    from scipy.interpolate import CubicSpline

    return CubicSpline(interface.x, values)(np.asarray(radii))


@pytest.fixture(scope="session")
def hot_steady():
    """Result of the hot steady demo, degree 8."""
    return tw.run(tw.load(HOT))


@pytest.fixture(scope="session")
def running_in():
    """Result of the running-in demo without heat, degree 8."""
    return tw.run(tw.load(COLD_RUNNING_IN))


@pytest.fixture(scope="module")
def bodies_not_drawn():
    """Curves and films are drawn, but not the bodies, which takes longest."""
    from thermowear.output.pictures import make

    every = make._of_the_bodies

    def but_bodies(*arguments):
        return {what: job for what, job in every(*arguments).items() if what != "the bodies"}

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(make, "_of_the_bodies", but_bodies)
        yield


@pytest.fixture
def heeds_ctrl_c():
    """Ctrl-C interrupts, also where the tests run in the background and ignore it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def refused(capsys):
    """Run a command that must be refused; its one line on stderr."""

    def call(*words: str) -> str:
        assert main(list(words)) == 1
        printed = capsys.readouterr()
        assert printed.out == ""
        (line,) = printed.err.splitlines()
        assert line.startswith("error: ")
        return line

    return call


@pytest.fixture
def in_folder(tmp_path, monkeypatch):
    """Run a test in a folder of its own, with the signal handlers as they were."""
    monkeypatch.chdir(tmp_path)
    before = signal.getsignal(signal.SIGTERM)
    yield
    signal.signal(signal.SIGTERM, before)

"""Optimal initial shape: a run from the design of the steady state remains in that state.

With friction heat, from the files written by ``shape``, until several times the shape is worn.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

from mpi4py import MPI

import numpy as np

from ...geometry.cad.design import write_table
from ...results import Result
from ...simulation.analyses.design import steady_design
from ...simulation.analyses.positioning import prepare
from ...simulation.from_case import model_of
from ...timer import Phases
from ..check import Check, compare
from ..starter import run_starter, starter
from .finite_elements import away_from_ends

PRINCIPLE = "steady state from the principle of minimum wear dissipation power"
HOT_SHOE = (
    "bodies.shoe.conductivity=180 W/(m K)",
    "bodies.shoe.expansion=2.3e-5 1/K",
    "bodies.lining.conductivity=1.5 W/(m K)",
    "bodies.lining.expansion=1.5e-5 1/K",
    "bodies.drum.conductivity=50 W/(m K)",
    "bodies.drum.expansion=1.1e-5 1/K",
    "heat={conductance='1e4 W/(m^2 K)', advection='spread', "
    "cooling={drum_rim='300 W/(m^2 K)', shoe_inside='100 W/(m^2 K)'}}",
)
"""Heat data of the drum brake, our own: with less cooling its steady state would be unstable."""
CASES = {"block-on-disk": (), "drum-brake": HOT_SHOE, "annular-punch": ()}
OTHER = ("mesh.elements=17", "mesh.degree=6", "mesh.grading=0.4")
TIMES = (1e-6, 1e-3, 0.01, 0.03, 0.1, 0.3, 1.0)
"""Output times relative to the end time of the run."""
_WORN = 5.0
"""Depth worn in a run, relative to the depth of the design."""


def optimal_shape() -> Iterator[Check]:
    """Largest deviation from the steady pressure in the whole run, for special cases 3, 7 and 8."""
    for name, overrides in CASES.items():
        for label, mesh in (("", ()), (", on another mesh", OTHER)):
            steady, began = _from_its_shape(name, *overrides, mesh=mesh)
            inner = away_from_ends(starter(name), steady)
            yield _worst(f"{name}, hot, from its design{label}", steady, began, inner)
            if not mesh:
                every = np.full(len(inner), True)
                yield _worst(f"{name}, hot, from its design, edges too", steady, began, every)


def _worst(label: str, steady: Result, began: Result, chosen: np.ndarray) -> Check:
    exact = steady.interface.pressure[chosen]
    off = {t: float(np.abs(i.pressure[chosen] / exact - 1).max()) for t, i in began.outputs.items()}
    worst = max(off, key=lambda t: off[t])
    quantity = (
        f"{label}: pressure over the steady one at the point of largest deviation, at "
        f"{worst:.3g} s of {max(off):.3g} s [1]"
    )
    return compare(quantity, 1.0 + off[worst], 1.0, 0.01, PRINCIPLE)


def _from_its_shape(name: str, *overrides: str, mesh: tuple[str, ...]) -> tuple[Result, Result]:
    """Steady state, and a running-in of body 1 with that shape initially.

    Both runs are on another mesh than the design, if one is given.
    """
    steady = run_starter(name, *overrides, *mesh)
    model = model_of(starter(name, *overrides))
    design = steady_design(prepare(model, MPI.COMM_WORLD, Phases(lambda _: None)), 1)
    fastest = (steady.interface.wear_rate_1 + steady.interface.wear_rate_2).max()
    end = _WORN * design.depth.max() / fastest
    times = ", ".join(f"'{part * end:.12g} s'" for part in TIMES)
    analysis = f"analysis={{type='transient', end_time='{end:.12g} s', output_times=[{times}]}}"
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "design.csv"
        write_table(design, file)
        shaped = f"geometry.initial_shape={str(file)!r}"
        return steady, run_starter(name, *overrides, *mesh, analysis, shaped)

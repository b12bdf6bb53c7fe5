"""Steady principle by finite elements: running-in to its pressure and shape, or from that shape.

A steady pressure needs no finite elements, only the worn shape does. The checks are therefore a
running-in from unworn faces, whose final pressure and shape must be the steady ones, and a run from
the design of the steady state, written by ``shape``, with friction heat, which remains in that
state until several times the shape is worn.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

from mpi4py import MPI

import numpy as np

from ....case.tables.schema import Case
from ....geometry.cad.design import write_table
from ....laws.motions import RigidMotion, rotation, translation
from ....results import Result
from ....simulation.analyses.positioning import prepare
from ....simulation.analyses.static import steady_design
from ....simulation.from_case import model_of
from ....timer import Phases
from ...check import Check, compare, computed, run_starter, starter

PRINCIPLE = "steady state from the principle of minimum wear dissipation power"
EDGE = 2e-3
"""Distance from the ends of a face that is excluded, as corner stresses are singular [m]."""

_UNWORN = "wear.update=never"
"""The steady state refers to the unworn bodies, so the running-in must not thin them."""
_TRANSIENT = "analysis={type='transient', until='steady', steady_tolerance=1e-3, tolerance=1e-3}"
_HOT_SHOE = (
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
_DESIGNS = {"block-on-disk": (), "drum-brake": _HOT_SHOE, "annular-punch": ()}
_OTHER_MESH = ("mesh.elements=17", "mesh.degree=6", "mesh.grading=0.4")
_TIMES = (1e-6, 1e-3, 0.01, 0.03, 0.1, 0.3, 1.0)
"""Output times relative to the end time of the run."""
_WORN = 5.0
"""Depth worn in a run, relative to the depth of the design."""


def running_in(
    label: str, name: str, *overrides: str, without: tuple[str, ...] = ()
) -> Iterator[Check]:
    """Pressure and worn shape at the end of a running-in from unworn faces.

    Parameters
    ----------
    label : str
        Label of the run in the output.
    name, *overrides, without
        See `starter`.
    """
    case = starter(name, *overrides, without=without)
    direct = computed(case)
    reached = computed(starter(name, *overrides, _TRANSIENT, _UNWORN, without=without))
    name = f"{name}, {label}" if label else name
    inner = away_from_ends(case, direct)
    steady = direct.interface
    off = reached.interface.pressure - steady.pressure
    found, size = (_mean_square(direct, p, inner) for p in (off, steady.pressure))
    quantity = f"{name}: pressure after running-in minus the steady one, root mean square [Pa]"
    yield compare(quantity, found, 0.0, 0.01, PRINCIPLE, size)
    off = _without_motion(case, direct, reached.interface.shape - steady.shape, inner)
    size = float(np.ptp(steady.shape[inner]))
    for measure, found, allowed in (
        ("root mean square", _mean_square(direct, off, inner), 0.01),
        ("largest", float(np.abs(off[inner]).max()), 0.02),
    ):
        quantity = f"{name}: worn shape after running-in minus the steady one, {measure} [m]"
        yield compare(quantity, found, 0.0, allowed, PRINCIPLE, size)


def away_from_ends(case: Case, result: Result) -> np.ndarray:
    """Mask of points away from the ends of the face, shape (n,); faces in space have four sides."""
    i, center = result.interface, case.geometry.rotation_center
    lengths = [i.s] if case.model != "3d" else [i.x, i.y]
    if case.model == "3d" and center is not None:
        radius = np.hypot(i.x - center[0], i.y - center[1])
        lengths = [radius, radius * np.arctan2(i.y - center[1], i.x - center[0])]
    inside = [(x > x.min() + EDGE) & (x < x.max() - EDGE) for x in lengths]
    return np.all(inside, axis=0)


def _mean_square(result: Result, values: np.ndarray, inner: np.ndarray) -> float:
    """Root mean square, weighted with the area of the points."""
    return float(np.sqrt(np.average(values[inner] ** 2, weights=result.interface.weight[inner])))


def _without_motion(
    case: Case, result: Result, heights: np.ndarray, inner: np.ndarray
) -> np.ndarray:
    """Heights minus their least-squares fit by a constant and the rigid motions of the holder.

    Shapes are determined up to these.
    """
    profile = result.profile
    points = np.column_stack([profile.x, profile.y, profile.z])
    normals = np.column_stack([profile.normal_x, profile.normal_y, profile.normal_z])
    closing = [(_motion(case, m).at(points) * normals).sum(axis=1) for m in case.holder.free]
    modes = np.column_stack([np.ones(len(points)), *closing])
    amplitudes = np.linalg.lstsq(modes[inner], heights[inner], rcond=None)[0]
    return heights - modes @ amplitudes


def _motion(case: Case, name: str) -> RigidMotion:
    """Rigid motion of the holder, of either sign."""
    if name in _AXES:
        return translation(_AXES[name])
    if name in _TURNS:
        return rotation(_TURNS[name], np.array(model_of(case).holder.pivot))
    return translation(case.geometry.press_direction)


_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0)}
_TURNS = {"rotation": (0.0, 0.0, 1.0), "rotation-x": (1.0, 0.0, 0.0), "rotation-y": (0.0, 1.0, 0.0)}


def optimal_shape() -> Iterator[Check]:
    """Largest deviation from the steady pressure in the whole run, for special cases 3, 7 and 8."""
    for name, overrides in _DESIGNS.items():
        for label, mesh in (("", ()), (", on another mesh", _OTHER_MESH)):
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
    design = steady_design(prepare(model, MPI.COMM_WORLD, Phases(lambda _: None)), 0, 0)
    fastest = (steady.interface.wear_rate_1 + steady.interface.wear_rate_2).max()
    end = _WORN * design.depth.max() / fastest
    times = ", ".join(f"'{part * end:.12g} s'" for part in _TIMES)
    analysis = f"analysis={{type='transient', end_time='{end:.12g} s', output_times=[{times}]}}"
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "design.csv"
        write_table(design, file)
        shaped = f"geometry.initial_shape={str(file)!r}"
        return steady, run_starter(name, *overrides, *mesh, analysis, shaped)

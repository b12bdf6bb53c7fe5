"""Steady states by multigrid, without condensation, against the condensed bodies."""

import shutil
import tracemalloc
from dataclasses import replace
from functools import cache

import meshio
import numpy as np
import pytest

import thermowear as tw
from thermowear.contact.operators import exchange_matrix, thermal_opening
from thermowear.contact.operators.coupled_heat import CoupledHeat
from thermowear.errors import CaseError, ComputationError
from thermowear.laws.interfaces import Multipliers, Table1D
from thermowear.model import Discretisation, Heat, Motion, StaticAnalysis
from thermowear.output.frames import write_fields
from thermowear.simulation.analyses.run import run
from thermowear.simulation.runtime.observer import Observer
from thermowear.simulation.system import system as systems
from thermowear.simulation.system import thermal_system
from thermowear.simulation.system.building import build
from thermowear.timer import Phases

from ..contact.solids import COMM, HEIGHTS, SIZE
from ..slow import marked_slow
from ..test_parallel import thermowear
from . import multigrid_on_ranks
from .hot_solids import COOLING, FORCE, BlockMeshes, hot_blocks
from .space import PUNCH

STEADY = StaticAnalysis("steady")
COARSE = BlockMeshes(((3, 3, 2), (4, 3, 2)))
TILTING = ("z", "rotation-x", "rotation-y")
HEATED = Heat(
    cooling={"upper_end": 500.0, "upper_low_x": 100.0},
    temperature={"lower_end": 350.0},
    power={"lower_low_y": 20.0},
)


class Notes(Observer):
    """Observer that keeps the notes."""

    def __init__(self):
        self.notes = []

    def note(self, text):
        self.notes.append(text)


def off_centre(model):
    """Model with a holder that tilts under a force off the centre: the pressure is not uniform."""
    holder = replace(model.holder, free=TILTING, point=(0.022, 0.014, 0.0))
    return replace(model, holders=(holder,))


@cache
def found(solver, conductance, given, cells):
    meshes = replace(COARSE, cell_type=cells)
    heat = Heat(cooling=COOLING) if given is None else HEATED
    model = off_centre(hot_blocks(meshes, solver, conductance, heat=heat))
    return run(model, STEADY)


@pytest.mark.parametrize(
    ("conductance", "given", "cells"),
    [
        (2e4, None, "tetrahedron"),
        (None, None, "tetrahedron"),
        (None, "temperature", "tetrahedron"),
        (1e9, None, "hexahedron"),
        (0.0, None, "hexahedron"),
    ],
)
def test_results_of_condensed_bodies(conductance, given, cells):
    """requirement: pressure, worn shape and temperatures of the direct solver to 1e-6.

    For finite, perfect, very large and no conductance, and given temperatures and heat.
    """
    direct, multigrid = (found(s, conductance, given, cells) for s in ("direct", "multigrid"))
    for result in (direct, multigrid):
        assert result.stopped is None
    for name in ("pressure", "shape", "temperature_1", "temperature_2", "wear_rate_1"):
        expected = getattr(direct.interface, name)
        tolerance = 1e-6 * np.ptp(expected)
        np.testing.assert_allclose(
            getattr(multigrid.interface, name), expected, rtol=0.0, atol=tolerance, err_msg=name
        )
    scale = np.abs(direct.interface.heat_flux_1).max()
    np.testing.assert_allclose(
        multigrid.interface.heat_flux_1, direct.interface.heat_flux_1, rtol=0.0, atol=1e-5 * scale
    )
    summary = multigrid.summary
    assert (summary["solver"], direct.summary["solver"]) == ("multigrid", "direct")
    assert summary["max_temperature_K"] == pytest.approx(direct.summary["max_temperature_K"], 1e-8)
    assert summary["heat_balance_relative_error"] < 1e-8
    assert summary["equilibrium_relative_error"] < 1e-8
    assert 0 < summary["multigrid_iterations_elasticity"] <= 16
    assert 0 < summary["multigrid_iterations_conduction"] <= 40
    fields = multigrid.fields, direct.fields
    np.testing.assert_allclose(fields[0].temperature, fields[1].temperature, rtol=1e-7)


def test_conditions_that_depend_on_the_state():
    """requirement: friction and conductance by temperature and pressure, direct and multigrid."""
    softening = Multipliers({"T": Table1D((300.0, 1500.0), (1.0, 0.4))})
    conductance = Multipliers({"p": Table1D((0.0, 5e6), (1e3, 5e4))})
    model = off_centre(hot_blocks(COARSE, "direct"))
    face = replace(model.interface, friction_factors=softening, conductance=conductance)
    model = replace(model, interfaces=(face,))
    direct = run(model, STEADY)
    multigrid = run(replace(model, discretisation=Discretisation(2, solver="multigrid")), STEADY)
    assert direct.summary["friction_max"] > 1.01 * direct.summary["friction_min"]
    for name in ("pressure", "shape", "temperature_1", "temperature_2"):
        expected = getattr(direct.interface, name)
        np.testing.assert_allclose(
            getattr(multigrid.interface, name), expected, rtol=0.0, atol=1e-6 * np.ptp(expected)
        )


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_fields_of_tetrahedra(degree, tmp_path):
    """requirement: small tetrahedra of positive volume that fill the bodies, also in the file."""
    model = replace(hot_blocks(BlockMeshes(), "direct", degree=degree), heat=None)
    fields = run(model, STEADY).fields
    corners = fields.points[:, fields.pieces]
    volumes = np.linalg.det(corners[:, :, 1:] - corners[:, :, :1]) / 6
    assert volumes.min() > 0.0
    for body, height in zip((1, 2), HEIGHTS, strict=True):
        volume = volumes[fields.body == body].sum()
        assert volume == pytest.approx(np.prod(SIZE) * height, rel=1e-9)
    write_fields(tmp_path / "fields.vtu", fields)
    (block,) = meshio.read(tmp_path / "fields.vtu").cells
    assert (block.type, len(block.data)) == ("tetra", volumes.size)


def test_a_cold_steady_state():
    """requirement: worn shape of isothermal bodies, direct and multigrid, to 1e-6."""
    direct, multigrid = (
        run(replace(off_centre(hot_blocks(COARSE, solver)), heat=None), STEADY)
        for solver in ("direct", "multigrid")
    )
    shape = direct.interface.shape
    np.testing.assert_allclose(
        multigrid.interface.shape, shape, rtol=0.0, atol=1e-6 * np.ptp(shape)
    )
    assert "multigrid_iterations_conduction" not in multigrid.summary


def test_nothing_is_condensed(monkeypatch):
    """requirement: no array of contact points by contact points, or by pressure functions."""

    def refused(*arguments):
        raise AssertionError("condensed")

    monkeypatch.setattr(systems, "influence", refused)
    monkeypatch.setattr(thermal_system, "condense_heat", refused)
    monkeypatch.setattr(exchange_matrix, "blocks", refused)
    monkeypatch.setattr(thermal_opening, "blocks", refused)
    observer, meshes = Notes(), BlockMeshes(((9, 8, 2), (10, 7, 2)))
    meshes.tagged  # noqa: B018  # before memory is measured
    tracemalloc.start()
    try:
        result = run(hot_blocks(meshes, "multigrid", None), STEADY, observer=observer)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    points = result.summary["contact_points"]
    assert points > 5000
    assert peak < 8 * points**2 / 2
    assert sum(note.startswith("solver: multigrid") for note in observer.notes) == 1
    assert 0.0 < result.summary["temperature_error_estimate_relative"] < 1.0


def test_many_points_are_not_condensed_with_the_direct_solver_either(monkeypatch):
    """requirement: the same results by the coupled bodies with a direct solver, to 1e-8."""
    expected = found("direct", 2e4, None, "tetrahedron")
    monkeypatch.setattr(thermal_system, "_MOST_CONDENSED", 10)
    model = off_centre(hot_blocks(COARSE, "direct"))
    system = build(model, COMM, Phases(), single=True)
    assert isinstance(system.thermal.face, CoupledHeat)
    result = run(model, STEADY)
    shape = expected.interface.shape
    np.testing.assert_allclose(result.interface.shape, shape, rtol=0.0, atol=1e-8 * np.ptp(shape))
    assert 0.0 < result.summary["temperature_error_estimate_relative"] < 1.0


@pytest.mark.parametrize("solver", ["direct", "multigrid"])
def test_a_heated_body_without_cooling_is_an_error(solver):
    """requirement: no result of a run in which a body has no heat sink."""
    model = hot_blocks(COARSE, solver, 0.0, heat=Heat(cooling={"lower_end": 2000.0}))
    result = run(model, STEADY)
    assert isinstance(result.stopped, ComputationError)
    assert "heat balance" in str(result.stopped)


def test_first_contact_by_multigrid():
    """requirement: contact of the unworn faces, condensed by multigrid, to 1e-6."""
    slow = Motion(velocity=0.02)
    direct, multigrid = (
        run(hot_blocks(BlockMeshes(), solver, motion=slow), StaticAnalysis("initial"))
        for solver in ("direct", "multigrid")
    )
    direct, multigrid = direct.interface.pressure, multigrid.interface.pressure
    assert direct.max() > FORCE / 0.0012
    np.testing.assert_allclose(multigrid, direct, rtol=0.0, atol=1e-6 * direct.max())


@pytest.mark.parametrize("conductance", [2e4, None])
@pytest.mark.parametrize("advection", ["resolved", "spread"])
def test_heat_carried_along(advection, conductance):
    """requirement: a strip that passes heats up as with the direct solver, to 1e-6."""
    heat = Heat(cooling=COOLING, advection=advection)
    passing = Motion(velocity=0.05, passes=True)
    model = hot_blocks(COARSE, "multigrid", conductance, heat=heat, motion=passing)
    model = replace(
        model,
        bodies=tuple(
            replace(body, materials={part: replace(m, density=7e3, specific_heat=500.0)})
            for body in model.bodies
            for part, m in body.materials.items()
        ),
    )
    multigrid = run(model, STEADY)
    direct = run(replace(model, discretisation=Discretisation(2, solver="direct")), STEADY)
    assert multigrid.summary["solver"] == "multigrid"
    expected = direct.interface.temperature_2
    np.testing.assert_allclose(
        multigrid.interface.temperature_2,
        expected,
        rtol=0.0,
        atol=1e-6 * (expected.max() - heat.ambient),
    )
    assert multigrid.summary["heat_balance_relative_error"] < 1e-8


def test_the_solver_in_a_case_file():
    """requirement: ``mesh.solver`` selects the solver; other words are an error of the case."""
    result = tw.run(tw.load(PUNCH, ("mesh.solver=multigrid", "mesh.elements=2")))
    assert result.summary["solver"] == "multigrid"
    with pytest.raises(CaseError, match=r"mesh\.solver"):
        tw.load(PUNCH, ("mesh.solver=fast",))


@pytest.mark.skipif(shutil.which("mpirun") is None, reason="needs mpirun")
@pytest.mark.parametrize("conductance", marked_slow(["2e4", "perfect"], "perfect"))
def test_two_ranks_give_the_serial_numbers(tmp_path, conductance):
    """requirement: two ranks give the interface of the serial run to 1e-8, direct to 1e-6."""
    done = thermowear(2, conductance, tmp_path, module="tests.simulation.multigrid_on_ranks")
    assert done.returncode == 0, done.stderr
    given = None if conductance == "perfect" else float(conductance)
    for solver, tolerance in (("multigrid", 1e-8), ("direct", 1e-6)):
        serial = multigrid_on_ranks.computed(given, solver)
        for rank in (0, 1):
            parallel = np.load(tmp_path / f"found_{rank}.npz")
            for name in ("pressure", "shape", "temperature_1", "temperature_2", "wear_rate_1"):
                expected = serial[name]
                np.testing.assert_allclose(
                    parallel[name],
                    expected,
                    rtol=0.0,
                    atol=tolerance * np.ptp(expected),
                    err_msg=f"{name}, {solver}",
                )

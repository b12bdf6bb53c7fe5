"""Conductivity and expansion that change with temperature."""

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.bulk.bodies import distribute
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.heat.heat_equation import ThermalMaterial, conduction
from thermowear.bulk.heat.varying import thermal_forces, varying_conduction, varying_expansion
from thermowear.bulk.kinematics import Axisymmetric
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.case.tables.tabulated import ExpansionTable, TemperatureTable

from ..conftest import two_blocks
from .fields import empty_matrix

AMBIENT = 293.15
TABLE = {"at": ["20 degC", "120 degC", "220 degC"], "factor": [1.0, 1.4, 1.1]}


def test_factor_has_a_slope_and_an_integral():
    """requirement: value, slope and integral of a piecewise linear table, also beyond its ends."""
    factor = TemperatureTable(**TABLE).table
    T = np.array([200.0, 300.0, 400.0, 450.0, 600.0])
    ε = 1e-4
    slope = (factor.value(T + ε) - factor.value(T - ε)) / (2 * ε)
    np.testing.assert_allclose(factor.slope(T), slope, atol=1e-10)
    derivative = (factor.integral(AMBIENT, T + ε) - factor.integral(AMBIENT, T - ε)) / (2 * ε)
    np.testing.assert_allclose(derivative, factor.value(T), rtol=1e-8)
    assert factor.integral(AMBIENT, np.array([493.15]))[0] == pytest.approx(120 + 125)
    assert factor.integral(AMBIENT, np.array([AMBIENT]))[0] == 0.0


def two_rings():
    return distribute(
        two_blocks(columns=(3, 3)) if MPI.COMM_WORLD.rank == 0 else None, MPI.COMM_WORLD
    )


def varying(degree=4):
    bodies = two_rings()
    spaces = lagrange_spaces(bodies, degree)
    k = {"upper": ThermalMaterial(50.0), "lower": ThermalMaterial(15.0)}
    surfaces = {"upper_end": 300.0}, {"lower_end": 12.0}
    constant = conduction(bodies, Axisymmetric(), spaces, k, *surfaces, empty_matrix(spaces))
    factors = {"upper": TemperatureTable(**TABLE).table}
    return varying_conduction(constant, bodies, Axisymmetric(), k, factors, AMBIENT)


def test_tangent_is_the_derivative():
    """requirement: the tangent is consistent with the nonlinear fluxes and their derivative."""
    conducting = varying()
    x = conducting.spaces.nodes()
    rise, change = 80 + 500 * x[:, 1], 1e-3 * np.sin(40 * x[:, 0])

    def flows(values):
        held = conducting.linearisation_error(values, rise)
        left, right = tangent.conductivity.createVecs()
        left.setArray(values)
        tangent.conductivity.mult(left, right)
        return right.getArray() - held

    tangent = conducting.tangent(rise)
    before, after = flows(rise), flows(rise + change)
    left, right = tangent.conductivity.createVecs()
    left.setArray(change)
    tangent.conductivity.mult(left, right)
    linear = right.getArray()
    assert np.abs(after - before - linear).max() <= 1e-4 * np.abs(linear).max()
    assert np.abs(before).max() > 0


def test_heat_balances():
    """requirement: heat input equals losses by cooling and given temperatures, to 1e-10."""
    conducting = varying()
    free = ~conducting.fixed
    heat = np.where(free, 0.02, 0.0)
    rise = conducting.prescribed
    for _ in range(30):
        tangent = conducting.tangent(rise)
        rise = tangent.solve(heat + conducting.linearisation_error(rise, rise))
    put_in = conducting.spaces.comm.allreduce(heat.sum())
    assert sum(conducting.losses(rise, heat)) == pytest.approx(put_in, rel=1e-10)
    assert conducting.exchanged_heat(rise, heat) == pytest.approx(put_in, rel=1e-10)


@pytest.mark.parametrize("rise", [60.0, 150.0, 400.0])
def test_free_expansion(rise):
    """requirement: uniformly heated rings expand by factor(T) alpha T in all directions."""
    bodies = two_rings()
    α, ν = 1.2e-5, 0.3
    materials = dict.fromkeys(("upper", "lower"), ElasticMaterial(2e11, ν, α))
    elastic = elasticity(
        bodies, Axisymmetric(), 3, materials, [], rollers=("upper_end", "lower_end")
    )
    spaces = lagrange_spaces(bodies, 3)
    factor = ExpansionTable(**TABLE).table
    parts = varying_expansion(elastic, spaces, {"upper": factor}, AMBIENT)
    load = elastic.thermal_load(spaces)
    forces = thermal_forces(load, parts, np.full(spaces.owned, rise))
    moved = elastic.solve(forces).reshape(-1, 2)
    nodes = elastic.nodes()
    upper = elastic.owned_by("upper")
    strain = np.where(upper, factor.value(np.array(AMBIENT + rise)), 1.0) * α * rise
    ends = np.where(upper, nodes[:, 1].max(), nodes[:, 1].min())
    np.testing.assert_allclose(moved[:, 0], strain * nodes[:, 0], rtol=1e-9)
    np.testing.assert_allclose(moved[:, 1], strain * (nodes[:, 1] - ends), rtol=1e-9, atol=1e-15)

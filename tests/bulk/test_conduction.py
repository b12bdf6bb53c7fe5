"""Steady heat conduction."""

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.bulk.bodies import distribute
from thermowear.bulk.heat.heat_equation import ThermalMaterial, conduction
from thermowear.bulk.kinematics import Axisymmetric
from thermowear.bulk.spaces import lagrange_spaces

from ..conftest import two_blocks
from .fields import empty_matrix, interpolated


def build(degree, cooling, given, columns=3):
    tagged = two_blocks(columns=(columns, columns)) if MPI.COMM_WORLD.rank == 0 else None
    bodies = distribute(tagged, MPI.COMM_WORLD)
    spaces = lagrange_spaces(bodies, degree)
    k = {"upper": ThermalMaterial(50.0), "lower": ThermalMaterial(15.0)}
    nothing = empty_matrix(spaces)
    return conduction(bodies, Axisymmetric(), spaces, k, cooling, given, nothing)


@pytest.mark.parametrize("degree", [1, 4, 8])
def test_linear_profile_between_cooling_and_given_temperature(degree):
    """requirement: the solution of a slab with a cooled end is exact at any degree."""
    h, k, hot = 2000.0, 50.0, 80.0
    conducting = build(degree, {"upper_end": h}, {"upper_face": hot, "lower_end": 0.0})
    rise = conducting.solve(np.zeros(conducting.spaces.owned))
    flux = hot / (0.02 / k + 1 / h)
    exact = interpolated(
        conducting.spaces, lambda x: np.where(x[1] >= 0, hot - flux / k * x[1], 0.0)
    )
    upper = conducting.spaces.nodes()[:, 1] > 1e-9
    assert np.abs(rise - exact)[upper].max() <= 1e-10 * hot


def test_cylinder_shell():
    """requirement: radial conduction, T = T1 ln(r2/r)/ln(r2/r1): the measure 2πr is right."""
    conducting = build(8, {}, {"upper_inside": 100.0, "lower_end": 0.0})
    heat = np.zeros(conducting.spaces.owned)
    rise = conducting.solve(heat)
    upper = conducting.spaces.nodes()[:, 1] > 1e-9
    assert np.abs(rise[upper] - 100.0).max() < 1e-9  # insulated elsewhere: uniform
    exact = interpolated(conducting.spaces, lambda x: np.log(0.09 / x[0]) * 100)
    x, y = conducting.conductivity.createVecs()
    x.setArray(exact)
    conducting.conductivity.mult(x, y)
    nodal = y.getArray().copy()
    r = conducting.spaces.nodes()[:, 0]
    inside = np.abs(r - 0.05) < 1e-9
    total = conducting.spaces.comm.allreduce(nodal[inside].sum())
    assert total == pytest.approx(2 * np.pi * 100 * (50.0 * 0.02 + 15.0 * 0.03), rel=1e-9)
    between = (r > 0.0501) & (r < 0.0899)
    assert np.abs(nodal[between]).max() <= 1e-8 * np.abs(nodal).max()


def test_outflow_equals_the_heat_put_in():
    """requirement: heat input equals losses by cooling and given temperatures, to 1e-10."""
    conducting = build(5, {"upper_end": 300.0}, {"lower_end": 12.0})
    heat = interpolated(conducting.spaces, lambda x: np.exp(10 * x[0] + 20 * x[1]))
    heat = np.where(conducting.fixed, 0.0, heat)
    rise = conducting.solve(heat)
    net, turnover = sum(conducting.losses(rise, heat)), conducting.exchanged_heat(rise, heat)
    put_in = conducting.spaces.comm.allreduce(heat.sum())
    assert net == pytest.approx(put_in, rel=1e-10)
    assert turnover >= abs(net) * (1 - 1e-12)


def test_each_surface_is_cooled_by_its_own_coefficient():
    """requirement: heat lost per uniform rise is h times the area, summed over all surfaces."""
    cooling = {"upper_inside": 300.0, "lower_end": 70.0, "upper_end": 11.0, "upper_outside": 70.0}
    conducting = build(3, cooling, {})
    ones = np.ones(conducting.spaces.owned)
    r, r_outer = 0.05, 0.09
    ring, height = np.pi * (r_outer**2 - r**2), 0.02
    walls = 2 * np.pi * height * (300.0 * r + 70.0 * r_outer)
    cooled, _, _ = conducting.losses(ones, np.zeros_like(ones))
    assert cooled == pytest.approx(walls + (70.0 + 11.0) * ring, rel=1e-12)

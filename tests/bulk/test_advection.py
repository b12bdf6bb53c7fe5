"""Heat that moving bodies carry along."""

import numpy as np
import pytest
import ufl
from dolfinx import fem
from dolfinx.fem.petsc import assemble_vector

from thermowear import load
from thermowear.bulk.bodies import distribute
from thermowear.bulk.heat.advection import Passage
from thermowear.bulk.spaces import as_function, lagrange_spaces

from ..conftest import DEMOS
from .fields import interpolated, times
from .passing import (
    COMM,
    INNER,
    OUTER,
    STEEL,
    along,
    conducting,
    largest,
    ring,
    strip,
    total,
    turning,
)

K, C = STEEL.conductivity, STEEL.capacity
DIFFUSIVITY = K / C
LENGTH, HEIGHT = 0.02, 0.01


def random_rise(conduction, seed=0):
    x = conduction.spaces.nodes()
    phases = np.random.default_rng(seed).uniform(0, 7, 4)
    return np.sin(437 * x[:, 0] + phases[0]) * np.cos(291 * x[:, 1] + phases[1])


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("peclet", [1.0, 10.0])
def test_between_two_given_temperatures(peclet, sense):
    """requirement: exact temperature profile of conduction along or against the motion."""
    speed = sense * peclet * DIFFUSIVITY / LENGTH
    given = {"strip_left": 0.0, "strip_right": 100.0}
    moving = conducting(strip(), 8, along(speed), given)
    exact = interpolated(
        moving.spaces,
        lambda x: 100 * np.expm1(sense * peclet * x[0] / LENGTH) / np.expm1(sense * peclet),
    )
    assert not moving.advection.stabilised
    assert largest(moving.solve(np.zeros(len(exact))) - exact) < 1e-6 * 100


@pytest.mark.parametrize("center", [None, (0.0, 0.0), (0.003, -0.004)])
def test_velocity_is_that_of_a_rigid_body(center):
    """requirement: advection of a linear rise gives the velocity: +x, or anticlockwise."""
    moving = conducting(strip(), 2, Passage(("strip",), center, 3.0, spread=False))
    velocity = (3.0, 0.0)
    if center is not None:  # its mean is that of the middle
        velocity = (-3.0 * (HEIGHT / 2 - center[1]), 3.0 * (LENGTH / 2 - center[0]))
    for axis, mean in enumerate(velocity):
        rise = interpolated(moving.spaces, lambda x, axis=axis: x[axis])
        coming_in = (
            times(moving.advection.carried, np.ones(len(rise))) * rise
        )  # not inside: 1 has no slope
        carried = total(times(moving.advection.carried, rise) - coming_in)
        assert carried == pytest.approx(C * mean * LENGTH * HEIGHT, abs=1e-9 * C * LENGTH * HEIGHT)


@pytest.mark.parametrize("degree", [1, 2, 5])
@pytest.mark.parametrize("bend", [0.0, 0.1])
@pytest.mark.parametrize("speed", [1e-4, 1.0])
def test_what_a_strip_carries_out(degree, bend, speed):
    """requirement: the nodal sum equals the heat through the right end for any rise."""
    moving = conducting(strip(bend=bend), degree, along(speed))
    assert moving.advection.stabilised == (speed == 1.0)
    rise = random_rise(moving)
    (field,) = moving.spaces.functions(rise, "rise")
    ds = ufl.Measure("ds", metadata={"quadrature_degree": 2 * degree + 4})
    normal = ufl.FacetNormal(field.function_space.mesh)[0]
    out = fem.assemble_scalar(fem.form(C * speed * ufl.max_value(normal, 0) * field * ds))
    out = total(out)
    carried = times(moving.advection.carried, rise)
    assert total(carried) == pytest.approx(out, abs=1e-12 * C * speed * HEIGHT)


@pytest.mark.parametrize("degree", [1, 3, 5])
@pytest.mark.parametrize("speed", [1e-3, 10.0])
def test_a_ring_loses_and_makes_nothing(degree, speed):
    """requirement: heat is conserved on curved cells to 1e-12, stabilised or not."""
    moving = conducting(ring(), degree, turning(speed))
    rise = random_rise(moving)
    carried = times(moving.advection.carried, rise)
    assert abs(total(carried)) < 1e-12 * C * speed * OUTER**2
    assert abs(total(carried)) < 1e-11 * total(np.abs(carried))
    assert largest(times(moving.advection.carried, np.ones(len(rise)))) < 1e-11 * largest(carried)


def test_a_ring_that_turns_keeps_what_is_even_round_it():
    """requirement: rigid rotation does not change an axisymmetric temperature."""
    given, cooling = {"ring_rim": 100.0}, {"ring_bore": 3e3}
    bodies = ring()
    still = conducting(bodies, 4, None, given, cooling)
    rise = still.solve(np.zeros(still.spaces.owned))
    r = np.linalg.norm(still.spaces.nodes(), axis=1)
    flux = 100 / (np.log(OUTER / INNER) / K + 1 / (3e3 * INNER))
    exact = 100 - flux * np.log(OUTER / r) / K
    for speed in (1e-2, 1.0, 100.0):
        moving = conducting(bodies, 4, turning(speed), given, cooling)
        found = moving.solve(np.zeros(len(rise)))
        assert largest(found - exact) < 1e-4 * 100
        assert largest(found - rise) < 1e-6 * 100  # the cells are round to 6e-7
        ψ = fem.Function(moving.spaces.each[0])
        ψ.interpolate(turning(1.0).stream(ψ.function_space.mesh))
        even = ψ.x.array[: len(rise)] ** 2 / OUTER**4
        if not moving.advection.stabilised:  # upwinding asks what is conducted too
            assert largest(times(moving.advection.carried, even)) < 1e-13 * C * speed * OUTER**2


def test_heat_goes_where_the_body_goes():
    """requirement: a heated spot has a wake downstream, anticlockwise and along +x."""
    bodies = strip(8, 4)
    for sense in (1, -1):
        moving = conducting(bodies, 3, along(sense * 1e-2))
        x, y = moving.spaces.nodes().T
        spot = np.exp(-(((x - LENGTH / 2) / 1e-3) ** 2) - ((y - HEIGHT) / 1e-3) ** 2)
        rise = moving.respond(spot)
        right, left = total(rise[x > 0.6 * LENGTH]), total(rise[x < 0.4 * LENGTH])
        assert sense * (right - left) > 0.7 * (right + left)
    for sense in (1, -1):
        turns = conducting(ring(), 3, turning(sense * 1.0), {"ring_bore": 0.0})
        x, y = turns.spaces.nodes().T
        rise = turns.respond(np.exp(-((x / 1e-3) ** 2) - ((y - OUTER) / 1e-3) ** 2))
        skin = (np.hypot(x, y) > 0.9 * OUTER) & (y > 0)
        left, right = total(rise[skin & (x < -0.005)]), total(rise[skin & (x > 0.005)])
        assert sense * (left - right) > 0.3 * (left + right)


def test_upwind_only_where_cells_are_too_large():
    """requirement: the cell Péclet number is |v| h/(2 κ degree); up to 1 nothing is added."""
    h, degree = LENGTH / 4, 3
    for wanted in (0.5, 0.99, 1.01, 40.0):
        speed = wanted * 2 * DIFFUSIVITY * degree / h
        moving = conducting(strip(4, 2), degree, along(-speed))
        assert moving.advection.peclet == pytest.approx(wanted, rel=1e-12)
        assert moving.advection.stabilised == (wanted > 1)
    slow, fast = (conducting(ring(), 3, turning(speed)) for speed in (5e-2, 10.0))
    assert not slow.advection.stabilised
    assert fast.advection.stabilised
    for moving in (slow, fast):  # whatever goes round, none of it adds to T² but the upwinding
        rise = random_rise(moving)
        work = total(rise * times(moving.advection.carried, rise))
        size = total(np.abs(rise * times(moving.advection.carried, rise)))
        assert (abs(work) > 1e-3 * size) == moving.advection.stabilised


@pytest.mark.parametrize("step", [None, 0.05])
@pytest.mark.parametrize(("degree", "cells"), [(1, (8, 16, 32)), (2, (6, 12, 24)), (3, (4, 8, 16))])
@pytest.mark.parametrize("fast", [2.0, 400.0])
def test_order_of_convergence(degree, cells, fast, step):
    """requirement: L2 order degree + 1, with stabilisation degree + 1/2.

    Of degree 1 stabilised alone only order 1: no second derivatives, so the upwinding is not
    consistent there with what is conducted.

    ``T = exp(-α x) cos(β y)`` solves ``v ∂T/∂x = κ ΔT`` for ``β² = α² + v α/κ``; in a step of time
    it comes from ``T (1 + step s)`` with ``s = -v α - κ (α² - β²)``.
    """
    speed, β = fast * DIFFUSIVITY / LENGTH, 2.4 / HEIGHT
    α = -speed / (2 * DIFFUSIVITY) + np.hypot(speed / (2 * DIFFUSIVITY), β)
    if step is not None:
        α *= 1.3
    growth = -speed * α - DIFFUSIVITY * (α**2 - β**2)
    errors = []
    for n in cells:
        bodies = strip(n, n)
        moving = conducting(bodies, degree, along(speed))
        assert moving.advection.stabilised == (fast > 100)
        mesh, space = bodies.each[0].mesh, moving.spaces.each[0]
        x, y = ufl.SpatialCoordinate(mesh)
        exact = ufl.exp(-α * x) * ufl.cos(β * y)
        n_out, dT = ufl.FacetNormal(mesh), ufl.TestFunction(space)
        ds = ufl.Measure("ds", metadata={"quadrature_degree": 2 * degree + 4})
        into = C * speed * ufl.max_value(-n_out[0], 0) * exact
        heat = assemble_vector(
            fem.form((K * ufl.dot(ufl.grad(exact), n_out) + into) * dT * ds)
        ).array
        if step is not None:
            exact_now = interpolated(moving.spaces, lambda x: np.exp(-α * x[0]) * np.cos(β * x[1]))
            heat = heat + moving.stored_heat(exact_now * (1 + step * growth)) / step
            moving = moving.implicit_euler(step)
        rise = as_function(space, moving.respond(heat), "rise")
        dx = ufl.Measure("dx", metadata={"quadrature_degree": 2 * degree + 6})
        errors.append(fem.assemble_scalar(fem.form((rise - exact) ** 2 * dx)) ** 0.5)
    orders = np.log(np.array(errors[:-1]) / errors[1:]) / np.log(2)
    if fast < 100:
        assert orders[-1] > degree + 0.9
    else:
        assert orders[-1] > (degree + 0.4 if degree > 1 else 1.1)


@pytest.mark.parametrize("speed", [0.1, 10.0])
@pytest.mark.parametrize("step", [None, 0.1])
def test_what_is_sensed_is_the_adjoint(speed, step):
    """requirement: `sense` is the adjoint of `respond`."""
    moving = conducting(ring(), 3, turning(speed), {"ring_bore": 5.0}, {"ring_rim": 1e3})
    assert moving.advection.stabilised == (speed == 10.0)
    moving = moving if step is None else moving.implicit_euler(step)
    heat = np.column_stack([random_rise(moving, seed) for seed in range(3)])
    weights = np.column_stack([random_rise(moving, seed) for seed in range(5, 9)])
    forward = total_product(weights, moving.respond(heat))
    np.testing.assert_allclose(
        total_product(moving.adjoint_response(weights), heat), forward, rtol=1e-10
    )
    assert largest(moving.adjoint_response(weights) - moving.respond(weights)) > 1e-4 * largest(
        moving.respond(weights)
    )


def total_product(left, right):
    return COMM.allreduce(left.T @ right)


def test_bodies_that_stay_are_left_alone():
    """requirement: a resting body is not affected by advection in the other."""
    tagged = load(DEMOS / "block_on_disk.toml", ("mesh.degree=2",)).tagged_mesh()
    bodies = distribute(tagged, COMM)
    passage = Passage(("disk",), (0.0, 0.0), 100.0, spread=False)
    still, moving = conducting(bodies, 2), conducting(bodies, 2, passage)
    assert moving.advection.stabilised
    block = np.flatnonzero(still.spaces.nodes_of(bodies, "block"))
    rise = np.zeros(still.spaces.owned)
    rise[block] = random_rise(still)[block]
    np.testing.assert_array_equal(times(moving.advection.carried, rise), 0.0)
    for name in ("conductivity", "capacity"):
        before, after = (times(getattr(found, name), rise) for found in (still, moving))
        np.testing.assert_allclose(after, before, rtol=0, atol=1e-14 * largest(before))
        disk = np.setdiff1d(np.arange(len(rise)), block)
        other = np.zeros(len(rise))
        other[disk] = random_rise(still)[disk]
        before, after = (times(getattr(found, name), other) for found in (still, moving))
        assert largest(after - before) > 1e-3 * largest(before)


def test_uniform_temperature_along_paths_needs_rows_of_cells():
    """requirement: an unstructured mesh is refused, rather than conducting across paths alone."""
    from thermowear.bulk.heat.paths import EvenPaths
    from thermowear.errors import CaseError

    from ..contact.solids import bent, gathered, straight, two_solids

    passage = Passage(("lower",), None, 1.0, spread=True)
    for place, refused in ((straight, False), (bent, True)):
        bodies, _ = gathered(two_solids(maps=(place, place), cell_type="tetrahedron"))
        spaces = lagrange_spaces(bodies, 1)
        if refused:
            with pytest.raises(CaseError, match="rows of cells along the motion of 'lower'"):
                EvenPaths(bodies, spaces, passage)
        else:
            EvenPaths(bodies, spaces, passage)

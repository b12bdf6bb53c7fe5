"""Contact from far away, on rough faces: what comes back as converged is right."""

import numpy as np
import pytest

import thermowear as tw
from thermowear.case.starters import starter_text
from thermowear.contact.wear.implicit_step import Slope
from thermowear.contact.wear.wear_edge import shortest_compliance
from thermowear.parallel import sum_over_ranks
from thermowear.simulation.interface.interface_problem import interface_problem
from thermowear.simulation.system.conditions import ConditionModel

from ..conftest import EXPLORES
from ..systems import built

TRIES = 200 if EXPLORES else 10


@pytest.fixture(scope="module")
def tables():
    import tomllib

    return tomllib.loads(starter_text("cylinder-on-block"))


def random_problem(system, rng):
    """A rough gap, far away or near, and a load."""
    s = system.pairing.position / system.pairing.position[-1]
    waves = sum(rng.normal() / k * np.sin(k * np.pi * s + rng.uniform(0, 6)) for k in range(1, 9))
    rough = 10 ** rng.uniform(-8, -5) * waves
    return system.pairing.gap + rough + 10 ** rng.uniform(-7, 0), 10 ** rng.uniform(0, 3)


@pytest.mark.parametrize("method", ["condensed", "pointwise", "nitsche", "penalty"])
def test_no_wrong_pressure_is_returned(tables, method):
    """requirement: from random starts, re-checked with bodies solved anew."""
    changes = ("contact.positioning=false", f"contact.method={method}", "mesh.degree=3")
    case = tw.load(tables, (*changes, "load={force='1 N'}"))
    system = built(case)
    rng = np.random.default_rng(7)
    nothing, everywhere = np.zeros(len(system.weights)), np.ones(len(system.weights), dtype=bool)
    for _ in range(TRIES):
        gap, force = random_problem(system, rng)
        object.__setattr__(system.holder.rigid_modes[0], "load", force)
        conditions = ConditionModel(system).at(0.0, nothing, None, everywhere)
        found = interface_problem(system)._method.solve(
            gap, Slope.diagonal(nothing), None, conditions, None
        )
        p, w = found.pressure, system.weights
        assert p.min() >= 0
        assert system.holder.force_response[:, 0] @ (w * p) == pytest.approx(force, rel=1e-8)
        deflection = system.elastic.solve(system.traction @ (w * p))
        opened = sum_over_ranks(system.comm, system.trace.T @ deflection)
        left = gap + opened - system.holder.closure @ found.motion
        assert not violated(system, method, p, left, np.ptp(gap) + np.abs(opened).max())


def violated(system, method, p, left, scale):
    """True if the pressure violates the contact conditions in the sense of its method."""
    if method == "condensed":
        weak = system.contact.weak(left) / system.contact.weighted.sum(axis=0)
        coefficients = np.linalg.lstsq(system.basis, p, rcond=None)[0]
        touching = coefficients > 1e-6 * coefficients.max()
        return weak.min() < -1e-8 * scale or np.abs(weak[touching]).max() > 1e-8 * scale
    if method == "pointwise":
        remainder = p - system.basis @ system.contact.projected(p)
        own = system.elastic.solve(system.trace @ (system.weights * remainder))
        left = left - sum_over_ranks(system.comm, system.trace.T @ own)
        left = left + shortest_compliance(system.contact) * remainder
        return left.min() < -1e-8 * scale or np.abs(left[p > 0]).max() > 1e-8 * scale
    if method == "penalty":
        from thermowear.contact.full.nitsche import default_penalty

        stiffness = default_penalty(system.elastic, system.pairing)
        return np.abs(p - stiffness * np.maximum(-left, 0)).max() > 1e-5 * p.max()
    # Nitsche's method closes the gap up to the error of the mesh
    return left.min() < -0.02 * scale or np.abs(left[p > 0]).max() > 0.02 * scale

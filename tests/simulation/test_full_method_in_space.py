"""Penalty and Nitsche's method in space: patch test through faces that do not match, pressures."""

from dataclasses import replace

import numpy as np
import pytest

import thermowear as tw
from thermowear.model import (
    Body,
    ContactMethod,
    Discretisation,
    Holder,
    Interface,
    Material,
    Model,
)
from thermowear.model.analyses import StaticAnalysis
from thermowear.simulation.analyses.run import run
from thermowear.verification.cases.contact.contact_methods import HEIGHTS, MODULI, PRESSURE
from thermowear.verification.cases.contact.patch_in_space import PatchInSpace

from .extruded import Blocks

UPPER, LOWER = np.linspace(-3.3e-3, 3.3e-3, 10), np.linspace(-5e-3, 5e-3, 10)
UP = np.array([0.0, 3e-3, 8e-3])
FORCES = {"ball": 3e3, "pad": 1e3}
POINTS = {"ball": 0.15, "pad": 0.04}
CELLS = {
    "hexahedra": (False, False),
    "tetrahedra": (True, True),
    "tetrahedra on hexahedra": (True, False),
}


@pytest.mark.parametrize("theta", [-1, 1])
@pytest.mark.parametrize("cells", list(CELLS))
@pytest.mark.parametrize(("order", "degree"), [(1, 1), (1, 2), (1, 3), (2, 2)])
def test_uniform_pressure_is_exact(cells, order, degree, theta):
    """requirement: pressure and approach, by Nitsche's method and by penalty (theta 1), 1e-10."""
    method = "nitsche" if theta == -1 else "penalty"
    contact = {"method": method}
    contact |= {"theta": theta} if method == "nitsche" else {"penalty": "1e15 Pa/m"}
    tables = {
        "model": "3d",
        "geometry": PatchInSpace(columns=(2, 3), orders=(order, order), tetrahedra=CELLS[cells]),
        "mesh": {"degree": degree},
        "bodies": {
            name: {"young_modulus": E, "poisson_ratio": 0.0}
            for name, E in zip(PatchInSpace.bodies, (f"{E} Pa" for E in MODULI), strict=True)
        },
        "load": {"mean_pressure": f"{PRESSURE} Pa"},
        "contact": contact,
        "analysis": {"type": "initial"},
    }
    result = tw.run(tw.load(tables))
    assert result.interface.pressure == pytest.approx(PRESSURE, rel=1e-10)
    expected = PRESSURE * sum(h / E for h, E in zip(HEIGHTS, MODULI, strict=True))
    expected += PRESSURE / 1e15 if method == "penalty" else 0.0
    assert result.summary["approach_m"] == pytest.approx(expected, rel=1e-10)


def ball(meshes):
    """Blocks, the face of the upper one bent to a ball of the radius 1 m."""
    tagged = meshes.tagged
    x, y, z = tagged.points.T
    upper = np.arange(len(z)) < len(UPPER) ** 2 * len(UP)
    bulge = np.where(upper, (x**2 + y**2) / 2 * (1 - z / UP[-1]), 0.0)
    return replace(meshes, tagged=replace(tagged, points=np.column_stack([x, y, z + bulge])))


def unworn(shape, method):
    """Unworn bodies in contact without friction, by a method."""
    blocks = Blocks((UPPER, UP), (LOWER, -UP[::-1])).extruded(UPPER, axis=1)
    down = (0.0, 0.0, -1.0)
    return run(
        Model(
            kinematics="3d",
            bodies=tuple(
                Body(name, {name: Material(2e11, 0.3, label=name)}, fixed=(f"{name}_end",))
                for name in ("upper", "lower")
            ),
            interfaces=(Interface(("upper_face", "lower_face"), method=ContactMethod(method)),),
            holders=(Holder(down, (0.0,) * 3, (0.0,) * 3, force=FORCES[shape]),),
            meshes=ball(blocks) if shape == "ball" else blocks,
            discretisation=Discretisation(degree=2),
        ),
        StaticAnalysis("initial"),
    )


@pytest.mark.parametrize("shape", list(FORCES))
def test_three_methods_agree_at_points(shape):
    """requirement: largest pressures within 5 % of condensed contact, also at the sharp edge of a
    pad; pressures at all points within 4 % of that, on a ball with six elements across the contact
    15 %, where its edge crosses elements; forces to 1e-9.
    """
    known, *others = (unworn(shape, method) for method in ("condensed", "penalty", "nitsche"))
    largest = known.interface.pressure.max()
    assert known.summary["max_pressure_Pa"] == largest
    for found in others:
        assert found.summary["normal_force_N"] == pytest.approx(FORCES[shape], rel=1e-9, abs=0.0)
        assert found.summary["max_pressure_Pa"] == pytest.approx(largest, rel=0.05, abs=0.0)
        assert found.interface.pressure == pytest.approx(
            known.interface.pressure, rel=0.0, abs=POINTS[shape] * largest
        )

"""Friction across the sliding direction in space: sections extruded and turned, a cone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermowear.contact.operators.rigid_motion import sliding
from thermowear.laws import PowerWear
from thermowear.laws.interfaces import Constant
from thermowear.model import (
    Body,
    Discretisation,
    FaceWear,
    Holder,
    Interface,
    Material,
    Model,
    Motion,
)
from thermowear.model.analyses import StaticAnalysis
from thermowear.reference.annular_punch import conical_pressure
from thermowear.simulation.analyses.run import run

from .extruded import Blocks

FORCE, ACROSS, SLOPE = 3000.0, 0.2, 0.5
INNER, OUTER = 0.02, 0.05
STEEL, BRASS = Material(2e11, 0.3, label="upper"), Material(1e11, 0.35, label="lower")


def slanted(p):
    """The face rises along the section."""
    along, up = np.moveaxis(p, -1, 0)
    return np.stack([along, up + SLOPE * (along - INNER)], axis=-1)


INITIAL = StaticAnalysis("initial")
UP = np.array([0.0, 0.006, 0.02])
BLOCKS = Blocks(
    upper=(np.linspace(INNER, OUTER, 5), UP),
    lower=(np.linspace(INNER - 0.015, OUTER + 0.015, 9), -UP[::-1]),
    place=slanted,
)


def grooved(p):
    """The face rises on both sides of its middle."""
    along, up = np.moveaxis(p, -1, 0)
    return np.stack([along, up + SLOPE * np.abs(along - (INNER + OUTER) / 2)], axis=-1)


def close(value, tolerance=1e-9):
    return pytest.approx(value, rel=tolerance, abs=0.0)


def model(meshes, kinematics, transverse=ACROSS, friction=0.0, share=1.0, sides=(), **motion):
    """Slanted block on another one, held from above; `sides`: planes of symmetry."""
    down = (0.0, 0.0, -1.0) if kinematics == "3d" else (0.0, -1.0)
    bodies = (
        Body("upper", {"upper": STEEL}, fixed=("upper_end",)),
        Body("lower", {"lower": BRASS}, fixed=("lower_end",)),
    )
    symmetry = tuple(f"{name}_{side}" for name in ("upper", "lower") for side in sides)
    return Model(
        kinematics=kinematics,
        bodies=bodies,
        interfaces=(
            Interface(
                faces=("upper_face", "lower_face"),
                motion=Motion(**motion),
                friction=Constant(friction),
                transverse_friction=transverse,
                wear={0: FaceWear(PowerWear(1e-13, 1.0, 1.0))},
            ),
        ),
        holders=(
            Holder(
                load_direction=down,
                pivot=(0.0,) * len(down),
                point=(0.0,) * len(down),
                force=share * FORCE,
            ),
        ),
        meshes=meshes,
        discretisation=Discretisation(degree=2),
        symmetry=symmetry,
        thickness=0.01 if kinematics == "plane-strain" else None,
    )


def quarter(kind, **changes):
    """Quarter of the ring in space, with its axis along z."""
    meshes = BLOCKS.turned(np.linspace(0.0, np.pi / 2, 4))
    turning = {"angular_velocity": 2.0, "center": (0.0, 0.0)}
    whole = model(meshes, "3d", share=0.25, sides=("high",), **changes, **turning)
    upper, lower = (replace(body, rollers=(f"{body.name}_low",)) for body in whole.bodies)
    return run(replace(whole, bodies=(upper, lower)), StaticAnalysis(kind))


@pytest.mark.parametrize("transverse", [0.0, ACROSS])
def test_a_section_that_slides_out_of_its_plane(transverse):
    """requirement: the extruded section that slides along x has its pressures and the force of its
    guide, F (tan φ - mu_d) / (1 + mu_d tan φ), to 1e-9.
    """
    flat = model(BLOCKS.section(), "plane-strain", transverse, velocity=0.1, across=True)
    meshes = BLOCKS.extruded(np.array([0.0, 0.005, 0.01]), axis=0)
    solid = model(meshes, "3d", transverse, sides=("low", "high"), velocity=0.1)
    known, found = (run(m, StaticAnalysis("initial")) for m in (flat, solid))
    same = np.abs(found.interface.y[:, None] - known.interface.x).argmin(axis=1)
    pressure = known.interface.pressure
    np.testing.assert_allclose(
        found.interface.pressure, pressure[same], rtol=0, atol=1e-9 * pressure.max()
    )
    assert found.summary["approach_m"] == close(known.summary["approach_m"])
    guided = FORCE * (SLOPE - transverse) / (1 + transverse * SLOPE)
    assert found.summary["guide_force_y_N"] == close(guided)
    assert known.summary["guide_force_N"] == close(guided)


def test_a_cone_in_its_seat():
    """requirement: the closed form of the steady state, and the contact of unworn faces of the
    axisymmetric model; both change by a tenth with transverse friction.
    """
    known, base = (
        run(model(BLOCKS.section(), "axisymmetric", mu, angular_velocity=2.0), INITIAL)
        for mu in (ACROSS, 0.0)
    )
    found, steady = (quarter(kind) for kind in ("initial", "steady"))
    approach = found.summary["approach_m"]
    assert approach == pytest.approx(known.summary["approach_m"], rel=2e-3, abs=0.0)
    assert approach < 0.97 * base.summary["approach_m"]
    r = np.hypot(steady.interface.x, steady.interface.y)
    angle = np.pi / 2 - np.arctan(SLOPE)
    exact = conical_pressure(r, FORCE, INNER, OUTER, angle, ACROSS, 1.0, 1.0)
    np.testing.assert_allclose(steady.interface.pressure, exact, rtol=2e-3)


def test_in_a_sector_and_in_the_whole_ring():
    """requirement: the shear along the sliding twists the ring only, the one across it stays; up to
    the normals of curved facets.
    """
    meshes = BLOCKS.turned(np.linspace(0.0, 2 * np.pi, 13))
    turning = {"angular_velocity": 2.0, "center": (0.0, 0.0)}
    whole = run(model(meshes, "3d", friction=0.3, **turning), INITIAL)
    part = quarter("initial", friction=0.3)
    assert whole.summary["approach_m"] == close(part.summary["approach_m"], 2e-4)
    assert whole.interface.pressure.max() == close(part.interface.pressure.max(), 2e-3)


def test_along_a_groove():
    """requirement: both sides of a groove resist the load, whichever way the punch slides in it;
    friction along the groove is a force on the guide along x.
    """
    both = replace(BLOCKS, place=grooved)
    meshes = both.extruded(np.array([0.0, 0.005, 0.01]), axis=0)
    results = [
        run(model(meshes, "3d", friction=0.3, velocity=v), StaticAnalysis("steady"))
        for v in (0.1, -0.1)
    ]
    for result, sense in zip(results, (1.0, -1.0), strict=True):
        normal = FORCE * np.hypot(1.0, SLOPE) / (1 + ACROSS * SLOPE)
        i = result.interface
        assert i.weight @ i.pressure == close(normal)
        assert result.summary["guide_force_N"] == close(sense * 0.3 * normal)


def test_faces_at_rest_have_no_direction():
    """requirement: where nothing slides there is no friction across the sliding either."""
    normals = np.tile([0.6, 0.0, -0.8], (2, 1))
    velocity = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
    across = sliding(velocity, normals, (0.0, 0.0, -1.0)).across
    np.testing.assert_allclose(across, [[-0.8, 0.0, -0.6], [0.0, 0.0, 0.0]], atol=1e-15)

"""Thermoelastic stability in space: the modes of the section that is extruded."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from thermowear.laws import PowerWear
from thermowear.laws.interfaces import Constant
from thermowear.model import (
    Body,
    Discretisation,
    FaceWear,
    Heat,
    Holder,
    Interface,
    Material,
    Model,
    Motion,
)
from thermowear.model.analyses import StaticAnalysis
from thermowear.simulation.analyses.run import run

from .extruded import Blocks

WIDTH, BREADTH, SPEED = 20e-3, 4e-3, 0.5
STEEL = Material(
    2.1e11, 0.3, expansion=1.2e-5, conductivity=50.0, density=7800.0, specific_heat=460.0
)
BRASS = Material(
    1e11, 0.35, expansion=1.9e-5, conductivity=110.0, density=8400.0, specific_heat=380.0
)
UP = np.array([0.0, 2e-3, 6e-3, 15e-3])
BLOCKS = Blocks(
    upper=(np.linspace(0.0, WIDTH, 7), UP),
    lower=(np.linspace(-10e-3, WIDTH + 10e-3, 9), -UP[::-1]),
)
"""Meshes of both faces do not match."""
_KEYS = ("critical", "growth")


def model(meshes, kinematics, rollers, friction):
    down = (0.0, 0.0, -1.0) if kinematics == "3d" else (0.0, -1.0)
    middle = (WIDTH / 2, 0.0, 0.0)[: len(down)]
    guided = {n: tuple(f"{n}_{end}" for end in rollers) for n in ("upper", "lower")}
    materials = {"upper": STEEL, "lower": BRASS}
    return Model(
        kinematics=kinematics,
        bodies=tuple(
            Body(n, {n: materials[n]}, fixed=(f"{n}_end",), rollers=on) for n, on in guided.items()
        ),
        interfaces=(
            Interface(
                faces=("upper_face", "lower_face"),
                motion=Motion(velocity=SPEED),
                friction=Constant(friction),
                conductance=Constant(1e4),
                wear={0: FaceWear(PowerWear(1e-14, 1.0, 1.0))},
            ),
        ),
        holders=(Holder(load_direction=down, pivot=middle, point=middle, force=2000.0),),
        meshes=meshes,
        discretisation=Discretisation(degree=2),
        heat=Heat(temperature={"upper_end": 293.15, "lower_end": 293.15}),
        thickness=None if kinematics == "3d" else BREADTH,
    )


@cache
def twins(friction=0.3, advection="none"):
    """Results of the section, and of the block extruded from it between rollers."""
    solid = BLOCKS.extruded(np.array([0.0, BREADTH]), axis=1)
    return [
        computed(meshes, kinematics, rollers, friction, advection)
        for meshes, kinematics, rollers in (
            (BLOCKS.section(), "plane-strain", ()),
            (solid, "3d", ("low", "high")),
        )
    ]


def computed(meshes, kinematics, rollers, friction, advection="none"):
    chosen = model(meshes, kinematics, rollers, friction)
    hot = replace(chosen.heat, advection=advection)
    return run(replace(chosen, heat=hot), StaticAnalysis("stability"))


@pytest.mark.parametrize("advection", ["none", pytest.param("resolved", marks=pytest.mark.slow)])
def test_critical_speeds_are_those_of_the_section(advection):
    """requirement: critical speeds, growth rates and frequencies, with and without wear and with
    the heat that the moving body carries, to 1e-6; the shape of the growing mode.
    """
    flat, solid = (result.summary for result in twins(advection=advection))
    compared = [key for key, value in flat.items() if key.startswith(_KEYS) and value]
    assert {"critical_speed_factor_with_wear", "growth_rate_per_s"} <= set(compared)
    for key in compared:
        assert solid[key] == pytest.approx(flat[key], rel=1e-6), key
    known, found = (result.modes for result in twins(advection=advection))
    one, other = known.mode == 1, found.mode == 1
    same = np.abs(found.x[other][:, None] - known.x[one]).argmin(axis=1)
    there = known.pressure[one][same]
    sign = np.sign(there @ found.pressure[other])
    np.testing.assert_allclose(sign * found.pressure[other], there, atol=1e-4)


def test_static_speeds_of_the_section():
    """requirement: all static modes of a block narrower than their waves, to 1e-9."""
    flat, solid = (result.summary["static_speed_factors"] for result in twins())
    assert len(flat) >= 4
    np.testing.assert_allclose(solid[: len(flat)], flat, rtol=1e-9)


@pytest.mark.slow
def test_hot_spots_across_the_sliding():
    """requirement: waves across the sliding, which the section lacks, come first on a wide block;
    the first mode of the section is among its modes, to 1e-9.
    """
    wide = BLOCKS.extruded(np.linspace(0.0, 3 * WIDTH, 5), axis=1)
    found = computed(wide, "3d", ("low", "high"), 0.3).summary["static_speed_factors"]
    flat = twins()[0].summary["static_speed_factors"]
    assert found[0] < 0.5 * flat[0]
    assert np.abs(np.array(found) / flat[0] - 1).min() < 1e-9

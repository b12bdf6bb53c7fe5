"""Ring that conducts heat, on an insulating one: one of them turns, both in space and as a section.

The conductor has Poisson's ratio 0. Rings are narrow, as the heated one cones: a wide one would
lift off along a rim.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np

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
from thermowear.model.analyses import StabilityAnalysis, TransientAnalysis
from thermowear.simulation.analyses.run import run
from thermowear.verification.cases.heat.growth import rates

from .extruded import Blocks

WAVES, PER_WAVE = 3, 12
RADIUS, WIDTH, DEPTH, AMBIENT = 0.05, 0.0005, 0.02, 293.15
PRESSURE, FRICTION, SPEED = 5e6, 0.3, 0.5
"""Mean pressure [Pa], friction coefficient, and a speed that others are relative to [rad/s]."""
UNEVENNESS, INTERVAL, END, SETTLED = 1e-9, 0.25, 4.0, 4
CONDUCTOR = Material(
    2e11, 0.0, expansion=1.2e-5, conductivity=50.0, density=1000.0, specific_heat=400.0
)
INSULATOR = replace(CONDUCTOR, expansion=1e-12, conductivity=1e5)
ALONG = np.array([RADIUS - WIDTH / 2, RADIUS + WIDTH / 2])
_LENGTH = 2 * np.pi * RADIUS / WAVES / PER_WAVE
_SIZES = np.cumsum([0.0, *0.5 * _LENGTH * 1.7 ** np.arange(3)])
UP = DEPTH * _SIZES / _SIZES[-1]
BLOCKS = Blocks((ALONG, UP), (ALONG, -UP[::-1]))


@dataclass(frozen=True)
class HotSpotRing:
    """Ring on a ring.

    Attributes
    ----------
    factor : float
        Angular velocity of the lower ring relative to `SPEED`.
    turns : bool
        True if the conductor turns, carrying its heat along; else the insulator.
    wear : float
        Of the upper ring, held [1/Pa].
    """

    factor: float
    turns: bool = False
    wear: float = 0.0

    @property
    def speed(self) -> float:
        """Angular velocity [rad/s]."""
        return self.factor * SPEED

    @cached_property
    def result(self):
        """Transient run in space, from a face with a few waves."""
        times = tuple(k * INTERVAL for k in range(1, round(END / INTERVAL)))
        return run(self._in_space(), TransientAnalysis(end_time=END, output_times=times))

    @property
    def waves(self) -> np.ndarray:
        """Amplitudes of the pressure's waves, complex, ``p = Re(a exp(i N θ))``."""
        states = [self.result.outputs[time] for time in sorted(self.result.outputs)]
        return np.array([_amplitude(state) for state in [*states, self.result.interface]])

    @property
    def rate(self) -> complex:
        """Rate of the wave that grows fastest, with the sense of the frequency of turning [1/s].

        Apart from the part that stays with the uneven face.
        """
        two = rates(self.waves[SETTLED:], INTERVAL)
        return complex(two[np.abs(two).argmax()] if self.wear == 0.0 else two[two.real.argmax()])

    def growth(self):
        """Rows of growth rates of the same waves on the section, at several speeds."""
        return _growth(self)

    def section(self) -> Model:
        """Axisymmetric model of both rings."""
        motion = Motion(angular_velocity=self.speed)
        flat = self._model("axisymmetric", BLOCKS.section(), motion, 2)
        return replace(flat, discretisation=Discretisation(degree=4))

    def _in_space(self) -> Model:
        meshes = BLOCKS.turned(np.linspace(0.0, 2 * np.pi, WAVES * PER_WAVE + 1))
        points = meshes.tagged.points.copy()
        upper = slice(len(points) // 2)
        x, y, z = points[upper].T
        points[upper, 2] -= UNEVENNESS * np.cos(WAVES * np.arctan2(y, x)) * (1 - z / DEPTH)
        uneven = replace(meshes, tagged=replace(meshes.tagged, points=points))
        motion = Motion(angular_velocity=self.speed, center=(0.0, 0.0), passes=True)
        solid = self._model("3d", uneven, motion, 3)
        advection = "resolved" if self.turns else "none"
        return replace(solid, heat=replace(solid.heat, transient=True, advection=advection))

    def _model(self, kinematics, meshes, motion, dim) -> Model:
        names = "upper", "lower"
        of = dict(zip(names, (INSULATOR, CONDUCTOR)[:: 1 if self.turns else -1], strict=True))
        origin = (0.0,) * dim
        return Model(
            kinematics=kinematics,
            bodies=tuple(Body(n, {n: of[n]}, fixed=(f"{n}_end",)) for n in names),
            interfaces=(
                Interface(
                    faces=("upper_face", "lower_face"),
                    motion=motion,
                    friction=Constant(FRICTION),
                    conductance=Constant(1e-4),
                    partition=0.0 if self.turns else 1.0,
                    wear={0: FaceWear(PowerWear(self.wear, 1.0, 1.0))} if self.wear else {},
                ),
            ),
            holders=(
                Holder(
                    load_direction=(*origin[1:], -1.0),
                    pivot=origin,
                    point=origin,
                    force=PRESSURE * 2 * np.pi * RADIUS * WIDTH,
                ),
            ),
            meshes=meshes,
            discretisation=Discretisation(degree=2),
            heat=Heat(temperature={f"{n}_end": AMBIENT for n in names}),
        )


@cache
def _growth(ring: HotSpotRing):
    found = run(ring.section(), StabilityAnalysis(hot_spots=(WAVES,)))
    return found.hot_spots.growth


def _amplitude(face) -> complex:
    wave = np.exp(-1j * WAVES * np.arctan2(face.y, face.x))
    return complex(2 * (face.weight * face.pressure) @ wave / face.weight.sum())

"""Growth of hot spots in time and in space: a transient run from a slightly uneven face.

Half a wavelength of a conductor that slides on an elastic insulator, across the waves, between
planes of symmetry. Pressure and temperature vary as ``cos(m y)``, slightly, as the face does at
first; they then grow or decay as the fastest mode, apart from a part that stays.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache, cached_property
from math import pi

import numpy as np

from ....geometry.mesh.tagged import TaggedMesh
from ....geometry.meshing.cells import level, mesh_lattice, tagged_bodies
from ....geometry.meshing.divisions import growing
from ....laws import PowerWear
from ....laws.interfaces import Constant
from ....model import (
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
from ....model.analyses import TransientAnalysis
from ....reference.instability import ConductorOnInsulator
from ....results import InterfaceFields, Result
from ....simulation.analyses.run import run
from ...check import Check, compare
from .instability import BURTON, COLD, RATIO, STEEL, WAVE, YOUNG_MODULUS

WEAR = 1e-14
"""Wear of the conductor [1/Pa]."""
PRESSURE, AMBIENT = 5e6, 293.15
SETTLED = 4
"""Number of recorded states that are left out: other modes decay meanwhile."""
RUNS = (0.7, 0.0), (1.3, 0.0), (0.7, WEAR), (1.3, WEAR), (1.3, 5 * WEAR)
"""Speeds relative to the critical one, and wear; hot spots of the last one swing."""
_UNEVEN, _LESS = 5e-8, 1e-9
"""Unevenness at speeds at which waves decay, and grow: pressures stay above zero [m]."""
_BODIES, _ENDS = ("upper", "lower"), ("upper_end", "lower_end")
_INSULATOR = 0.5 * YOUNG_MODULUS, 0.2
"""Young's modulus [Pa] and Poisson's ratio."""
_NUMBER, _DEPTH, _BREADTH = 2 * pi / WAVE, 1.5 * WAVE, WAVE / 12
_TOWARDS_FACE = 0.6
"""Size ratio of successive rows of elements."""
_ALLOWED = 1e-2


def tei_growth() -> Iterator[Check]:
    """Rates below and above the critical speed, with and without wear, and what stays."""
    for part, wear in RUNS:
        half = HalfWave(part, wear)
        at = f"at {part:g} vcr{f', k_w = {1e6 * wear:g}/MPa' if wear else ''}"
        for name in ("pressure", "temperature"):
            found, quantity = half.found(name), f"growth rate of the {name} {at} [1/s]"
            yield compare(quantity, found.real, half.rate.real, _ALLOWED, BURTON, abs(half.rate))
            if half.rate.imag:
                quantity = f"frequency of the {name} {at} [1/s]"
                yield compare(quantity, found.imag, half.rate.imag, _ALLOWED, BURTON)
        if not wear:
            quantity = f"amplitude of the pressure that the unevenness keeps up, {at} [Pa]"
            yield compare(quantity, half.kept_up, half.static, _ALLOWED, BURTON)


@dataclass(frozen=True)
class HalfWave:
    """Half a wavelength of a conductor on an insulator, in space.

    Attributes
    ----------
    part : float
        Speed relative to the critical one without wear.
    wear : float
        Worn length of the conductor per pressure and distance [1/Pa].
    elements : int
        Elements along the half-wave, of degree 2.
    end, interval : float
        Duration, and interval of the states recorded [s].
    """

    part: float
    wear: float = 0.0
    elements: int = 6
    end: float = 8.0
    interval: float = 0.5

    def found(self, name: str = "pressure") -> complex:
        """Rate of the mode that grows fastest, or decays most slowly [1/s].

        Without wear another part stays, and is left out. Of a pair the one with positive imaginary
        part.
        """
        two = rates(self.waves(name)[SETTLED:], self.interval)
        if not self.wear:
            two = two[np.argsort(np.abs(two))[1:]]
        return complex(max(two, key=lambda rate: (round(rate.real, 9), rate.imag)))

    @property
    def kept_up(self) -> float:
        """Amplitude of the pressure that neither grows nor decays, from the states [Pa]."""
        times = self.interval * np.arange(SETTLED, len(self.waves()))
        shapes = np.stack([np.ones_like(times), np.exp(self.found().real * times)], axis=1)
        return float(np.linalg.lstsq(shapes, self.waves()[SETTLED:])[0][0])

    @property
    def static(self) -> float:
        """Static amplitude of the pressure, ``E* m h/2/(1 - v/vcr)`` without wear [Pa].

        The amplitude h of the unevenness is that of its linear interpolation in the elements.
        """
        h = self.unevenness * np.sinc(0.5 / self.elements) ** 2
        return float(self.exact.modulus * _NUMBER * h / 2 / (1 - self.part))

    @property
    def unevenness(self) -> float:
        """Amplitude of the face of the conductor at first [m]."""
        return _LESS if self.rate.real > 0 else _UNEVEN

    @property
    def speed(self) -> float:
        """Sliding speed [m/s]."""
        return self.part * self.exact.critical_speed

    @property
    def rate(self) -> complex:
        """Eigenvalue [1/s]."""
        return self.exact.growth_rate(self.speed)

    @property
    def exact(self) -> ConductorOnInsulator:
        """Closed form of half-planes."""
        modulus, ratio = _INSULATOR
        softness = (1 - RATIO**2) / YOUNG_MODULUS + (1 - ratio**2) / modulus
        return ConductorOnInsulator(WAVE, 1 / softness, RATIO, wear=self.wear, **STEEL)

    def waves(self, name: str = "pressure") -> np.ndarray:
        """Amplitudes of ``cos(m y)`` at the states recorded, of the pressure or temperature."""
        states = [self.result.outputs[time] for time in sorted(self.result.outputs)]
        column = "temperature_1" if name == "temperature" else name
        return np.array([amplitude(state, column) for state in [*states, self.result.interface]])

    @cached_property
    def result(self) -> Result:
        """Result of a transient run."""
        return _run(self)

    @property
    def model(self) -> Model:
        """Conductor held above the insulator, which slides along x."""
        steel = _material(YOUNG_MODULUS, RATIO, STEEL["conductivity"], STEEL["expansion"])
        insulator = _material(*_INSULATOR, COLD, 1e-12)
        origin = (0.0, 0.0, 0.0)
        return Model(
            kinematics="3d",
            bodies=tuple(
                Body(
                    name,
                    {name: material},
                    fixed=(f"{name}_end",),
                    rollers=(f"{name}_crest", f"{name}_trough"),
                )
                for name, material in (("upper", steel), ("lower", insulator))
            ),
            interfaces=(
                Interface(
                    faces=("upper_face", "lower_face"),
                    motion=Motion(velocity=self.speed),
                    friction=Constant(STEEL["friction"]),
                    conductance=Constant(1e-4),
                    partition=1.0,
                    wear={0: FaceWear(PowerWear(self.wear, 1.0, 1.0))} if self.wear else {},
                ),
            ),
            holders=(
                Holder(
                    load_direction=(0.0, 0.0, -1.0),
                    pivot=origin,
                    point=origin,
                    force=PRESSURE * _BREADTH * WAVE / 2,
                ),
            ),
            meshes=_Meshed(self._mesh()),
            discretisation=Discretisation(degree=2),
            heat=Heat(AMBIENT, transient=True, temperature=dict.fromkeys(_ENDS, AMBIENT)),
            symmetry=tuple(f"{name}_{side}" for name in _BODIES for side in ("front", "back")),
        )

    def _mesh(self) -> TaggedMesh:
        """Hexahedra in rows that are thinner towards the face, that of the conductor uneven."""
        along, across = np.linspace(0.0, WAVE / 2, self.elements + 1), np.array([0.0, _BREADTH])
        up = growing(0.0, _DEPTH, 0.5 * along[1], _TOWARDS_FACE, _DEPTH / 4)
        bodies = {
            name: mesh_lattice((across, along, rows), 1)
            for name, rows in (("upper", up), ("lower", -up[::-1]))
        }
        sides = {"front": (0, 0.0), "back": (0, _BREADTH)}
        sides |= {"crest": (1, 0.0), "trough": (1, WAVE / 2), "face": (2, 0.0)}
        surfaces = {f"{name}_{side}": level(*at) for name in _BODIES for side, at in sides.items()}
        surfaces |= {end: level(2, z) for end, z in zip(_ENDS, (_DEPTH, -_DEPTH), strict=True)}
        flat = tagged_bodies(bodies, surfaces)
        points, own = flat.points.copy(), slice(len(bodies["upper"].points))
        _, y, z = points[own].T
        points[own, 2] -= self.unevenness * np.cos(_NUMBER * y) * (1 - z / _DEPTH)
        return replace(flat, points=points)


@dataclass(frozen=True)
class _Meshed:
    """Source of a mesh that is there already, see `model.model.MeshSource`."""

    tagged: TaggedMesh
    path: None = None

    def mesh(self, zone: tuple[float, float] | None) -> TaggedMesh:
        return self.tagged

    def expected_zone(self, force: float | None, approach: float | None, modulus: float) -> None:
        return None


@cache
def _run(half: HalfWave) -> Result:
    times = tuple(k * half.interval for k in range(1, round(half.end / half.interval)))
    result = run(half.model, TransientAnalysis(end_time=half.end, output_times=times))
    if result.stopped is not None:
        raise result.stopped
    return result


def _material(modulus: float, ratio: float, conductivity: float, expansion: float) -> Material:
    return Material(
        modulus,
        ratio,
        expansion=expansion,
        conductivity=conductivity,
        density=1000.0,
        specific_heat=STEEL["capacity"] / 1000.0,
    )


def amplitude(face: InterfaceFields, name: str) -> float:
    """Amplitude of ``cos(m y)`` on a face."""
    shape, values = np.cos(_NUMBER * face.y), getattr(face, name)
    return float((face.weight * shape) @ values / (face.weight @ shape**2))


def rates(values: np.ndarray, interval: float) -> np.ndarray:
    """Rates of two exponentials in time through equally spaced values, complex (Prony's method).

    Parameters
    ----------
    values : ndarray
        Real or complex amplitudes.
    interval : float
        [s]
    """
    before = np.stack([values[:-2], values[1:-1]], axis=1)
    predicted = np.linalg.lstsq(before, values[2:])[0]
    return np.log(np.roots([1.0, *-predicted[::-1]]).astype(complex)) / interval

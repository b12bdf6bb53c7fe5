"""Coatings that are worn through: on a flat face, and on a ball or the flat under it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from ....reference.coatings import CoatedBall, flat_face_depth
from ....results import Result
from ...check import Check, compare, compare_worst, run_starter

FLAT = "closed form: a layer lasts h/(k p v)"
BALANCE = "linear laws: V_c/k_c + V_s/k_s = F s"
CRATER = "ball crater of rigid bodies: V_c = π h (a² - R h), V_s = π b⁴/4R"
THICKNESS, COEFFICIENTS = (5e-6, 2e-6), (2e-15, 4e-15, 8e-14)
"""Layers of the flat face [m], and wear coefficients with that of the substrate [1/Pa]."""
PRESSURE, SPEED = 5e6, 0.1
"""Pressure [Pa] and sliding speed [m/s] of the flat face."""
AREA = 1e-4
"""Area of the flat face [m²]."""
RATES = tuple(k * PRESSURE * SPEED for k in COEFFICIENTS)
LIFE = sum(h / rate for h, rate in zip(THICKNESS, RATES, strict=False))
"""Time at which the last layer is worn through [s]."""
TIMES = (2500.0, 5000.0, 5400.0, LIFE, 7000.0)
"""In the first layer, at its end, in the second one, at its end, and in the substrate [s]."""


def flat_face(*overrides: str) -> Result:
    """Run two blocks under a uniform pressure, one of them with two layers."""
    thick = ", ".join(f"'{h} m'" for h in THICKNESS)
    *each, last = (f"'{k} 1/Pa'" for k in COEFFICIENTS)
    layers = f"{{thickness=[{thick}], coefficient=[{', '.join(each)}]}}"
    outputs = ", ".join(f"'{t!r} s'" for t in TIMES[:-1])
    return run_starter(
        "stacked-blocks",
        "mesh.degree=2",
        f"wear.upper={{coefficient={last}, per='pressure', layers={layers}}}",
        f"analysis={{type='transient', end_time='{TIMES[-1]} s', output_times=[{outputs}]}}",
        *overrides,
        without=("heat",),
    )


def compared_flat(result: Result, note: str) -> Iterator[Check]:
    """Depths at all times, the time of wear-through, and the volumes of the layers."""
    states = result.outputs | {TIMES[-1]: result.interface}
    for time, state in states.items():
        exact = flat_face_depth(time, THICKNESS, RATES)
        quantity = f"depth at the point of largest deviation after {time:.5g} s{note} [m]"
        yield compare_worst(quantity, state.wear_1, exact, 1e-9, FLAT)
        volume = float(state.weight @ state.wear_1)
        yield compare(f"volume after {time:.5g} s{note} [m³]", volume, AREA * exact, 1e-9, FLAT)
    found = result.summary["worn_through_time_1_s"]
    yield compare(f"time of wear-through{note} [s]", found, LIFE, 1e-9, FLAT)
    found = result.summary["worn_through_distance_1_m"]
    yield compare(f"sliding distance of wear-through{note} [m]", found, SPEED * LIFE, 1e-9, FLAT)
    substrate = flat_face_depth(TIMES[-1], THICKNESS, RATES) - sum(THICKNESS)
    exact_volumes = (AREA * depth for depth in (*THICKNESS, substrate))
    worn = zip(result.summary["layer_volumes_1_m3"], exact_volumes, strict=True)
    for layer, (volume, known) in enumerate(worn):
        yield compare(f"volume of layer {layer}{note} [m³]", volume, known, 1e-9, FLAT)
    rate = result.interface.wear_rate_1
    yield compare_worst(f"rate of the substrate{note} [m/s]", rate, RATES[-1], 1e-9, FLAT)


@dataclass(frozen=True)
class CoatedRun:
    """Run of a ball on a flat, one of them coated.

    Attributes
    ----------
    body : str
        Coated body.
    ball : CoatedBall
        Closed form.
    multiples : tuple of float
        Sliding distances over that at which the coating is worn through.
    """

    body: str
    ball: CoatedBall
    multiples: tuple[float, ...] = (0.5, 2.0, 6.0)

    speed = 0.05

    @property
    def distances(self) -> list[float]:
        """Sliding distances [m]."""
        return [multiple * self.ball.begin for multiple in self.multiples]

    def run(self, *overrides: str) -> Result:
        """Run the starter case with this coating."""
        ball = self.ball
        times = [distance / self.speed for distance in self.distances]
        outputs = ", ".join(f"'{t!r} s'" for t in times[:-1])
        layers = f"{{thickness=['{ball.thickness} m'], coefficient=['{ball.coating} 1/Pa']}}"
        law = f"coefficient='{ball.substrate} 1/Pa', per='pressure', layers={layers}"
        return run_starter(
            "sphere-on-block-coated",
            f"wear={{{self.body}={{{law}}}}}",
            f"analysis={{type='transient', end_time='{times[-1]!r} s', output_times=[{outputs}], "
            "tolerance=1e-3}",
            *overrides,
        )

    def compared(self, result: Result, note: str, allowed: float = 1e-2) -> Iterator[Check]:
        """Balance of the volumes at all distances, and their closed forms at the last one.

        The worn face of a coated flat is inclined by up to a/R: pressures along its normals have a
        resultant that is smaller by half of the square.
        """
        ball, times = self.ball, [*result.outputs, result.history[-1].time]
        states = zip(times, [*result.outputs.values(), result.interface], strict=True)
        for time, state in states:
            first = self.body == "sphere"
            depth = state.wear_1 if first else state.wear_2
            left = state.coating_left_1 if first else state.coating_left_2
            coating = ball.thickness - left
            dose = coating / ball.coating + (depth - coating) / ball.substrate
            lost = float(state.weight @ dose)
            distance = self.speed * time
            done = ball.force * distance
            quantity = f"V_c/k_c + V_s/k_s after {distance:.4g} m{note} [N m]"
            inclined = (
                0.0 if self.body == "sphere" else (ball.worn_radius(distance) / ball.radius) ** 2
            )
            yield compare(quantity, lost, done, 1e-9 + inclined, BALANCE)
        number = 1 if self.body == "sphere" else 2
        exact = ball.volumes(self.distances[-1])
        names = zip(("coating", "substrate"), exact, strict=True)
        volumes = result.summary[f"layer_volumes_{number}_m3"]
        for volume, (name, known) in zip(volumes, names, strict=True):
            yield compare(f"volume of the {name}{note} [m³]", volume, known, allowed, CRATER)


HARD = CoatedRun("sphere", CoatedBall(50e-3, 2e-6, 1.33e-14, 1.33e-13, 10.385))
"""Coating that wears a tenth as fast as the ball below it."""
SOFT = CoatedRun("block", CoatedBall(50e-3, 2e-6, 1.33e-13, 3.99e-14, 10.385), (0.5, 2.0, 10.0))
"""Coating of the flat that wears three times as fast as the flat below it."""


def coating() -> Iterator[Check]:
    """Layers of a flat face, on fixed and on moved meshes; a coated ball, and a coated flat."""
    yield from compared_flat(flat_face("wear.update=never"), "")
    yield from compared_flat(flat_face("wear.update=0.0005"), ", moved meshes")
    yield from HARD.compared(HARD.run(), ", coated ball")
    yield from SOFT.compared(SOFT.run(), ", coated flat")
    fine = replace(HARD, multiples=(2.0, 4.0))
    run = fine.run("mesh.elements=120")
    yield from fine.compared(run, ", coated ball, 120 elements")

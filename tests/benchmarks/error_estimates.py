"""Estimated against true discretisation errors, on coarse and fine meshes.

    scripts/env python3 tests/benchmarks/error_estimates.py [WORD…]

True errors are those against closed forms, or against the program's own converged values where
there is none, in the norms of `thermowear.simulation.accuracy.error_estimate`. Asked for: within a
factor 3 of the estimate in 90 % of the cases, nowhere above 10 times it.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from thermowear.reference.elastic_contact.hertz import contact_modulus, line_contact
from thermowear.results import Result
from thermowear.verification.check import run_starter

NEGLIGIBLE = 1e-4
"""Relative: what references are exact to; estimates and true errors below are not compared."""

LINE = (
    "geometry.radius=6 mm",
    "bodies.cylinder.young_modulus=200 GPa",
    'load={force="120 N"}',
    "contact.positioning=false",
)
SPHERE = ("contact.positioning=false",)
RING = ("mesh.grading=0.5",)


@dataclass(frozen=True)
class Study:
    """A case, and the true relative error of each quantity that is known.

    Attributes
    ----------
    starter : str
    overrides : tuple of str
    errors : callable
        True errors of a result by quantity.
    without : tuple of str
    """

    starter: str
    overrides: tuple[str, ...]
    errors: Callable[[Result], dict[str, float]]
    without: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        return f"{self.starter} {' '.join(self.overrides[-3:])}"

    def rows(self) -> list[tuple[str, float, float]]:
        """Quantity, true error and estimate."""
        result = run_starter(self.starter, *self.overrides, without=self.without)
        return [
            (quantity, true, result.summary[f"{quantity}_error_estimate_relative"])
            for quantity, true in self.errors(result).items()
        ]


def mean_error(result: Result, exact: np.ndarray) -> dict[str, float]:
    """Of the pressure, in the mean."""
    i = result.interface
    return {"pressure": float(i.weight @ np.abs(i.pressure - exact) / (i.weight @ exact))}


def line(poisson_ratio: float = 0.3) -> Callable[[Result], dict[str, float]]:
    """Against Hertz's line contact."""
    modulus = contact_modulus(*2 * ((200e9, poisson_ratio),))
    exact = line_contact(120e3, 6e-3, modulus)
    return lambda result: mean_error(result, exact.pressure(result.interface.x))


@cache
def converged(starter: str, *overrides: str, without: tuple[str, ...] = ()) -> Result:
    return run_starter(starter, *overrides, without=without)


def pressure_of(starter: str, *overrides: str) -> Callable[[Result], dict[str, float]]:
    """Against the pressure of a converged result."""

    def errors(result: Result) -> dict[str, float]:
        known = converged(starter, *overrides).interface
        return mean_error(result, np.interp(result.interface.x, known.x, known.pressure))

    return errors


def worn_shape(
    starter: str, *overrides: str, modes: Callable, without: tuple[str, ...] = ()
) -> Callable[[Result], dict[str, float]]:
    """Against shape and temperatures of a converged result; shapes but for rigid motions."""
    from scipy.interpolate import CubicSpline

    def errors(result: Result) -> dict[str, float]:
        known, found = converged(starter, *overrides, without=without).interface, result.interface

        def exact(values):
            return CubicSpline(known.x, values)(found.x)

        R, roots = modes(found.x), np.sqrt(found.weight)
        change = found.shape - exact(known.shape)
        amounts = np.linalg.lstsq(R * roots[:, None], change * roots, rcond=None)[0]
        left = change - R @ amounts
        rows = {"shape": float(np.abs(left).max() / np.ptp(found.shape))}
        if np.isfinite(known.temperature_1).all():
            ambient = 293.15
            changes = [
                np.abs(getattr(found, face) - exact(getattr(known, face))).max()
                for face in ("temperature_1", "temperature_2")
            ]
            rows["temperature"] = float(max(changes) / (found.temperature_1.max() - ambient))
        return rows

    return errors


def _level(x: np.ndarray) -> np.ndarray:
    return np.ones((len(x), 1))


def studies() -> list[Study]:
    """All of them."""
    meshes = [(1, 2), (1, 4), (1, 8), (1, 16), (1, 40), (2, 2), (2, 4), (2, 8), (2, 16), (3, 2)]
    meshes += [(3, 4), (3, 8), (4, 2), (4, 4), (4, 8), (6, 2), (6, 4), (8, 2)]
    found = [Study("cylinder-on-block", LINE + _mesh(*mesh), line()) for mesh in meshes]
    for ratio, *mesh in ((0.45, 1, 8), (0.499, 2, 8), (0.499, 2, 20), (0.499999, 4, 8)):
        nearly = f"bodies.cylinder.poisson_ratio={ratio}"
        found.append(Study("cylinder-on-block", (*LINE, nearly, *_mesh(*mesh)), line(ratio)))
    sphere = pressure_of("sphere-on-block", *SPHERE, *_mesh(4, 32))
    for mesh in ((1, 4), (1, 8), (1, 16), (2, 4), (2, 8), (2, 16), (3, 4), (3, 8), (4, 4), (6, 4)):
        found.append(Study("sphere-on-block", SPHERE + _mesh(*mesh), sphere))
    punch = pressure_of("punch-on-block", *_mesh(8, 24))
    for mesh in ((1, 8), (1, 16), (2, 8), (2, 16), (3, 8), (4, 8)):
        found.append(Study("punch-on-block", _mesh(*mesh), punch))
    ring = worn_shape("annular-punch", *RING, *_mesh(8, 16), modes=_level)
    for mesh in ((1, 4), (1, 8), (1, 16), (2, 2), (2, 4), (2, 8), (3, 2), (3, 4), (4, 2), (4, 4)):
        found.append(Study("annular-punch", RING + _mesh(*mesh), ring))
    strip = worn_shape("punch-on-strip", *RING, *_mesh(8, 12), modes=_level)
    for mesh in ((1, 8), (1, 16), (2, 4), (2, 8), (3, 4)):
        found.append(Study("punch-on-strip", RING + _mesh(*mesh), strip))
    growing = pressure_of("cylinder-on-block-growing", *_mesh(2, 160))
    for mesh in ((1, 40), (2, 20), (2, 40)):
        found.append(Study("cylinder-on-block-growing", _mesh(*mesh), growing))
    return found


def _mesh(degree: int, elements: int) -> tuple[str, str]:
    return f"mesh.degree={degree}", f"mesh.elements={elements}"


def main(words: list[str]) -> None:
    ratios = []
    print(f"{'case':100} {'quantity':12} {'true':>9} {'estimate':>9} {'ratio':>6}")
    for study in studies():
        if not all(word in study.name for word in words):
            continue
        for quantity, true, estimate in study.rows():
            compared = max(true, estimate) > NEGLIGIBLE
            if compared:
                ratios.append(true / estimate)
            text = f"{true / estimate:6.2f}" if compared else "      "
            print(f"{study.name:100} {quantity:12} {true:9.2e} {estimate:9.2e} {text}", flush=True)
    ratio = np.array(ratios)
    near = np.count_nonzero((ratio > 1 / 3) & (ratio < 3))
    print(f"{near} of {len(ratio)} within a factor 3 ({near / len(ratio):.0%})")
    print(f"largest true error over its estimate: {ratio.max():.2f}, smallest {ratio.min():.2f}")


if __name__ == "__main__":
    main(sys.argv[1:])

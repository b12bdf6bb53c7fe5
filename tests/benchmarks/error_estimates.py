"""Estimated against true discretisation errors, on coarse and fine meshes.

    scripts/env python3 tests/benchmarks/error_estimates.py [--share] [WORD…]

True errors are those against closed forms, or against the program's own converged values where
there is none, in the norms of `thermowear.simulation.accuracy.error_estimate`. Asked for: at most
three times the estimate in 90 % of the cases, nowhere above 10 times it. With --share each line has
the part of the run that the estimate took, and the slowest runs are listed.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache, partial
from pathlib import Path

import numpy as np

from thermowear.case import starters
from thermowear.reference.elastic_contact.hertz import (
    contact_modulus,
    elliptical_contact,
    line_contact,
)
from thermowear.results import Result
from thermowear.simulation import run
from thermowear.timer import Phases
from thermowear.verification.cases.contact import hertz_in_space
from thermowear.verification.check import run_starter, starter
from thermowear.verification.quarter_meshes import crossed_cylinders, sphere_on_block

NEGLIGIBLE = 1e-4
"""Relative: what references are exact to; estimates and true errors below are not compared."""

_SLOWEST = 10
"""Number of the slowest runs listed."""

SAME = 1e-9
"""Distance of points that are the same on two meshes [m]."""

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
        Name of a starter, or of the case that `compute` computes.
    overrides : tuple of str
    errors : callable
        True errors of a result by quantity.
    without : tuple of str
    compute : callable, optional
        Other way to the result.
    """

    starter: str
    overrides: tuple[str, ...]
    errors: Callable[[Result], dict[str, float]]
    without: tuple[str, ...] = ()
    compute: Callable[[], Result] | None = None
    phases: Phases = field(default_factory=Phases, compare=False)

    @property
    def name(self) -> str:
        return f"{self.starter} {' '.join(self.overrides[-3:])}"

    @property
    def seconds(self) -> float:
        """Time of the run; zero where it is not known."""
        return sum(self.phases.seconds.values())

    @property
    def share(self) -> float:
        """Part of it that the estimate took."""
        spent = self.phases.seconds.get("error estimate", 0.0)
        return spent / self.seconds if self.seconds else np.nan

    def rows(self) -> list[tuple[str, float, float]]:
        """Quantity, true error and estimate."""
        if self.compute is not None:
            result = self.compute()
        else:
            case = starter(self.starter, *self.overrides, without=self.without)
            result = run(case, phases=self.phases)
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
    peak = float(exact.pressure(np.zeros(1))[0])
    return lambda result: (
        mean_error(result, exact.pressure(result.interface.x)) | largest_error(result, peak)
    )


def largest_error(result: Result, exact: float) -> dict[str, float]:
    """Of the largest pressure."""
    found = result.summary["max_pressure_Pa"]
    return {"max_pressure": abs(found - exact) / found}


@cache
def converged(starter: str, *overrides: str, without: tuple[str, ...] = ()) -> Result:
    return run_starter(starter, *overrides, without=without)


def pressure_of(starter: str, *overrides: str) -> Callable[[Result], dict[str, float]]:
    """Against the pressure of a converged result."""

    def errors(result: Result) -> dict[str, float]:
        fine = converged(starter, *overrides)
        known = fine.interface
        rows = mean_error(result, np.interp(result.interface.x, known.x, known.pressure))
        if starter == "punch-on-block":
            return rows  # infinite at the edges
        return rows | largest_error(result, fine.summary["max_pressure_Pa"])

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


ELLIPSES = {
    name: elliptical_contact(hertz_in_space.FORCE, radii, hertz_in_space.MODULUS)
    for name, radii in (("ball", (10e-3, 10e-3)), ("cylinders", (10e-3, 25e-3)))
}
PAIRS = {
    "ball": lambda: sphere_on_block(hertz_in_space.BALL, hertz_in_space.BLOCK),
    "cylinders": lambda: crossed_cylinders(*hertz_in_space.CYLINDERS),
}


def ellipse(exact, result: Result) -> dict[str, float]:
    """Against Hertz's ellipsoid of pressure, in the largest value and in the mean."""
    i, (a, b) = result.interface, exact.half_axes
    pressure = exact.peak * np.sqrt(np.maximum(1 - (i.x / a) ** 2 - (i.y / b) ** 2, 0.0))
    return mean_error(result, pressure) | largest_error(result, exact.peak)


def on_the_same_cells(starter: str, *overrides: str, quantities: tuple[str, ...]):
    """Against values of a higher degree on the same cells, at the points that both have.

    Between them where facets are cut by those of the other body, and have none in common.
    """
    from scipy.interpolate import LinearNDInterpolator
    from scipy.spatial import cKDTree

    def errors(result: Result) -> dict[str, float]:
        fine, coarse = converged(starter, *overrides).interface, result.interface
        places, at = (np.column_stack([i.x, i.y]) for i in (fine, coarse))
        distance, nearest = cKDTree(places).query(at)
        same = np.flatnonzero(distance < SAME)
        if len(same):
            known = partial(np.take, indices=nearest[same])
        else:
            between = LinearNDInterpolator(places, np.eye(1, len(places))[0])
            same = np.flatnonzero(~np.isnan(between(at)))

            def known(values: np.ndarray) -> np.ndarray:
                return LinearNDInterpolator(places, values)(at[same])

        def changes(name: str) -> np.ndarray:
            return getattr(coarse, name)[same] - known(getattr(fine, name))

        rows: dict[str, float] = {}
        if "pressure" in quantities:
            weights = coarse.weight[same]
            rows["pressure"] = float(
                weights @ np.abs(changes("pressure")) / (weights @ coarse.pressure[same])
            )
        if "shape" in quantities:
            change, roots = changes("shape"), np.sqrt(coarse.weight[same])
            modes = np.column_stack([np.ones(len(same)), at[same, :2]])
            amounts = np.linalg.lstsq(modes * roots[:, None], change * roots, rcond=None)[0]
            rows["shape"] = float(np.abs(change - modes @ amounts).max() / np.ptp(coarse.shape))
        if "temperature" in quantities:
            faces = ("temperature_1", "temperature_2")
            largest = max(getattr(coarse, face).max() for face in faces) - 293.15
            worst = max(np.abs(changes(face)).max() for face in faces)
            rows["temperature"] = float(worst / largest)
        return rows

    return errors


def studies() -> list[Study]:
    """All of them."""
    return [*_sections(), *_in_time(), *_solids()]


def _sections() -> list[Study]:
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


def _in_time() -> list[Study]:
    """Wear and temperatures followed in time."""
    found = []
    for end in ("5 s", "200 s"):
        words = (*RING, f'analysis={{type="transient", end_time="{end}", tolerance=1e-4}}')
        worn = worn_shape("annular-punch-running-in", *words, *_mesh(5, 12), modes=_level)
        for mesh in ((1, 4), (1, 8), (2, 2), (2, 4), (3, 3)):
            found.append(Study("annular-punch-running-in", words + _mesh(*mesh), worn))
    stored = ("density=7800 kg/m^3", "specific_heat=460 J/(kg K)")
    for end in ("20 s", "2000 s"):
        words = (
            *(*RING, "heat.transient=true"),
            *(f"bodies.punch.{one}" for one in stored),
            f'analysis={{type="transient", end_time="{end}", tolerance=1e-4}}',
        )
        hot = worn_shape("annular-punch", *words, *_mesh(4, 12), modes=_level)
        for mesh in ((1, 4), (1, 8), (2, 2), (2, 4), (3, 3)):
            found.append(Study("annular-punch", words + _mesh(*mesh), hot))
    return found


def _solids() -> list[Study]:
    """Bodies in space: of the program's geometries, own tetrahedra, and CAD."""
    found = []
    for name, exact in ELLIPSES.items():
        for inside in (1.0, 0.6, 0.4, 0.25):
            sizes = inside, inside / 2
            compute = partial(_pressed, name, sizes)
            label = f"elements of {inside} and {inside / 2} of the contact"
            errors = partial(ellipse, exact)
            found.append(Study(f"hertz-{name}-3d", (label,), errors, compute=compute))
    hot = ("shape", "temperature")
    for name, quantities, meshes in (
        ("disk-sector", ("shape",), ((1, 6), (1, 10), (2, 3), (2, 4), (2, 6))),
        ("disk-brake-3d", hot, ((1, 8), (1, 14), (2, 4), (2, 6))),
        ("rectangular-punch", ("shape",), ((1, 4), (1, 6), (2, 2), (2, 3), (2, 4))),
    ):
        for degree, elements in meshes:
            found.append(_richer(name, (f"mesh.elements={elements}",), degree, quantities))
    time = 'analysis={type="transient", end_time="2000 s", tolerance=1e-3}'
    for degree, elements in ((1, 4), (1, 6), (2, 2), (2, 3)):
        words = time, f"mesh.elements={elements}"
        found.append(_richer("rectangular-punch", words, degree, ("pressure", "shape")))
    return found + _round_faces() + _mesh_files()


def _round_faces() -> list[Study]:
    """Pins, balls and pads before wear and while they wear.

    Degree 1 has straight cells, whose geometric error (0.6 % of the area of a pin) no estimate
    includes: none where that is most of the error.
    """
    initial = 'analysis={type="initial"}'
    time = 'analysis={{type="transient", end_time="{}", tolerance={}}}'
    worn = "pressure", "shape"
    short, year = time.format("200 s", 1e-3), time.format("1e5 s", 1e-2)
    listed: list[tuple[str, tuple[str, ...], tuple[str, ...], tuple[tuple[int, int], ...]]] = [
        ("pin-on-disk", (), ("shape", "temperature"), ((1, 6), (1, 10), (2, 3), (2, 5))),
        ("pin-on-disk-ball", (), ("pressure",), ((1, 6), (2, 3), (2, 5))),
        ("pin-on-disk-running-in", (short,), worn, ((2, 3), (2, 5))),
        ("ball-in-socket", (year,), ("pressure",), ((1, 8), (2, 4))),
        ("disk-sector", (initial,), ("pressure",), ((1, 6), (2, 4))),
        ("rectangular-punch", (initial,), ("pressure",), ((1, 6), (2, 3))),
    ]
    return [
        _richer(name, (*words, f"mesh.elements={elements}"), degree, quantities)
        for name, words, quantities, meshes in listed
        for degree, elements in meshes
    ]


def _mesh_files() -> list[Study]:
    folder = Path(starters.__file__).parent
    hot = ("shape", "temperature")
    own = [
        (name, (f"geometry.path={folder / f'{name}.msh'}",), quantities)
        for name, quantities in (("two-pads-3d", hot), ("own-mesh-3d", ("shape",)))
    ]
    own.append((own[1][0], (*own[1][1], 'analysis={type="initial"}'), ("pressure",)))
    own += [("cad-pad", cad_pad(size), hot) for size in (15, 10)]
    return [
        _richer(name, words, degree, quantities)
        for name, words, quantities in own
        for degree in (1, 2)
    ]


def cad_pad(size: float) -> tuple[str, ...]:
    """Overrides of the starter of that name for elements of a size at the contact [mm]."""
    folder = Path(starters.__file__).parent
    parts = {"lining": "cad-pad.step", "plate": "cad-pad.step", "disk": "cad-disk.step"}
    files = (f"geometry.paths.{part}={folder / file}" for part, file in parts.items())
    return *files, f"mesh.contact_size={size} mm", f"mesh.size={2 * size} mm"


def _richer(name: str, words: tuple[str, ...], degree: int, quantities: tuple[str, ...]) -> Study:
    """Study of a case in space against two degrees more."""
    finer = *words, f"mesh.degree={degree + 2}"
    errors = on_the_same_cells(name, *finer, quantities=quantities)
    return Study(name, (*words, f"mesh.degree={degree}"), errors)


def _pressed(name: str, sizes: tuple[float, float]) -> Result:
    return hertz_in_space.pressed(PAIRS[name](), ELLIPSES[name], sizes)


def _mesh(degree: int, elements: int) -> tuple[str, str]:
    return f"mesh.degree={degree}", f"mesh.elements={elements}"


def main(words: list[str]) -> None:
    share, ratios = "--share" in words, []
    words = [word for word in words if word != "--share"]
    chosen = [study for study in studies() if all(word in study.name for word in words)]
    print(f"{'case':100} {'quantity':12} {'true':>9} {'estimate':>9} {'ratio':>6}")
    for study in chosen:
        for quantity, true, estimate in study.rows():
            compared = estimate is not None and max(true, estimate) > NEGLIGIBLE
            if compared:
                ratios.append(true / estimate)
            text = f"{true / estimate:6.2f}" if compared else "      "
            text += f" {study.share:5.0%}" if share else ""
            known = float("nan") if estimate is None else estimate
            name = study.name[-100:]
            print(f"{name:100} {quantity:12} {true:9.2e} {known:9.2e} {text}", flush=True)
    ratio = np.array(ratios)
    near = np.count_nonzero(ratio < 3)
    print(f"{near} of {len(ratio)} true errors within 3 estimates ({near / len(ratio):.0%})")
    print(f"largest true error over its estimate: {ratio.max():.2f}, smallest {ratio.min():.2f}")
    if share:
        for study in sorted(chosen, key=lambda study: -study.seconds)[:_SLOWEST]:
            print(f"{study.name[-100:]:100} {study.seconds:6.2f} s {study.share:5.0%}")


if __name__ == "__main__":
    main(sys.argv[1:])

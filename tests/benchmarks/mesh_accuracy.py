"""True errors of the meshes that ``mesh.accuracy`` finds, and their unknowns beside the best mesh.

    scripts/env python3 -m tests.benchmarks.mesh_accuracy [WORD…] [--alone]

True errors are those of the largest pressure and of the worn shape, against closed forms or the
program's own converged values. The best mesh is the one with the fewest unknowns of a grid of
meshes (degree, elements, grading) whose errors are below the accuracy, also on all finer meshes of
the same grading. Also printed: processor time of the search. ``--alone`` leaves the best mesh out.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import cache
from itertools import product
from time import process_time

import numpy as np

from thermowear.errors import CaseError, ComputationError
from thermowear.reference.elastic_contact.hertz import contact_modulus, line_contact
from thermowear.results import Result
from thermowear.simulation.from_case import with_accurate_mesh
from thermowear.verification.check import computed, run_starter, starter

from .error_estimates import LINE

ACCURACIES = ("5 %", "1 %", "0.2 %")
DEGREES, ELEMENTS = (1, 2, 3, 4, 5, 6, 8), (2, 4, 6, 8, 12, 18, 28)
GRADINGS = (0.2, 0.3, 0.5, 1.0)
CONVERGED = ("mesh.degree=10", "mesh.elements=32", "mesh.grading=0.2")
WITHOUT = ("mesh",)


@dataclass(frozen=True)
class Study:
    """Case with known answers.

    Attributes
    ----------
    starter : str
    overrides : tuple of str
    peak : float or None
        Largest pressure in closed form [Pa]; None: that of a converged mesh.
    shaped : bool
        True if the worn shape is known, from a converged mesh.
    converged : tuple of str
        Mesh of the reference.
    """

    starter: str
    overrides: tuple[str, ...] = ()
    peak: float | None = None
    shaped: bool = True
    converged: tuple[str, ...] = CONVERGED

    def errors(self, result: Result) -> tuple[float, float]:
        """Relative errors of largest pressure and of the shape."""
        peak = self.peak
        if peak is None:
            peak = float(known(self).summary["max_pressure_Pa"])
        of_peak = abs(result.summary["max_pressure_Pa"] / peak - 1.0)
        return of_peak, shape_error(result, known(self)) if self.shaped else 0.0

    def run(self, *mesh: str) -> Result:
        return run_starter(self.starter, *self.overrides, *mesh, without=WITHOUT)


@cache
def known(study: Study) -> Result:
    return study.run(*study.converged)


def shape_error(result: Result, reference: Result) -> float:
    """Largest error of the shape in the contact, except for a rigid motion, over the range."""
    from scipy.interpolate import PchipInterpolator

    found, exact = result.interface, reference.interface
    inside = (found.pressure > 0) & (found.x >= exact.x.min()) & (found.x <= exact.x.max())
    x, roots = found.x[inside], np.sqrt(found.weight[inside])
    at, first = np.unique(exact.x, return_index=True)
    change = found.shape[inside] - PchipInterpolator(at, exact.shape[first])(x)
    modes = np.column_stack([np.ones_like(x), x - x.mean()])
    amounts = np.linalg.lstsq(modes * roots[:, None], change * roots, rcond=None)[0]
    return float(np.abs(change - modes @ amounts).max() / np.ptp(exact.shape))


def hertz(poisson_ratio: float) -> float:
    """Largest pressure of the cylinder of `LINE` on the block [Pa]."""
    return line_contact(120e3, 6e-3, contact_modulus(*2 * ((200e9, poisson_ratio),))).peak


STUDIES = [
    Study("cylinder-on-block", LINE, hertz(0.3), False),
    Study("cylinder-on-block", (*LINE, "bodies.cylinder.poisson_ratio=0.45"), hertz(0.45), False),
    Study("sphere-on-block", shaped=False),
    Study("annular-punch"),
    Study("annular-punch-conical"),
    Study("annular-punch-running-in"),
    Study("punch-on-strip"),
    Study("block-on-disk"),
    Study("disk-brake"),
    Study("cylinder-on-block-growing", converged=("mesh.degree=2", "mesh.elements=320")),
]


def best(study: Study) -> dict[float, tuple[int, str]]:
    """Fewest unknowns, and their mesh, by accuracy."""
    errors: dict[tuple[int, int, float], float] = {}
    unknowns: dict[tuple[int, int, float], int] = {}
    for degree, elements, grading in product(DEGREES, ELEMENTS, GRADINGS):
        mesh = [f"mesh.{k}={v}" for k, v in zip(KEYS, (degree, elements, grading), strict=True)]
        try:
            result = study.run(*mesh)
        except (CaseError, ComputationError):
            continue
        errors[degree, elements, grading] = max(study.errors(result))
        unknowns[degree, elements, grading] = result.summary["dofs_displacement"]
    found = {}
    for accuracy in map(ratio, ACCURACIES):
        good = [
            mesh
            for mesh in errors
            if all(
                error <= accuracy
                for other, error in errors.items()
                if other[2] == mesh[2] and other[0] >= mesh[0] and other[1] >= mesh[1]
            )
        ]
        least = min(good, key=lambda mesh: unknowns[mesh], default=None)
        if least is not None:
            found[accuracy] = unknowns[least], "{} {} {}".format(*least)
    return found


KEYS = ("degree", "elements", "grading")


def ratio(text: str) -> float:
    return float(text.removesuffix("%")) / 100.0


def main(words: list[str]) -> None:
    alone = "--alone" in words
    words = [word for word in words if word != "--alone"]
    print(
        f"{'case':60} {'asked':>6} {'mesh':>10} {'unknowns':>8} {'peak':>8} {'shape':>8} "
        f"{'search':>8} best by hand"
    )
    for study in STUDIES:
        name = " ".join((study.starter, *study.overrides[-1:]))
        if not all(word in name for word in words):
            continue
        by_hand = {} if alone else best(study)
        for text in ACCURACIES:
            asked = (*study.overrides, f'mesh.accuracy="{text}"')
            begin = process_time()
            case = with_accurate_mesh(starter(study.starter, *asked, without=WITHOUT))
            spent = process_time() - begin
            result = computed(case)
            errors = [f"{error:8.1e}" for error in study.errors(result)]
            mesh = " ".join(f"{getattr(case.mesh, key):g}" for key in KEYS)
            size, other = by_hand.get(ratio(text), (0, "-"))
            found = result.summary["dofs_displacement"]
            beside = f"{size:6} ({other}) {found / size:.2f}" if size else "-"
            numbers = f"{mesh:>10} {found:8} {' '.join(errors)} {spent:6.0f} s"
            print(f"{name:60} {text:>6} {numbers} {beside}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])

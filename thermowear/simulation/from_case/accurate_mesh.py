"""Mesh of a case that reaches the accuracy it asks for (``mesh.accuracy``)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from mpi4py import MPI

import numpy as np

from ...case import AnyCase
from ...case.tables.schema import MOST_ELEMENTS, MeshTable
from ...errors import CaseError, ComputationError
from ...results import Result
from ...timer import Phases
from ..accuracy.mesh_search import MeshSearch, MeshTrial
from ..analyses.run import run
from ..runtime.observer import Observer
from .analysis import analysis_of, model_of

_HIGHEST = 10
_GRADINGS = (0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 1.0)
_EVENLY = np.linspace(0.0, 1.0, 101)
_ESTIMATED = ("pressure", "max_pressure", "shape", "temperature")


@dataclass(frozen=True)
class MeshSize:
    """Keys of ``mesh`` that an accuracy stands for, see `MeshTable`."""

    degree: int = 2
    elements: int = 4
    grading: float = 0.5

    def higher(self) -> MeshSize | None:
        """The next degree."""
        return replace(self, degree=self.degree + 1) if self.degree < _HIGHEST else None

    def lower(self) -> MeshSize | None:
        """The degree before."""
        return replace(self, degree=self.degree - 1) if self.degree > 1 else None

    def finer(self) -> MeshSize | None:
        """Elements shorter by a third, an even number."""
        elements = max(self.elements + 2, 2 * round(0.75 * self.elements))
        return replace(self, elements=elements) if elements <= MOST_ELEMENTS else None

    def coarser(self) -> MeshSize | None:
        """Elements longer by a half, an even number."""
        elements = min(self.elements - 2, 2 * round(self.elements / 3))
        return replace(self, elements=elements) if elements >= 2 else None

    def steeper(self) -> MeshSize | None:
        """Elements smaller towards the edges of the contact."""
        smaller = [g for g in _GRADINGS if g < self.grading]
        return replace(self, grading=smaller[-1]) if smaller else None

    def flatter(self) -> MeshSize | None:
        """Elements less small towards the edges of the contact."""
        larger = [g for g in _GRADINGS if g > self.grading]
        return replace(self, grading=larger[0]) if larger else None


_KEYS = ("degree", "elements", "grading")


_FORWARD = {
    "degree": (MeshSize.higher,),
    "elements": (MeshSize.finer,),
    "grading": (MeshSize.steeper, MeshSize.flatter),
}
"""Changes of each key that reduce the error."""
_BACK = {
    "degree": (MeshSize.lower,),
    "elements": (MeshSize.coarser,),
    "grading": (MeshSize.steeper, MeshSize.flatter),
}
"""Changes of each key that may reduce the number of unknowns."""


def with_accurate_mesh(
    case: AnyCase, comm=None, observer: Observer | None = None, phases: Phases | None = None
) -> AnyCase:
    """Case with a mesh of the accuracy it asks for; itself where it asks for none.

    Keys of the mesh that the case gives are kept; the analysis is run on one mesh after the other.
    Of a mesh file only the degree is chosen. Every rank calls.

    Raises
    ------
    CaseError
        If the errors of the analysis are not estimated.
    ComputationError
        If nothing can be computed on any mesh.
    """
    accuracy = case.mesh.accuracy
    changed = ("degree",) if case.geometry.from_file else _KEYS
    chosen = [key for key in changed if key not in case.mesh.model_fields_set]
    if accuracy is None:
        return case
    observer = observer or Observer()
    if not chosen:
        observer.note("mesh.accuracy: the mesh is kept, as all keys that it could choose are given")
        return case
    comm = MPI.COMM_WORLD if comm is None else comm
    kept = case.mesh.model_fields_set & MeshTable.CHOSEN
    start = MeshSize(**{key: getattr(case.mesh, key) for key in kept})
    history = case.analysis.type not in ("initial", "steady", "stability")
    failures: list[CaseError | ComputationError] = []

    def evaluate(size: MeshSize) -> MeshTrial[MeshSize] | None:
        """Result on a mesh; None if there is none."""
        try:
            result = _computed(_with(case, size), comm)
        except (CaseError, ComputationError) as error:
            failures.append(error)
            return None
        return comm.bcast(_trial(size, result, history))

    forward, back = (
        {step.__name__: step for key in chosen for step in steps[key]}
        for steps in (_FORWARD, _BACK)
    )
    search = MeshSearch(evaluate, forward, back, accuracy)
    with (phases or Phases(observer.phase))("mesh search"):
        best = search.best(start)
    if best is None:
        raise failures[-1]
    observer.note(_found(search, best))
    return _with(case, best.mesh)


def _with(case: AnyCase, size: MeshSize) -> AnyCase:
    """Case with a mesh of given size."""
    given = case.mesh.model_dump(exclude_unset=True) | {key: getattr(size, key) for key in _KEYS}
    return case.model_copy(update={"mesh": MeshTable(**given)})


def _found(search: MeshSearch[MeshSize], best: MeshTrial[MeshSize]) -> str:
    """Note on the mesh that was found, and on what it does not reach."""
    size, error = best.mesh, search.error(best)
    keys = ", ".join(f"mesh.{key} = {getattr(size, key):g}" for key in _KEYS)
    text = (
        f"mesh.accuracy: {keys} after {len(search.trials)} meshes; {best.unknowns} unknowns, "
        f"estimated error {100 * error:.2g} %"
    )
    if search.singular(best):
        text += (
            " of shape and temperature, and of the pressure in the mean; its largest value does "
            "not converge, as at a sharp edge"
        )
    if error > search.accuracy:
        text += f", not {100 * search.accuracy:g} %: no mesh that was tried reaches it"
    return text


def _computed(case: AnyCase, comm) -> Result:
    """Result of a case that was computed to its end."""
    result = run(model_of(case), analysis_of(case), comm)
    if result.stopped is not None:
        raise result.stopped
    return result


def _trial(size: MeshSize, result: Result, history: bool) -> MeshTrial[MeshSize]:
    """Errors on a mesh, by estimates and by values that are compared with those on other meshes.

    Raises
    ------
    CaseError
        If no error of the pressure is estimated.
    """
    summary, interface = result.summary, result.interface
    found = {name: summary.get(f"{name}_error_estimate_relative") for name in _ESTIMATED}
    estimates = {name: error for name, error in found.items() if error is not None}
    if "pressure" not in estimates:
        missing = summary.get("error_estimate_missing", {})
        reason = missing.get("pressure", missing.get("all", "this analysis has no estimate"))
        raise CaseError(f"mesh.accuracy: the error of the pressure is not known: {reason}")
    values: dict[str, tuple[float | np.ndarray, float]] = {
        "max_pressure": (summary["max_pressure_Pa"], summary["max_pressure_Pa"])
    }
    if history and "shape" in estimates:
        values["shape"] = (_profile(result), summary["shape_range_m"])
    hottest = summary.get("max_temperature_K")
    if hottest is not None and (history or "temperature" not in estimates):
        coldest = min(interface.temperature_1.min(), interface.temperature_2.min())
        values["temperature"] = (hottest, max(hottest - coldest, 1.0))
    return MeshTrial(size, summary["dofs_displacement"], history, estimates, values)


def _profile(result: Result) -> np.ndarray | float:
    """Shape without its mean at even distances on the faces of sections; in space its range [m]."""
    shape, weight = result.interface.shape, result.interface.weight
    if np.any(result.interface.z):
        return float(result.summary["shape_range_m"])
    along = (np.cumsum(weight) - weight / 2) / weight.sum()
    return np.interp(_EVENLY, along, shape - np.average(shape, weights=weight))

"""Meshes that differ in degree, elements and grading, and the changes between them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from mpi4py import MPI

import numpy as np

from ...case import AnyCase
from ...case.tables.mesh import MOST_ELEMENTS, MeshTable
from ...errors import CaseError, ComputationError, percent
from ...results import Result
from ...timer import Phases
from ..accuracy.mesh_search import MeshSearch, MeshTrial, Number, Value, WornHeights
from ..analyses.run import run
from ..runtime.observer import Observer
from .analysis import analysis_of, model_of

_HIGHEST = 10
_GRADINGS = (0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 1.0)


@dataclass(frozen=True)
class MeshSize:
    """Keys of ``mesh`` that an accuracy stands for, see `MeshTable`."""

    degree: int = 1
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


Step = Callable[[MeshSize], MeshSize | None]

_FORWARD: dict[str, tuple[str, Step]] = {
    "higher degree": ("degree", MeshSize.higher),
    "more elements": ("elements", MeshSize.finer),
    "steeper grading": ("grading", MeshSize.steeper),
    "flatter grading": ("grading", MeshSize.flatter),
}
"""Changes that may reduce the error, with the key that they change."""
_BACK: dict[str, tuple[str, Step]] = _FORWARD | {
    "higher degree": ("degree", MeshSize.lower),
    "more elements": ("elements", MeshSize.coarser),
}
"""Changes that may reduce the number of unknowns."""


def changes(chosen: set[str]) -> tuple[Mapping[str, Step], Mapping[str, Step], Step]:
    """Changes of the keys that are to be chosen.

    Returns
    -------
    forward, back : mapping of str to callable
        Changes that may reduce the error, and the number of unknowns.
    finer : callable
        Change to a mesh that is finer in every respect.
    """
    forward, back = (
        {name: step for name, (key, step) in steps.items() if key in chosen}
        for steps in (_FORWARD, _BACK)
    )
    if {"degree", "elements"} <= chosen:
        back["degree for elements"] = _both(MeshSize.lower, MeshSize.finer)
        back["elements for degree"] = _both(MeshSize.higher, MeshSize.coarser)
    refined = [name for name in ("higher degree", "more elements") if name in forward]
    return forward, back, _each(*(forward[name] for name in refined or forward))


def _both(first: Step, second: Step) -> Step:
    """Two changes at once; None if one is not possible."""

    def changed(size: MeshSize) -> MeshSize | None:
        between = first(size)
        return None if between is None else second(between)

    return changed


def _each(*steps: Step) -> Step:
    """All changes that are possible; None if none is."""

    def changed(size: MeshSize) -> MeshSize | None:
        found = size
        for step in steps:
            found = step(found) or found
        return None if found == size else found

    return changed


_KEYS = ("degree", "elements", "grading")
_ESTIMATED = ("pressure", "max_pressure", "shape", "temperature")


def with_accurate_mesh(
    case: AnyCase, comm=None, observer: Observer | None = None, phases: Phases | None = None
) -> AnyCase:
    """Case with a mesh of the accuracy it asks for; itself where it asks for none.

    Keys of the mesh that the case gives are kept; the analysis is run on one mesh after the other.
    Of a mesh file, and of bodies from CAD, only the degree is chosen. Every rank calls.

    Raises
    ------
    CaseError
        If the errors of the analysis are not estimated.
    ComputationError
        If nothing can be computed on any mesh.
    """
    if case.mesh.accuracy is None:
        return case
    observer, chosen = observer or Observer(), _chosen(case)
    if not chosen:
        observer.note("mesh.accuracy: the mesh is kept, as all keys that it could choose are given")
        return case
    trials = Trials(case, chosen, MPI.COMM_WORLD if comm is None else comm)
    search = MeshSearch(trials.evaluate, *changes(chosen), case.mesh.accuracy)
    with (phases or Phases(observer.phase))("mesh search"):
        best = search.best(trials.start())
    if best is None:
        raise trials.failures[-1]
    observer.note(_found(search, best, chosen) + _kept(case))
    return trials.on(best.mesh)


@dataclass(frozen=True)
class Trials:
    """Results of a case on meshes of various sizes. Every rank calls.

    Attributes
    ----------
    case : AnyCase
    chosen : set of str
        Keys of the mesh that are chosen.
    comm : mpi4py.MPI.Comm
    failures : list of CaseError or ComputationError
        Reasons for meshes without a result.
    """

    case: AnyCase
    chosen: set[str]
    comm: MPI.Comm
    failures: list[CaseError | ComputationError] = field(default_factory=list)

    def start(self) -> MeshSize:
        """Coarse mesh with the keys that are kept."""
        kept = MeshTable.CHOSEN - self.chosen
        return MeshSize(**{key: getattr(self.case.mesh, key) for key in kept})

    def on(self, size: MeshSize) -> AnyCase:
        """Case with a mesh of given size."""
        keys = {key: getattr(size, key) for key in _KEYS}
        given = self.case.mesh.model_dump(exclude_unset=True) | keys
        return self.case.model_copy(update={"mesh": MeshTable(**given)})

    def evaluate(self, size: MeshSize) -> MeshTrial[MeshSize] | None:
        """Errors and values on a mesh; None if there is no result on it."""
        try:
            result = _computed(self.on(size), self.comm)
        except (CaseError, ComputationError) as error:
            self.failures.append(error)
            return None
        return self.comm.bcast(_trial(self.case, size, result))


def _chosen(case: AnyCase) -> set[str]:
    """Keys of the mesh that are chosen."""
    made = not (case.geometry.from_file or case.geometry.sized)
    changed = set(_KEYS) if made else {"degree"}
    return changed - case.mesh.model_fields_set


def _kept(case: AnyCase) -> str:
    """Addition to the note, on keys of the mesh that are not chosen."""
    if not case.geometry.sized:
        return ""
    return "; mesh.size, mesh.contact_size and mesh.grading of bodies from CAD are kept"


def _found(search: MeshSearch[MeshSize], best: MeshTrial[MeshSize], chosen: set[str]) -> str:
    """Note on the mesh that was found, and on what it does not reach."""
    size, error = best.mesh, search.error(best)
    keys = ", ".join(f"mesh.{key} = {getattr(size, key):g}" for key in _KEYS if key in chosen)
    text = (
        f"mesh.accuracy: {keys} after {len(search.trials)} meshes; {best.unknowns} unknowns, "
        f"estimated error {percent(error)}"
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


def _trial(case: AnyCase, size: MeshSize, result: Result) -> MeshTrial[MeshSize]:
    """Estimated errors on a mesh, and values that are compared with those on other meshes.

    A history carries errors of earlier states along, of which the estimate of the largest pressure
    at its end knows nothing.

    Raises
    ------
    CaseError
        If no error of the pressure is estimated.
    """
    summary = result.summary
    found = {name: summary.get(f"{name}_error_estimate_relative") for name in _ESTIMATED}
    estimates = {name: error for name, error in found.items() if error is not None}
    if "pressure" not in estimates:
        missing = summary.get("error_estimate_missing", {})
        reason = missing.get("pressure", missing.get("all", "this analysis has no estimate"))
        raise CaseError(f"mesh.accuracy: the error of the pressure is not known: {reason}")
    if case.analysis.type not in ("initial", "steady", "stability"):
        estimates.pop("max_pressure", None)
    values: dict[str, Value] = {"max_pressure": Number(*2 * (summary["max_pressure_Pa"],))}
    if "shape" in estimates:
        values["shape"] = _shape(result)
    hottest, heat = summary.get("max_temperature_K"), case.heat
    if hottest is not None and heat is not None:
        values["temperature"] = Number(hottest, max(abs(hottest - heat.ambient), 1.0))
    return MeshTrial(size, summary["dofs_displacement"], estimates, values)


def _shape(result: Result) -> Value:
    """Shape along the contact of a section; in space its range."""
    interface = result.interface
    if np.isnan(interface.s).any():
        return Number(*2 * (float(result.summary["shape_range_m"]),))
    pressing, order = np.where(interface.pressure > 0, interface.weight, 0.0), []
    for own in result.contacts.values() or [slice(None)]:
        along = np.arange(len(pressing))[own]
        order.append(along if interface.s[along[0]] <= interface.s[along[-1]] else along[::-1])
    rows = np.concatenate(order)
    return WornHeights(interface.s[rows], interface.shape[rows], pressing[rows])

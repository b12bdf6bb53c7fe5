"""Mesh of a case that reaches the accuracy it asks for (``mesh.accuracy``)."""

from __future__ import annotations

from dataclasses import dataclass, field

from mpi4py import MPI

import numpy as np

from ...case import AnyCase
from ...case.tables.mesh import MeshTable
from ...errors import CaseError, ComputationError, percent
from ...results import Result
from ...timer import Phases
from ..accuracy.compared_values import Number, WornHeights
from ..accuracy.mesh_search import MeshSearch, MeshTrial, Value
from ..analyses.run import run
from ..runtime.observer import Observer
from .analysis import analysis_of, model_of
from .mesh_size import MeshSize, changes

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

"""Run of an analysis, and of series of models that share set-up results."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from itertools import chain
from typing import Any

from mpi4py import MPI

from numpy.linalg import LinAlgError

from ...balances import judged
from ...bulk.kinematics import kinematics_of
from ...bulk.solvers.multigrid import MultigridSolver
from ...errors import CaseError, ComputationError, percent
from ...model.analyses import (
    Analysis,
    FrettingAnalysis,
    ReciprocatingAnalysis,
    StaticAnalysis,
    TransientAnalysis,
)
from ...model.model import Model
from ...results import Result
from ...timer import Phases
from ..accuracy.error_estimate import estimate_errors
from ..cycles.fretting import FrettingHistory
from ..cycles.reciprocating import ReciprocatingHistory
from ..cycles.stroke import moved_contacts, stroke_ends, strokes
from ..results.recording import Snapshot, fields_of, sample
from ..results.summary import merged
from ..runtime.history import AnalysisHistory
from ..runtime.observer import Observer, Saved, mesh_checksum
from ..system.building import contacts_of
from ..system.setup_cache import SetupCache, inputs
from ..system.system import System
from .checks import (
    changed_by_updates,
    contact_at_an_end,
    deep_wear,
    free_motion,
    inclined_faces,
    moved_against_load,
    open_contact,
    require_computable,
    singular_pressure,
    stick_edge,
    too_hot,
)
from .limits import beyond_elasticity
from .positioning import prepare
from .stability import hot_state, stability
from .static import initial, steady
from .transient import TransientHistory

_UNPAIRED = 1e-6
_FOR_EVER = "steady", "stability"
"""Analyses of wear that goes on for ever, in which all layers are worn through."""
_HOT = ("initial", "steady", "transient")
"""Analyses whose states have a critical speed."""


def run(
    model: Model,
    analysis: Analysis,
    comm=None,
    observer: Observer | None = None,
    phases: Phases | None = None,
    saved: Saved | None = None,
) -> Result:
    """Compute an analysis of a model. Every rank calls.

    Parameters
    ----------
    model : Model
    analysis : Analysis
    comm : mpi4py.MPI.Comm, optional
        All ranks by default.
    observer : Observer, optional
    phases : Phases, optional
        Timer that is already running.
    saved : Saved, optional
        Checkpoint from `Observer.checkpoint` of an earlier run on this rank, to restart from; the
        result has the whole history, and the outputs from there on.

    Raises
    ------
    ComputationError
        If there is no result at all; a transient run that stops early is returned with its error,
        and likewise a run whose balances do not hold.
    """
    observer = observer or Observer()
    phases = phases or Phases(observer.phase)
    comm = MPI.COMM_WORLD if comm is None else comm
    system = prepare(model, comm, phases, single=needs_single_solution(model, analysis))
    return solve(system, analysis, observer, saved)[1]


def check(model: Model, analysis: Analysis, comm=None) -> None:
    """Check a model and its analysis as `run` does before it solves anything. Every rank calls.

    Raises
    ------
    CaseError
    """
    comm = MPI.COMM_WORLD if comm is None else comm
    contacts, holder = contacts_of(model, comm)
    require_computable(model, analysis, contacts, holder)
    if isinstance(analysis, ReciprocatingAnalysis):
        kinematics = kinematics_of(model.kinematics, model.thickness, model.sector)
        first, second, *_ = stroke_ends(analysis)
        offset = (first + second) / 2 * strokes(model, analysis)
        for there in (offset, -offset):
            moved_contacts(model, comm, kinematics, contacts, there)


def needs_single_solution(model: Model, analysis: Analysis) -> bool:
    """Test whether an analysis solves its bodies for one load only, and needs no compliance.

    That is the steady state of wear with material properties that do not depend on temperature,
    and without contacts at rest.
    """
    varying = any(m.expansion_factor or m.conductivity_factor for m in model.materials.values())
    resting = any(interface.motion.at_rest for interface in model.interfaces)
    return analysis.type == "steady" and not varying and not resting


def solve(
    system: System, analysis: Analysis, observer: Observer, saved: Saved | None = None
) -> tuple[Snapshot, Result]:
    """Compute an analysis of a system, with error estimates and fields. Every rank calls.

    Returns
    -------
    end : Snapshot
        Contact, bodies and interface at the end, whose meshes may have been moved.
    result : Result
    """
    end, result = analyse(system, analysis, observer, saved)
    with system.phases("error estimate"):
        result = _estimated(analysis, end, result, observer)
    with system.phases("fields"):
        samples = sample(end)
        for note in beyond_elasticity(end, samples):
            observer.note(note)
        fields = fields_of(end.system, samples)
    return end, replace(balanced(result), fields=fields)


def analyse(
    system: System, analysis: Analysis, observer: Observer, saved: Saved | None = None
) -> tuple[Snapshot, Result]:
    """Run an analysis of a system, and note implausible results. Every rank calls.

    Starts anew, or from the checkpoint of an analysis of the same system.
    """
    choice = system.choice
    require_computable(system.model, analysis, system.contacts, system.holder)
    if system.model.coated and analysis.type in _FOR_EVER:
        observer.note(
            f"a {analysis.type} analysis describes wear that goes on for ever: all layers are worn "
            "through, and the laws of the substrates hold"
        )
        system = system.worn_through()
    for note in (choice.note(), _factorised_conduction(system), _streamed(system, analysis)):
        if note is not None:
            observer.note(note)
    for pairing in system.contacts.each:
        if pairing.unpaired > _UNPAIRED:
            several, number = len(system.contacts.each) > 1, pairing.carrier + 1
            face = pairing.carrying.face.name if several else f"of body {number}"
            observer.note(
                f"{percent(pairing.unpaired)} of the contact face {face} has "
                "nothing opposite and stays out of the contact"
            )
    if isinstance(analysis, StaticAnalysis):
        end, result = _STATIC[analysis.type](system, analysis, observer)
    else:
        before = None if saved is None else saved.of(system)
        history = _STEPPED[type(analysis)](system, analysis, observer)
        last = history.resume(before)
        end, result = history.conclude(history.follow(history.states(last)))
    entries, singular = singular_pressure(end, analysis)
    result = replace(result, summary=merged(result.summary, entries))
    if analysis.type in _HOT:
        result = hot_state(end, result, observer)
    found: list[ComputationError | str | None] = [
        singular,
        contact_at_an_end(end.system, end.contact.pressure),
        inclined_faces(end.system, end.contact.pressure),
        free_motion(end.system, end.contact.pressure),
        deep_wear(system, analysis, end.interface),
        changed_by_updates(result.summary),
        stick_edge(result.summary),
        too_hot(result.summary),
    ]
    if result.stopped is None:
        found = [
            open_contact(system, end.interface),
            moved_against_load(system, analysis, end),
            *found,
        ]
    for note in (one for one in found if isinstance(one, str)):
        observer.note(note)
    errors = (one for one in found if isinstance(one, ComputationError))
    stopped = result.stopped or next(errors, None)
    mesh, solved = mesh_checksum(system), choice.summary() | _iterations(system)
    named = {"title": system.model.title, "analysis": analysis.type}
    origin = {} if mesh is None else {"mesh_sha256": mesh}
    return end, replace(result, summary=named | result.summary | solved | origin, stopped=stopped)


def _factorised_conduction(system: System) -> str | None:
    """Note on conduction that is factorised although the bodies are not."""
    thermal = system.thermal
    if not system.choice.iterative or thermal is None or thermal.conduction.even is None:
        return None
    return 'solver: direct for the temperatures, as heat.advection = "spread" joins their unknowns'


def _streamed(system: System, analysis: Analysis) -> str | None:
    """Note on the response of the gap to temperatures, where it is needed and not stored."""
    needed = system.model.method == "condensed" and not (
        system.choice.single and needs_single_solution(system.model, analysis)
    )
    return system.opening_storage.note() if needed else None


def _iterations(system: System) -> dict[str, int]:
    """Largest numbers of multigrid iterations of a solution, if there are any."""
    thermal = system.thermal
    solvers: dict[str, list] = {
        "elasticity": [group.factor for group in system.elastic.groups],
        "conduction": [] if thermal is None else [thermal.conduction.factor],
    }
    counted = {
        name: [k for one in some if isinstance(one, MultigridSolver) for k in one.iterations]
        for name, some in solvers.items()
    }
    return {f"multigrid_iterations_{name}": max(ks) for name, ks in counted.items() if ks}


def _estimated(analysis: Analysis, end: Snapshot, result: Result, observer: Observer) -> Result:
    """Add discretisation error estimates to the summary; note large ones. Every rank calls."""
    if result.stopped is not None:
        return result
    try:
        estimates = estimate_errors(analysis, end, result.summary.get("time_s", 0.0))
    except (CaseError, ComputationError, LinAlgError) as error:  # the result is valid without it
        observer.note(f"no estimate of the discretisation error, because {error}")
        missing = {"error_estimate_missing": {"all": str(error)}}
        return replace(result, summary=result.summary | missing)
    edge = result.summary.get("wear_volume_error_estimate_relative")
    for quantity in ("shape", "max_pressure"):  # singular inside the edge of the stick zone
        known = estimates.errors[quantity]
        if edge is not None and known is not None:
            estimates.errors[quantity] = max(known, edge)
    for note in estimates.notes():
        observer.note(note)
    return replace(result, summary=result.summary | estimates.summary())


def balanced(result: Result) -> Result:
    """Mark a result as failed if its balances do not hold."""
    return replace(result, stopped=result.stopped or judged(result.summary))


_STATIC: dict[str, Callable[..., tuple[Snapshot, Result]]] = {
    "initial": lambda system, _, observer: initial(system, observer),
    "steady": lambda system, _, observer: steady(system, observer),
    "stability": stability,
}
_STEPPED: dict[type, Callable[..., AnalysisHistory]] = {
    TransientAnalysis: TransientHistory,
    FrettingAnalysis: FrettingHistory,
    ReciprocatingAnalysis: ReciprocatingHistory,
}


class Series:
    """Sequence of models with a shared set-up cache; see `groups`.

    Parameters
    ----------
    comm : mpi4py.MPI.Comm, optional
        All ranks by default.
    """

    def __init__(self, comm=None):
        self.comm = MPI.COMM_WORLD if comm is None else comm
        self._parts = SetupCache()

    def run(
        self,
        model: Model,
        analysis: Analysis,
        observer: Observer | None = None,
        phases: Phases | None = None,
    ) -> Result:
        """Compute the next model, as `run` does, without the fields in the bodies.

        Every rank calls.

        Raises
        ------
        CaseError, ComputationError
        """
        observer = observer or _Quiet()
        single = needs_single_solution(model, analysis)
        phases = phases or Phases(observer.phase)
        system = prepare(model, self.comm, phases, self._parts, single)
        return balanced(analyse(system, analysis, observer)[1])


class _Quiet(Observer):
    """Observer of one run among many, whose notes are not shown."""

    def note(self, text: str) -> None:
        pass


def groups(models: Iterable[Model]) -> list[list[int]]:
    """Group numbers of models by equal elastic bodies, ordered within by equal thermal set-up.

    Groups may be computed in parallel. They share no costly set-up results, but for neighbours that
    differ in thermal expansion only: these share the factors of stiffness and conduction.
    """
    shared: _Groups = {}
    for number, model in enumerate(models):
        made_from = inputs(model)
        alone = model.discretisation.positioning
        stiff = _of(shared, () if alone else made_from.stiffness, {}, number if alone else "")
        heated = _of(stiff, made_from.elasticity, {})
        _of(heated, made_from.conduction, []).append(number)
    return [
        [number for _, numbers in _each(heated) for number in numbers]
        for _, stiff in _each(shared)
        for _, heated in _each(stiff)
    ]


_Groups = dict[str, list[tuple[tuple, Any]]]
"""Keys and what belongs to them, by the text of all parts of the keys but the last."""


def _each(table: _Groups) -> Iterator[tuple[tuple, Any]]:
    return chain.from_iterable(table.values())


def _of(table: _Groups, key: tuple, empty: Any, apart: object = "") -> Any:
    """Content of a key, which need not be hashable; created if missing."""
    alike = table.setdefault(f"{apart}{key[:-1]!r}", [])
    for known, content in alike:
        if known == key:
            return content
    alike.append((key, empty))
    return empty

"""Run an analysis of a model: set-up, analysis, checks, error estimate and result."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from numpy.linalg import LinAlgError

from ...balances import judged
from ...errors import CaseError, ComputationError
from ...model.analyses import (
    Analysis,
    FrettingAnalysis,
    ReciprocatingAnalysis,
    StaticAnalysis,
    TransientAnalysis,
)
from ...model.model import Model
from ...timer import Phases
from ..accuracy.error_estimate import estimate_errors
from ..cycles.fretting import fretting
from ..cycles.reciprocating import reciprocating
from ..geometry_update.face_limits import outgrown
from ..interface.condensed_method import CondensedMethod
from ..interface.interface_problem import InterfaceProblem
from ..results.fields import sample
from ..results.outcome import Outcome
from ..results.recording import profile
from ..results.result import BodyFields, Result
from ..results.summary import summarise
from ..runtime.checkpoint_data import Saved, mesh_checksum
from ..runtime.observer import Observer
from ..system.system import System
from .plausible import too_steep, went_back
from .positioning import prepare
from .small_wear_check import not_small
from .stability import stability
from .static import initial, steady, unworn
from .transient import running_in
from .untouched_contact import touching

_UNPAIRED = 1e-6


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

    Returns
    -------
    Result

    Raises
    ------
    ComputationError
        If there is no result at all; a transient run that stops early is returned with its error,
        and likewise a run whose balances do not hold.
    """
    if comm is None:
        from mpi4py import MPI

        comm = MPI.COMM_WORLD
    observer = observer or Observer()
    phases = phases or Phases(observer.phase)
    system = prepare(model, comm, phases)
    outcome = analyse(system, analysis, observer, saved)
    with phases("error estimate"):
        outcome = estimated(system, analysis, outcome, observer)
    with phases("fields"):
        fields = sample(outcome.system or system, outcome.state, outcome.motion)
    return conclude(system, analysis, outcome, fields)


def analyse(
    system: System, analysis: Analysis, observer: Observer, saved: Saved | None = None
) -> Outcome:
    """Run an analysis of a system, and note implausible results. Every rank calls.

    Starts anew, or from the checkpoint of an analysis of the same system.
    """
    if system.pairing.unpaired > _UNPAIRED:
        percent = 100 * system.pairing.unpaired
        observer.note(
            f"{percent:.2g} % of the contact face of body 1 has nothing opposite and "
            "stays out of the contact"
        )
    if isinstance(analysis, StaticAnalysis):
        outcome = _STATIC[analysis.type](system, observer)
    else:
        before = None if saved is None else saved.of(system)
        outcome = _STEPPED[type(analysis)](system, analysis, observer, before)
    if outgrown(outcome.system or system, outcome.contact.pressure):
        observer.note(
            "the contact reaches the end of the contact face, which was meshed for a smaller one; "
            "use contact.positioning = true, or a wider geometry.zone"
        )
    outcome, apart = touching(system, outcome)
    if apart is not None:
        observer.note(apart)
    steep = too_steep(outcome.system or system, outcome.contact.pressure)
    if steep is not None:
        observer.note(steep)
    if outcome.stopped is None:
        outcome = replace(outcome, stopped=went_back(system, analysis, outcome))
    large = not_small(system, analysis, outcome.interface)
    if large is not None:
        observer.note(large)
    mesh = mesh_checksum(system)
    return (
        outcome if mesh is None else replace(outcome, extra=outcome.extra | {"mesh_sha256": mesh})
    )


def estimated(system: System, analysis: Analysis, outcome: Outcome, observer: Observer) -> Outcome:
    """Add discretisation error estimates to the summary of an outcome; note large ones.

    Every rank calls.
    """
    if outcome.stopped is not None:
        return outcome
    try:
        estimates = estimate_errors(outcome.system or system, analysis, outcome)
    except (CaseError, ComputationError, LinAlgError) as error:  # the result is valid without it
        return replace(
            outcome, extra=outcome.extra | {"error_estimate_missing": {"all": str(error)}}
        )
    warning = estimates.warning()
    if warning is not None:
        observer.note(warning)
    return replace(outcome, extra=outcome.extra | estimates.summary())


def conclude(
    system: System, analysis: Analysis, outcome: Outcome, fields: BodyFields | None
) -> Result:
    """Result of a run; marked as failed if its balances do not hold."""
    system = outcome.system or system
    summary = summarise(system, analysis, outcome)
    return Result(
        outcome.interface,
        profile(system, outcome.interface),
        summary,
        outcome.history,
        outcome.outputs,
        fields,
        outcome.friction,
        outcome.track,
        outcome.stopped or judged(summary),
        outcome.heat,
        outcome.modes,
    )


def _stability(system: System, observer: Observer) -> Outcome:
    """Stability of the steady state, or of the cold unworn contact if there is none."""
    free = system.holder.free
    if system.laws and len(free) and free.all():
        return stability(system, steady(system, observer), observer)
    cold = InterfaceProblem(system, CondensedMethod(system), None)
    return stability(system, unworn(system, cold), observer)


_STATIC: dict[str, Callable[[System, Observer], Outcome]] = {
    "initial": initial,
    "steady": steady,
    "stability": _stability,
}
_STEPPED: dict[type, Callable[..., Outcome]] = {
    TransientAnalysis: running_in,
    FrettingAnalysis: fretting,
    ReciprocatingAnalysis: reciprocating,
}

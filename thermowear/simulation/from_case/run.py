"""Run of a case, on a mesh of the accuracy it asks for."""

from __future__ import annotations

from mpi4py import MPI

from ...case import AnyCase
from ...errors import note
from ...results import Result
from ...timer import Phases
from ..analyses import run as analyses
from ..runtime.observer import Observer, Saved
from .accurate_mesh import with_accurate_mesh
from .analysis import analysis_of, model_of


def run(
    case: AnyCase,
    comm=None,
    observer: Observer | None = None,
    phases: Phases | None = None,
    saved: Saved | None = None,
) -> Result:
    """Compute a case; see `simulation.analyses.run`. Every rank calls.

    A run that stops early returns its results so far with a warning.
    """
    case = with_accurate_mesh(case, comm, observer, phases)
    result = analyses.run(model_of(case), analysis_of(case), comm, observer, phases, saved)
    if result.stopped is not None and (comm or MPI.COMM_WORLD).rank == 0:
        reason = str(result.stopped) or type(result.stopped).__name__
        note(f"the run has stopped early; its results end there: {reason}")
    return result

"""Run of a case, on a mesh of the accuracy it asks for."""

from __future__ import annotations

from ...case import AnyCase
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
    """Compute a case; see `simulation.analyses.run`. Every rank calls."""
    case = with_accurate_mesh(case, comm, observer, phases)
    return analyses.run(model_of(case), analysis_of(case), comm, observer, phases, saved)

"""Run a case: translate it, and analyse its model."""

from __future__ import annotations

from ...case.tables.schema import Case
from ...results import Result
from ...timer import Phases
from ..analyses import run as analyses
from ..runtime.checkpoint_data import Saved
from ..runtime.observer import Observer
from .analysis import analysis_of
from .model import model_of


def run(
    case: Case,
    comm=None,
    observer: Observer | None = None,
    phases: Phases | None = None,
    saved: Saved | None = None,
) -> Result:
    """Compute a case; see `simulation.analyses.run`. Every rank calls."""
    return analyses.run(model_of(case), analysis_of(case), comm, observer, phases, saved)

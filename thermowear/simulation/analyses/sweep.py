"""Sequential models of a sweep with reuse of shared set-up results."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...model.analyses import Analysis
from ...model.model import Model
from ...results import Result
from ...timer import Phases
from ..runtime.observer import Observer
from ..system.building import build
from ..system.system import SetupCache, System, inputs
from .positioning import prepare
from .run import analyse, balanced


class Series:
    """Sequence of models with a shared set-up cache, see `groups`.

    Parameters
    ----------
    comm : mpi4py.MPI.Comm, optional
        All ranks by default.
    """

    def __init__(self, comm=None):
        if comm is None:
            from mpi4py import MPI

            comm = MPI.COMM_WORLD
        self.comm = comm
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
        observer = observer or Observer()
        system = self._prepared(model, phases or Phases(observer.phase))
        return balanced(analyse(system, analysis, observer)[1])

    def _prepared(self, model: Model, phases: Phases) -> System:
        if model.discretisation.positioning:  # its mesh depends on the contact of this model
            return prepare(model, self.comm, phases)
        return build(model, self.comm, phases, parts=self._parts)


def groups(models: Sequence[Model]) -> list[list[int]]:
    """Group numbers of models by equal elastic bodies, ordered within by equal thermal set-up.

    Groups share no costly set-up results, and may be computed in parallel.
    """
    shared: list[tuple[Any, list[tuple[Any, list[int]]]]] = []
    for number, model in enumerate(models):
        made_from = inputs(model)
        bodies = None if model.discretisation.positioning else made_from.elasticity
        heated = _of(shared, bodies, bodies is None)
        _of(heated, made_from.conduction).append(number)
    return [[number for _, numbers in heated for number in numbers] for _, heated in shared]


def _of(table: list[tuple[Any, list]], key: Any, new: bool = False) -> list:
    """List of a key, which need not be hashable; created if missing or requested new."""
    for known, found in () if new else table:
        if known == key:
            return found
    table.append((key, []))
    return table[-1][1]

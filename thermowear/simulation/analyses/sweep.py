"""Sequential cases of a sweep with reuse of shared set-up results."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...case.tables.schema import Case
from ...results import Result
from ...timer import Phases
from ..model.building import build
from ..model.setup_cache import SetupCache, inputs
from ..model.system import System
from ..runtime.observer import Observer
from .positioning import prepare
from .run import analyse, balanced


class Series:
    """Sequence of cases with a shared set-up cache, see `groups`.

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
        self, case: Case, observer: Observer | None = None, phases: Phases | None = None
    ) -> Result:
        """Compute the next case, as `run` does, without the fields in the bodies.

        Every rank calls.

        Raises
        ------
        CaseError, ComputationError
        """
        observer = observer or Observer()
        system = self._prepared(case, phases or Phases(observer.phase))
        return balanced(analyse(system, observer)[1])

    def _prepared(self, case: Case, phases: Phases) -> System:
        if case.contact.positioning:  # its mesh depends on the contact of this case
            return prepare(case, self.comm, phases)
        return build(case, self.comm, phases, parts=self._parts)


def groups(cases: Sequence[Case]) -> list[list[int]]:
    """Group case numbers by equal elastic bodies, ordered within by equal thermal set-up.

    Groups share no costly set-up results, and may be computed in parallel.
    """
    shared: list[tuple[Any, list[tuple[Any, list[int]]]]] = []
    for number, case in enumerate(cases):
        made_from = inputs(case)
        bodies = None if case.contact.positioning else made_from.elasticity
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

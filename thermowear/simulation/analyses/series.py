"""Series of models that share set-up results, and groups of models that do."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from typing import Any

from mpi4py import MPI

from ...model.analyses import Analysis
from ...model.model import Model
from ...results import Result
from ...timer import Phases
from ..runtime.observer import Observer
from ..system.setup_cache import SetupCache, inputs
from .positioning import prepare
from .run import analyse, balanced, needs_single_solution


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

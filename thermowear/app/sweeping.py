"""Parameter sweep: variants of a case, grouped by shared factorisations.

Modules that need dolfinx are imported in functions, as the distributing process does not need them.
"""

from __future__ import annotations

import os
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

from .. import load
from ..case import AnyCase, as_plain
from ..errors import CaseError, ComputationError, UnwritableError
from ..output.folder import ResultsFolder
from ..output.sweep import SweepFolder, draw_sweep, swept
from ..results import Result
from .batch.computing import Lost, Stopped, compute
from .batch.executors import Choice, Crew, Workers
from .batch.reporting import BatchReport, checksum_of, message_of, status_of
from .batch.variants import Variant, grouped, parse_over, variants, written


def sweep(
    case: AnyCase | str | Path,
    over: Mapping[str, Sequence[Any]],
    executor: Executor | None = None,
    workers: int | None = None,
) -> list[tuple[dict[str, Any], Result | ComputationError]]:
    """Compute all combinations of values of keys of a case.

    Parameters
    ----------
    case : AnyCase, str or Path
        Case, or path of a case file.
    over : mapping of str to sequence
        Values by key path, as in a case file: ``{"load.force": ["1 kN", "2 kN"]}``.
    executor : concurrent.futures.Executor, optional
        Executor of processes, of MPI ranks (`mpi4py.futures`), of a cluster (``get_executor`` of a
        client of Dask); by default the variants are computed in this process.
    workers : int, optional
        Number of workers of the executor; by default the number of cores of this machine.

    Returns
    -------
    list of (dict, Result or ComputationError)
        Values by key with the result, or the error of a failed variant.

    Raises
    ------
    CaseError
        If any variant is invalid; then none is computed.
    KeyboardInterrupt
        If a stop was requested during a variant; no further one is computed.
    """
    source = as_plain(case) if isinstance(case, AnyCase) else case
    found = variants(source, {key: [written(v) for v in values] for key, values in over.items()})
    tasks: list[tuple[int, AnyCase | dict]] = [
        (k, variant.case if executor is None else as_plain(variant.case))
        for k, variant in enumerate(found)
    ]
    groups = [[tasks[k] for k in group] for group in grouped([v.case for v in found])]
    results: dict[int, Result | ComputationError] = {}

    def received(outcome) -> None:
        if isinstance(outcome, Lost):
            outcome = outcome.task[0], ComputationError(outcome.reason)
        results[outcome[0]] = outcome[1]

    compute(groups, _result, received, executor, workers or len(os.sched_getaffinity(0)))
    given = (dict(zip(over, values, strict=True)) for values in product(*over.values()))
    return [(values, results[k]) for k, values in enumerate(given)]


def _result(
    series, task: tuple[int, AnyCase | dict[str, Any]]
) -> tuple[int, Result | ComputationError]:
    """Compute a variant, by its number and case; other processes get its tables."""
    from ..simulation.from_case import analysis_of, model_of, with_accurate_mesh

    number, given = task
    case = load(given) if isinstance(given, dict) else given
    try:
        case = with_accurate_mesh(case, series.comm)
        result = series.run(model_of(case), analysis_of(case))
    except ComputationError as error:
        return number, error
    if isinstance(result.stopped, KeyboardInterrupt):
        raise result.stopped
    return number, result


@dataclass(frozen=True)
class Job:
    """Variant to be computed by any process: plain tables, as quantities belong to a process."""

    number: int
    tables: dict[str, Any]
    path: Path


@dataclass(frozen=True)
class Ended:
    """Outcome of a variant: ``done`` or a description of the failure, and its summary if any."""

    number: int
    status: str
    summary: dict[str, Any] | None
    seconds: float


def run_sweep(chosen) -> int:
    """Compute the variants of a parsed ``sweep`` command.

    Raises
    ------
    CaseError
        If any variant is invalid; then none is computed.
    ComputationError
        If any variant failed; the others are computed and written.
    UnwritableError
        At the first result that cannot be written.
    """
    with Choice(chosen.executor, chosen.processes, chosen.scheduler).crew() as crew:
        return 0 if crew.serves else _run_with(crew, chosen)


def _run_with(crew: Crew, chosen) -> int:
    over = parse_over(chosen.over)
    found = variants(chosen.case, over, tuple(chosen.overrides))
    tables = [as_plain(variant.case) for variant in found]
    keys = [swept(key, [v.values[key] for v in found], tables) for key in over]
    path = chosen.output or Path("results") / f"{chosen.case.stem}-sweep"
    checksum = checksum_of(tables)
    folder = SweepFolder(path, over, keys, checksum, chosen.overwrite, chosen.resume)
    report = BatchReport(folder, lambda number: _name(found[number - 1]))
    left = [k for k, variant in enumerate(found) if variant.number not in folder.ended]
    jobs = {k: Job(k + 1, tables[k], folder.variant(k + 1)) for k in left}

    def received(outcome: Ended | Lost) -> None:
        if isinstance(outcome, Lost):
            outcome = Ended(outcome.task.number, f"failed: {outcome.reason}", None, 0.0)
        folder.add(outcome.number, outcome.status, outcome.summary, outcome.seconds)
        report.ended(outcome.number, outcome.status, outcome.seconds)

    with report.closing(lambda: draw_sweep(folder.path) if chosen.pictures else None):
        groups = grouped([found[k].case for k in left])
        tasks = [[jobs[left[k]] for k in group] for group in groups]
        workers = crew.workers(len(groups), len(left)) if left else Workers(None)
        compute(tasks, compute_variant, received, workers.executor, workers.count)
    message = report.failures()
    if message:
        raise ComputationError(message)
    return 0


def _name(variant: Variant) -> str:
    values = ", ".join(f"{key}={value}" for key, value in variant.values.items())
    return f"variant {variant.number} ({values})"


def compute_variant(series, job: Job) -> Ended:
    """Compute a variant, and write its folder."""
    from ..simulation.from_case import analysis_of, model_of, with_accurate_mesh
    from ..timer import Phases
    from .session import Recorder

    began, phases, summary = time.perf_counter(), Phases(), None
    problem: BaseException | None = None
    try:
        folder = ResultsFolder(job.path, job.tables, 1, overwrite=True)
    except CaseError as error:
        raise UnwritableError(str(error)) from None
    try:
        try:
            observer, case = Recorder(series.comm, folder), load(job.tables)
            case = with_accurate_mesh(case, series.comm, observer, phases)
            folder.describe(as_plain(case))
            result = series.run(model_of(case), analysis_of(case), observer, phases)
            with phases("write"):
                folder.finish(result, phases.seconds)
            summary, problem = result.summary, result.stopped
        except BaseException as error:
            problem = error
        ending = "interrupted" if isinstance(problem, KeyboardInterrupt) else "failed"
        folder.close("done" if problem is None else ending, message_of(problem))
    except OSError as error:  # of the folder; an interrupt still ends the sweep
        kept = isinstance(problem, KeyboardInterrupt | UnwritableError)
        problem = problem if kept else error
    ended = Ended(job.number, status_of(problem), summary, time.perf_counter() - began)
    if isinstance(problem, KeyboardInterrupt):
        raise Stopped(ended)
    return ended

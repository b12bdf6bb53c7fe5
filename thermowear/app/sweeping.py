"""Parameter sweep: variants of a case, grouped by shared factorisations.

Modules that need dolfinx are imported in functions, as the distributing process does not need them.
"""

from __future__ import annotations

import os
import time
import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

from .. import load
from ..case import AnyCase, as_plain
from ..errors import CaseError, ComputationError
from ..interrupts import DeferredSignals
from ..output.console import Terminal
from ..output.folder import ResultsFolder
from ..output.sweep import SweepFolder, draw_sweep, swept
from ..results import Result
from .variants import Variant, parse_over, variants, written
from .workers import start_petsc, work_off


def sweep(
    case: AnyCase | str | Path, over: Mapping[str, Sequence[Any]]
) -> list[tuple[dict[str, Any], Result | ComputationError]]:
    """Compute all combinations of values of keys of a case in this process.

    Parameters
    ----------
    case : AnyCase, str or Path
        Case, or path of a case file.
    over : mapping of str to sequence
        Values by key path, as in a case file: ``{"load.force": ["1 kN", "2 kN"]}``.

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
    from ..simulation.analyses.run import Series, groups
    from ..simulation.from_case import analysis_of, model_of, with_accurate_mesh

    source = as_plain(case) if isinstance(case, AnyCase) else case
    found = variants(source, {key: [written(v) for v in values] for key, values in over.items()})
    results: dict[int, Result | ComputationError] = {}
    for group in groups([model_of(variant.case) for variant in found]):
        series = Series()
        for k in group:
            try:
                case = found[k].case
                case = with_accurate_mesh(case, series.comm)
                result = series.run(model_of(case), analysis_of(case))
            except ComputationError as error:
                results[k] = error
                continue
            if isinstance(result.stopped, KeyboardInterrupt):
                raise result.stopped
            results[k] = result
    given = (dict(zip(over, values, strict=True)) for values in product(*over.values()))
    return [(values, results[k]) for k, values in enumerate(given)]


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
    """
    over = parse_over(chosen.over)
    found = variants(chosen.case, over, tuple(chosen.overrides))
    tables = [as_plain(variant.case) for variant in found]
    keys = [swept(key, [v.values[key] for v in found], tables) for key in over]
    path = chosen.output or Path("results") / f"{chosen.case.stem}-sweep"
    folder = SweepFolder(path, over, keys, chosen.overwrite)
    report = _Report(folder, found)
    jobs = [
        Job(v.number, plain, folder.variant(v.number))
        for v, plain in zip(found, tables, strict=True)
    ]
    try:
        _compute_all(found, jobs, chosen.processes, report)
    except BaseException as error:
        interrupted = isinstance(error, KeyboardInterrupt)
        report.close(chosen.pictures, "interrupted" if interrupted else "failed", str(error))
        raise
    message = report.failures()
    report.close(chosen.pictures, "failed" if message else "done", message)
    if message:
        raise ComputationError(message)
    return 0


def _compute_all(found: list[Variant], jobs: list[Job], processes: int | None, report) -> None:
    """Compute groups of variants with shared factorisations, in parallel processes if several."""
    with DeferredSignals():
        start_petsc()
        from ..simulation.analyses.run import groups
        from ..simulation.from_case import model_of

    models = [model_of(variant.case) for variant in found]
    tasks = [[jobs[k] for k in group] for group in groups(models)]
    processes = min(processes or len(os.sched_getaffinity(0)), len(tasks))
    if processes == 1:
        for task in tasks:
            compute(task, report.ended)
    else:
        longest_first = sorted(tasks, key=len, reverse=True)
        work_off(longest_first, processes, compute, report.ended, report.lost)


def compute(jobs: list[Job], tell: Callable[[Ended], None]) -> None:
    """Compute variants that share factorisations, and write their folders."""
    with DeferredSignals():
        start_petsc()
        from ..simulation.analyses.run import Series

    series = Series()
    for job in jobs:
        ended = _computed(series, job)
        tell(ended)
        if ended.status == "interrupted":
            raise KeyboardInterrupt


def _computed(series, job: Job) -> Ended:
    from ..simulation.from_case import analysis_of, model_of, with_accurate_mesh
    from ..timer import Phases
    from .session import Recorder

    began, phases, summary = time.perf_counter(), Phases(), None
    problem: BaseException | None = None
    try:
        folder = ResultsFolder(job.path, job.tables, 1, overwrite=True)
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
        folder.close(_status(problem).partition(":")[0], _message(problem))
    except (CaseError, OSError) as error:  # of the folder; an interrupt still ends the sweep
        problem = problem if isinstance(problem, KeyboardInterrupt) else error
    return Ended(job.number, _status(problem), summary, time.perf_counter() - began)


def _status(problem: BaseException | None) -> str:
    if problem is None:
        return "done"
    if isinstance(problem, KeyboardInterrupt):
        return "interrupted"
    expected = isinstance(problem, CaseError | ComputationError)
    return f"failed: {problem}" if expected else f"failed: {type(problem).__name__}: {problem}"


def _message(problem: BaseException | None) -> str:
    """Message for the record of the run, with the traceback of unexpected errors."""
    if problem is None or isinstance(problem, CaseError | ComputationError | KeyboardInterrupt):
        return str(problem or "")
    return "".join(traceback.format_exception(problem))


class _Report:
    """Reporting of finished variants to the folder of the sweep and to the console."""

    def __init__(self, folder: SweepFolder, found: list[Variant]):
        self._folder = folder
        self._found = found
        self._console = Terminal(highlight=False)
        self._ended: dict[int, str] = {}
        self._began = time.perf_counter()

    def ended(self, ended: Ended) -> None:
        """Record a finished variant."""
        self._ended[ended.number] = ended.status
        self._folder.add(ended.number, ended.status, ended.summary, ended.seconds)
        self._console.print(
            f"{len(self._ended)}/{len(self._found)}   {self._name(ended.number)}   "
            f"{ended.status}, {ended.seconds:.3f} s",
            markup=False,
            soft_wrap=True,
        )

    def lost(self, jobs: list[Job], why: str) -> None:
        """Record variants whose process has died as failed."""
        for job in jobs:
            if job.number not in self._ended:
                self.ended(Ended(job.number, f"failed: {why}", None, 0.0))

    def failures(self) -> str:
        """Failures in one line; empty if all variants succeeded."""
        failed = {k: status for k, status in sorted(self._ended.items()) if status != "done"}
        if not failed:
            return ""
        first, status = next(iter(failed.items()))
        count = f"{len(failed)} of {len(self._found)} variants failed"
        return f"{count}; {self._name(first)}: {status.removeprefix('failed: ')}"

    def close(self, pictures: bool, status: str, message: str) -> None:
        """Record the end of the sweep, and draw its pictures."""
        self._folder.close(status, message, time.perf_counter() - self._began)
        if pictures and any(status == "done" for status in self._ended.values()):
            draw_sweep(self._folder.path)
        self._console.print(f"results in {self._folder.path}", markup=False, soft_wrap=True)

    def _name(self, number: int) -> str:
        values = self._found[number - 1].values
        return f"variant {number} ({', '.join(f'{k}={v}' for k, v in values.items())})"

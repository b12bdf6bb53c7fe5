"""A sweep: many variants of a case, those that share factors one after the other.

What needs dolfinx is imported where it is used: a process that only hands out work does without.
"""

from __future__ import annotations

import os
import time
import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import load
from ..case import Case, as_plain
from ..errors import CaseError, ComputationError
from ..output.console import Terminal
from ..output.folder import ResultsFolder
from ..output.sweep import SweepFolder, draw_sweep, swept
from .variants import Variant, parse_over, variants, written
from .workers import start_petsc, work_off

if TYPE_CHECKING:
    from ..simulation import Result


def sweep(
    case: Case | str | Path, over: Mapping[str, Sequence[Any]]
) -> list[tuple[dict[str, Any], Result | ComputationError]]:
    """Compute all combinations of values of keys of a case, in this process.

    Parameters
    ----------
    case : Case, str or Path
        Or the path of a case file.
    over : mapping of str to sequence
        Values by the path of their key, as in a case file: ``{"load.force": ["1 kN", "2 kN"]}``.

    Returns
    -------
    list of (dict, Result or ComputationError)
        The values by key, and what came out; in the place of a variant that failed, why it did.

    Raises
    ------
    CaseError
        If any variant is wrong; then none is computed.
    KeyboardInterrupt
        If a request to stop was noted during a variant; no further one is computed.
    """
    from ..simulation.analyses.sweep import Series, groups

    source = as_plain(case) if isinstance(case, Case) else case
    found = variants(source, {key: [written(v) for v in values] for key, values in over.items()})
    results: dict[int, Result | ComputationError] = {}
    for group in groups([variant.case for variant in found]):
        series = Series()
        for k in group:
            try:
                result = series.run(found[k].case)
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
    """A variant to be computed, by whichever process."""

    number: int
    case: Case
    path: Path

    def __reduce__(self):
        """Quantities belong to the unit registry of a process: another one reads them anew."""
        return _job, (self.number, as_plain(self.case), self.path)


def _job(number: int, tables: dict[str, Any], path: Path) -> Job:
    return Job(number, load(tables), path)


@dataclass(frozen=True)
class Ended:
    """How a variant ended: ``done``, or what went wrong; no summary where there is none."""

    number: int
    status: str
    summary: dict[str, Any] | None
    seconds: float


def run_sweep(chosen) -> int:
    """Compute the variants of a parsed ``sweep`` command.

    Raises
    ------
    CaseError
        If any variant is wrong; then none is computed.
    ComputationError
        If any of them failed; the others are computed and written out.
    """
    over = parse_over(chosen.over)
    found = variants(chosen.case, over, tuple(chosen.overrides))
    tables = [as_plain(variant.case) for variant in found]
    keys = [swept(key, [v.values[key] for v in found], tables) for key in over]
    path = chosen.output or Path("results") / f"{chosen.case.stem}-sweep"
    folder = SweepFolder(path, over, keys, chosen.overwrite)
    report = _Report(folder, found)
    jobs = [Job(v.number, v.case, folder.variant(v.number)) for v in found]
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
    """Groups that share nothing go to processes of their own, if there are several."""
    start_petsc()
    from ..simulation.analyses.sweep import groups

    tasks = [[jobs[k] for k in group] for group in groups([variant.case for variant in found])]
    processes = min(processes or len(os.sched_getaffinity(0)), len(tasks))
    if processes == 1:
        for task in tasks:
            compute(task, report.ended)
    else:
        longest_first = sorted(tasks, key=len, reverse=True)
        work_off(longest_first, processes, compute, report.ended, report.lost)


def compute(jobs: list[Job], tell: Callable[[Ended], None]) -> None:
    """Compute variants that share factors, and write their folders."""
    start_petsc()
    from ..simulation.analyses.sweep import Series

    series = Series()
    for job in jobs:
        ended = _computed(series, job)
        tell(ended)
        if ended.status == "interrupted":
            raise KeyboardInterrupt


def _computed(series, job: Job) -> Ended:
    from ..timer import Phases
    from .session import Recorder

    began, phases, summary = time.perf_counter(), Phases(), None
    problem: BaseException | None = None
    try:
        folder = ResultsFolder(job.path, as_plain(job.case), 1, overwrite=True)
        try:
            result = series.run(job.case, Recorder(series.comm, folder), phases)
            with phases("write"):
                folder.finish(result, phases.seconds)
            summary, problem = result.summary, result.stopped
        except BaseException as error:
            problem = error
        folder.close(_status(problem).partition(":")[0], _message(problem))
    except (CaseError, OSError) as error:  # the folder; an interrupt still ends the sweep
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
    """For the run's own record: where an error that nobody expected came from."""
    if problem is None or isinstance(problem, CaseError | ComputationError | KeyboardInterrupt):
        return str(problem or "")
    return "".join(traceback.format_exception(problem))


class _Report:
    """Passes what ends to the folder of the sweep and to the terminal."""

    def __init__(self, folder: SweepFolder, found: list[Variant]):
        self._folder = folder
        self._found = found
        self._console = Terminal(highlight=False)
        self._ended: dict[int, str] = {}
        self._began = time.perf_counter()

    def ended(self, ended: Ended) -> None:
        """A variant has ended."""
        self._ended[ended.number] = ended.status
        self._folder.add(ended.number, ended.status, ended.summary, ended.seconds)
        self._console.print(
            f"{len(self._ended)}/{len(self._found)}   {self._name(ended.number)}   "
            f"{ended.status}, {ended.seconds:.3f} s",
            markup=False,
            soft_wrap=True,
        )

    def lost(self, jobs: list[Job], why: str) -> None:
        """The process that computed some variants has died."""
        for job in jobs:
            if job.number not in self._ended:
                self.ended(Ended(job.number, f"failed: {why}", None, 0.0))

    def failures(self) -> str:
        """What went wrong, in one line; empty where nothing did."""
        failed = {k: status for k, status in sorted(self._ended.items()) if status != "done"}
        if not failed:
            return ""
        first, status = next(iter(failed.items()))
        count = f"{len(failed)} of {len(self._found)} variants failed"
        return f"{count}; {self._name(first)}: {status.removeprefix('failed: ')}"

    def close(self, pictures: bool, status: str, message: str) -> None:
        """Write down how it ended, and draw it."""
        self._folder.close(status, message, time.perf_counter() - self._began)
        if pictures and any(status == "done" for status in self._ended.values()):
            draw_sweep(self._folder.path)
        self._console.print(f"results in {self._folder.path}", markup=False, soft_wrap=True)

    def _name(self, number: int) -> str:
        values = self._found[number - 1].values
        return f"variant {number} ({', '.join(f'{k}={v}' for k, v in values.items())})"

"""Command ``calibrate``: a calibration, or the plan of one, with its folder and pictures."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from ... import load
from ...calibration.planning import Planned, expected
from ...calibration.solution import Calibration, solve
from ...case import AnyCase, as_plain
from ...errors import CaseError, UnwritableError
from ...output.calibration import CalibrationFolder, draw_calibration, write_calibration_report
from ...output.progress import PlainTable, Terminal
from ..batch.executors import Choice, Crew
from ..batch.reporting import checksum_of, resumable
from .calibrate import problem_of, record_of, record_of_plan, rows_of, runner

_PARALLEL = 1000
"""Number of runs that is worth the start of all processes."""


def run_calibration(chosen) -> int:
    """Calibrate the case of a parsed ``calibrate`` command, or plan its measurements.

    Raises
    ------
    CaseError, ComputationError
    """
    choice = Choice(chosen.executor, chosen.processes, chosen.scheduler)
    with choice.crew() as crew, resumable():
        return 0 if crew.serves else _run_with(crew, chosen)


def _run_with(crew: Crew, chosen) -> int:
    case = load(chosen.case, tuple(chosen.overrides))
    problem = problem_of(case, _data(chosen.data), chosen.plan)  # before a folder is cleared
    name = "plan" if chosen.plan else "calibration"
    path = chosen.output or Path("results") / f"{chosen.case.stem}-{name}"
    checksum = checksum_of([as_plain(case), chosen.plan, problem.data])
    folder = CalibrationFolder(path, as_plain(case), checksum, chosen.overwrite, chosen.resume)
    console = Terminal()
    if folder.complete:
        folder.close("done")
        console.print(f"{path}: is complete, nothing is left to compute", soft_wrap=True)
        return 0
    try:
        alone = chosen.executor == "processes" and chosen.processes is None
        workers = crew.workers(1, 1 if alone else _PARALLEL)
        runs = runner(workers.executor, workers.count, folder)
        if chosen.plan:
            _finish_plan(folder, console, expected(problem, runs))
        else:
            _finish(folder, console, case, solve(problem, runs))
        if chosen.pictures:
            for missing in draw_calibration(path):
                console.print(f"note: {missing}", soft_wrap=True)
    except CaseError:  # the results of a run do not have what was measured
        folder.abandon()
        raise
    except BaseException as error:
        interrupted = isinstance(error, KeyboardInterrupt)
        with suppress(UnwritableError):  # the disk may be the cause
            folder.close("interrupted" if interrupted else "failed", str(error))
        raise
    folder.close("done")
    if not chosen.plan:
        write_calibration_report(path)
    console.print(f"results in {path}", soft_wrap=True)
    return 0


def _data(given: list[str]) -> dict[str, Path] | Path | None:
    """Data files of the command line: ``FILE`` alone, or ``NAME=FILE`` each."""
    if len(given) == 1 and "=" not in given[0]:
        return Path(given[0])
    found = {}
    for text in given:
        name, equals, path = text.partition("=")
        if not equals:
            name, path = Path(text).stem, text
        if name in found:
            raise CaseError(f"--data {text}: {name} is given twice")
        found[name] = Path(path)
    return found


def _finish(
    folder: CalibrationFolder, console: Terminal, case: AnyCase, found: Calibration
) -> None:
    """Write and print a calibration."""
    fit = found.fit
    observed = fit.observations
    rows = rows_of(
        found.measurements,
        fit.predicted,
        found.deviations,
        fit.jacobian * observed.deviations[:, None],
        found.normal,
        found.table.confidence,
        fit.noise,
    )
    sample = None
    if found.posterior is not None:
        sample = list(found.table.parameters), found.posterior.values
    plain = {k: v for k, v in as_plain(case).items() if k not in ("calibrate", "study")}
    calibrated = as_plain(load(plain, found.overrides))
    record = record_of(found)
    folder.finish(record, rows, calibrated, sample)
    _print_parameters(console, record)
    console.print(
        f"{len(observed)} observations, reduced chi² {fit.reduced_chi2:.3g}; {found.runs} runs, "
        f"{found.seconds:.1f} s",
    )
    for text in found.notes():
        console.print(f"note: {text}", soft_wrap=True)


def _finish_plan(folder: CalibrationFolder, console: Terminal, found: Planned) -> None:
    """Write and print the accuracy to be expected of planned measurements."""
    record = record_of_plan(found, found.values)
    rows = rows_of(
        found.measurements,
        found.predicted,
        found.deviations,
        found.jacobian,
        found.design.complete.normal,
        found.table.confidence,
        found.noise,
    )
    folder.finish(record, rows)
    _print_parameters(console, record)
    names = list(found.table.parameters)
    shown = PlainTable("standard errors", *names)
    for what, each in (("only", found.design.alone), ("without", found.design.without)):
        for label, one in each.items() if len(each) > 1 else ():
            errors = zip(one.standard_errors, found.table.parameters.values(), strict=True)
            shown.add_row(f"{what} {label}", *(_error(e, p.scale == "log") for e, p in errors))
    if shown.row_count:
        console.print(shown)
    for text in found.notes():
        console.print(f"note: {text}", soft_wrap=True)


def _print_parameters(console: Terminal, record: dict[str, Any]) -> None:
    level = f"{100 * record['confidence']:g} % interval"
    shown = PlainTable("parameter", "value", level, "standard error")
    for name, one in record["parameters"].items():
        low, high = one["interval"]
        unit = f" {one['unit']}" if one["unit"] else ""
        shown.add_row(
            name,
            f"{one['value']:.6g}{unit}",
            f"{low:.5g} … {high:.5g}",
            _error(one["standard_error"], one["scale"] == "log"),
        )
    console.print(shown)


def _error(error: float, relative: bool) -> str:
    if not np.isfinite(error):
        return "not determined"
    return f"{100 * error:.3g} %" if relative else f"{error:.4g}"

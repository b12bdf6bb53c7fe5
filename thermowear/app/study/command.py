"""Command ``study``: computation, results folder, console."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ... import load
from ...case import as_plain
from ...errors import ComputationError
from ...output.progress import Terminal
from ...output.study import (
    StudyFolder,
    bands_file,
    draw_study,
    print_study,
    write_bands,
    write_quantiles,
    write_sobol,
    write_tornado,
)
from ..batch.executors import Choice, Crew, Workers
from ..batch.reporting import BatchReport, checksum_of
from .design import StudyEnd, checked_groups
from .study import Study, StudyPlan, evaluated

_INTERVAL = 2.0
"""Least time between two lines on the console [s]."""


def run_study(chosen) -> int:
    """Compute the study of a parsed ``study`` command.

    Raises
    ------
    CaseError
        If the case has no uncertain inputs, or any variant is invalid; then none is computed.
    ComputationError
        If any variant failed; the others are computed and evaluated.
    """
    with Choice(chosen.executor, chosen.processes, chosen.scheduler).crew() as crew:
        return 0 if crew.serves else _run_with(crew, chosen)


def _run_with(crew: Crew, chosen) -> int:
    case = load(chosen.case, tuple(chosen.overrides))
    plan = StudyPlan.of(case, chosen.calibration, chosen.indices)
    design = plan.design
    every = range(len(design.values))
    changes = [design.overrides(k) for k in every]
    checksum = checksum_of([plan.tables, changes, design.parts])
    path = chosen.output or Path("results") / f"{chosen.case.stem}-study"
    headers = ["part", *(column.header for column in design.columns)]
    cells: list[list[float | str]] = [
        [part, *map(float, row)] for part, row in zip(design.parts, design.si, strict=True)
    ]
    Terminal().print(f"checking {len(changes)} variants")
    groups = checked_groups(plan.tables, design, every)
    about = _about(plan)
    folder = StudyFolder(
        *(path, headers, cells, as_plain(case), about, checksum),
        *(chosen.overwrite, chosen.resume),
    )
    report = BatchReport(folder, lambda k: f"variant {k} ({', '.join(changes[k - 1])})", _INTERVAL)
    left = [[k for k in group if k + 1 not in folder.ended] for group in groups]
    left = [group for group in left if group]

    def received(end: StudyEnd) -> None:
        folder.add(end.number, end.status, end.numbers, end.curves, end.seconds)
        report.ended(end.number, end.status, end.seconds)

    def conclude() -> None:
        found = _evaluated(plan, folder)
        folder.announce_bands([bands_file(stem) for stem in found.bands.tables])
        _write(folder.path, found)
        problems = draw_study(folder.path) if chosen.pictures else []
        for note in (*design.notes, *found.bands.notes, *problems, *_failed(report)):
            report.say(f"note: {note}")
        print_study(report.console, folder.path)

    with report.closing(conclude, tolerant=True):
        count = sum(map(len, left))
        workers = crew.workers(len(left), count) if left else Workers(None)
        plan.compute(left, received, workers.executor, workers.count)
    if message := report.failures():
        raise ComputationError(message)
    return 0


def _failed(report: BatchReport) -> list[str]:
    message = report.failures()
    return [message] if message else []


def _evaluated(plan: StudyPlan, folder: StudyFolder) -> Study:
    done = {k: end for k, end in folder.ends.items() if end.status == "done"}
    numbers = {k: end.numbers for k, end in done.items()}
    return evaluated(plan.design, folder.ended, numbers, folder.curves)


def _about(plan: StudyPlan) -> dict[str, Any]:
    """Record of the study in ``run.json``."""
    table = plan.table.model_dump(exclude_none=True)
    units = {column.name: column.unit for column in plan.design.columns}
    return table | {"columns": units, "base": plan.design.base}


def _write(folder: Path, found: Study) -> None:
    """Write the tables of a study."""
    design, outputs = found.design, found.outputs
    write_quantiles(folder, outputs, found.quantiles)
    if found.indices is not None:
        write_sobol(folder, outputs, found.inputs, found.indices)
    lows, highs = design.swing_values
    headers = [column.header for column in design.columns]
    write_tornado(folder, outputs, headers, lows, highs, found.swings)
    write_bands(folder, found.bands.tables)

"""Run of a case from the command line, with results folder and pictures, on any number of ranks."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from .. import load
from ..case import Case, as_plain
from ..errors import CaseError, ComputationError, RunNote, UnwritableError
from ..output.checkpoint import CHECKPOINT
from ..output.console import print_discretisations, print_summary
from ..output.files import writing
from ..output.folder import ResultsFolder
from ..output.progress import ConsoleProgress, Terminal
from ..output.resuming import (
    ResumedFolder,
    about_checkpoint,
    is_finished,
    last_checkpoint,
    on_its_mesh,
)
from ..parallel import on_root
from ..results import Frame, HistoryRow, InterfaceFields, LoadRow
from ..serialise import Checkpoint, pack
from ..simulation import Observer, run
from ..simulation.analyses import run as analyses
from ..simulation.from_case import analysis_of, model_of, with_accurate_mesh
from ..simulation.runtime.observer import AnyRow, Saved
from ..timer import Phases

COMPARED = (
    "dofs_displacement",
    "contact_points",
    "max_pressure_Pa",
    "mean_pressure_Pa",
    "contact_area_m2",
    "approach_m",
    "shape_range_m",
    "max_temperature_K",
    "pressure_error_estimate_relative",
    "max_pressure_error_estimate_relative",
    "shape_error_estimate_relative",
    "temperature_error_estimate_relative",
)
"""Keys of the summary that are compared."""
_LOWEST, _HIGHEST = 1, 10


class Recorder(Observer):
    """Observer that writes to the results folder and to the console, on rank 0.

    With the case it also writes checkpoints.
    """

    def __init__(self, comm, folder, progress: ConsoleProgress | None = None, case=None):
        self._comm, self._folder, self._progress, self._case = comm, folder, progress, case
        self._steps = -1

    def phase(self, name: str) -> None:
        if self._progress is not None:
            self._progress.phase(name)

    def row(self, row: AnyRow, distance: float) -> None:
        self._steps += isinstance(row, HistoryRow | LoadRow)
        self._save(lambda: self._folder.add(row))
        if self._progress is not None:
            if isinstance(row, HistoryRow):
                self._progress.step(self._steps, row, distance)
            elif isinstance(row, LoadRow):
                self._progress.load_step(self._steps, row)

    def note(self, text: str) -> None:
        if self._progress is not None:
            self._progress.note(text)

    def output(
        self, time: float, interface: InterfaceFields, friction=None, track=None, contacts=None
    ) -> None:
        self._save(lambda: self._folder.output(time, interface, friction, track, contacts))

    def frame(self, frame: Frame) -> None:
        self._save(lambda: self._folder.frame(frame))

    def resumed(self, rows) -> None:
        if isinstance(rows[0] if rows else None, HistoryRow | LoadRow):
            self._steps = len(rows) - 1
        self._save(lambda: self._folder.restore(rows))

    def checkpoint(self, saved: Saved) -> None:
        if self._case is None:
            return
        packed, time = pack(self._comm, saved), saved.progress.time

        def write() -> None:
            assert packed is not None  # on rank 0
            about = about_checkpoint(self._case, time, packed.outlines)
            self._folder.checkpoint(about, packed.arrays)

        self._save(write)

    def _save(self, action) -> None:
        on_root(self._comm, lambda: _writing(action))


def run_session(chosen, comm, import_seconds: float) -> int:
    """Compute the case of a parsed ``run`` command. Every rank calls.

    Raises
    ------
    CaseError, ComputationError
        On all ranks.
    """
    case = on_root(comm, lambda: load(chosen.case, tuple(chosen.overrides)))
    path = chosen.output or Path("results") / chosen.case.stem
    plain = False if comm.size > 1 else None  # a launcher's pseudo-terminal is no real one
    console = Terminal(quiet=comm.rank != 0, force_terminal=plain)
    if chosen.resume:
        case = on_root(comm, lambda: on_its_mesh(path, case))
    if chosen.resume and on_root(comm, lambda: is_finished(path, case)):
        text = f"{path}: the run is complete, nothing is left to compute"
        console.print(text, soft_wrap=True)
        return 0
    saved = _saved(comm, path, case) if chosen.resume else None
    folder = _on_root_kept(comm, lambda: _folder(path, case, comm.size, chosen, saved))
    if chosen.resume:
        since = "the beginning" if saved is None else f"{saved.progress.time:g} s"
        console.print(f"resumed from {since}")
    try:
        with ConsoleProgress(console) as progress, _rendering(case, chosen, comm) as renderer:
            shown = progress if comm.rank == 0 else None
            recorder = Recorder(comm, folder, shown, case)
            phases = Phases(recorder.phase)
            phases.add("import", import_seconds)
            meshed = with_accurate_mesh(case, comm, recorder, phases)
            if meshed is not case:
                case = meshed
                on_root(comm, lambda: _writing(lambda: folder.describe(as_plain(case))))
                recorder = Recorder(comm, folder, shown, case)
            model, analysis = model_of(case), analysis_of(case)
            result = analyses.run(model, analysis, comm, recorder, phases, saved)
            if chosen.accuracy and result.stopped is None:
                with phases("coarser and finer"):
                    others = side_by_side(chosen.case, tuple(chosen.overrides), comm)
                result = replace(result, summary=result.summary | others)
            with phases("write"):
                on_root(comm, lambda: _writing(lambda: folder.finish(result, phases.seconds)))
            if chosen.pictures:
                with phases("pictures"):
                    on_root(comm, lambda: _writing(lambda: _draw(path, console, renderer)))
        print_summary(console, result.summary, phases.seconds)
        if chosen.accuracy and result.stopped is None:
            print_discretisations(console, result.summary, COMPARED)
        console.print(f"results in {path}")
        if result.stopped is not None:
            raise result.stopped
    except CaseError:  # found before computing: the folder must be free for the next attempt
        if folder is not None:
            _writing(folder.abandon)
        raise
    except BaseException as error:
        interrupted = isinstance(error, KeyboardInterrupt)
        with suppress(UnwritableError):  # the disk may be the cause
            _close(folder, "interrupted" if interrupted else "failed", str(error))
        if isinstance(error, UnwritableError) and (path / CHECKPOINT).is_file():
            room = "free disk space, then --resume continues from the last checkpoint"
            raise UnwritableError(f"{error}; {room}") from None
        raise
    _close(folder, "done")
    return 0


def _saved(comm, path: Path, case: Case) -> Saved | None:
    """State of the last checkpoint; None if the run starts from the beginning. Every rank calls."""
    found = on_root(comm, lambda: last_checkpoint(path, case, comm.size))
    if found is None:
        return None
    about, arrays = found
    return Checkpoint(about["outlines"], arrays).state(comm.rank)


def _folder(path: Path, case: Case, ranks: int, chosen, saved: Saved | None) -> ResultsFolder:
    """Results folder of a new run, or of a run resumed from a saved state."""
    if saved is None:
        return ResultsFolder(path, as_plain(case), ranks, chosen.overwrite or chosen.resume)
    return ResumedFolder(path, as_plain(case), ranks, saved.progress.time)


def _on_root_kept(comm, action):
    """Run an action on rank 0 as `on_root`, but return its result there only; None elsewhere."""
    kept = []
    on_root(comm, lambda: kept.append(action()))
    return kept[0] if kept else None


def _close(folder: ResultsFolder | None, status: str, message: str = "") -> None:
    if folder is not None:
        _writing(lambda: folder.close(status, message))


def _writing(action) -> None:
    """Run a writing action; an error of the disk becomes a failed computation."""
    with writing():
        action()


@contextmanager
def _rendering(case: Case, chosen, comm) -> Iterator[Any]:
    """Rendering process on rank 0 if pictures need one: ready when the case has been computed."""
    analysis = case.analysis
    waves = analysis.type == "stability" and (analysis.hot_spots or analysis.wave_lengths)
    if comm.rank != 0 or not chosen.pictures or not (case.model == "3d" or waves):
        yield None
        return
    from ..output.rendering import Renderer

    with Renderer() as renderer:
        renderer.start()
        yield renderer


def _draw(path: Path, console: Terminal, renderer) -> None:
    from ..output.pictures import make_pictures

    for problem in make_pictures(path, renderer):
        console.print(f"note: {problem}")


def neighbours(case: Case) -> dict[str, tuple[str, ...]]:
    """Overrides of a case for a coarser and a finer discretisation.

    One polynomial degree lower and higher, also of the pressure space if its degree is given; half
    and twice the number of elements at the limits of the degree.
    """
    return {"coarser": _changed(case, -1), "finer": _changed(case, 1)}


def _changed(case: Case, by: int) -> tuple[str, ...]:
    degree, given = case.mesh.degree + by, case.contact.pressure_degree
    if not _LOWEST <= degree <= _HIGHEST:
        elements = max(case.mesh.elements // 2, 1) if by < 0 else 2 * case.mesh.elements
        return (f"mesh.elements={elements}",)
    changes = [f"mesh.degree={degree}"]
    if isinstance(given, int):
        pressure_degree = min(max(given + by, _LOWEST), _HIGHEST)
        changes.append(f"contact.pressure_degree={pressure_degree}")
    return tuple(changes)


def side_by_side(path: Path, overrides: tuple[str, ...], comm) -> dict[str, dict[str, Any]]:
    """Compute the coarser and finer discretisations for the summary of a case. Every rank calls.

    If one of them cannot be computed, its entry contains the reason instead of numbers.
    """
    found: dict[str, dict[str, Any]] = {}
    for name, changes in neighbours(load(path, overrides)).items():
        entry: dict[str, Any] = {"changes": ", ".join(changes)}
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RunNote)  # those of the run itself are shown
                result = run(load(path, (*overrides, *changes)), comm)
            if result.stopped is not None:
                raise result.stopped
            entry |= {key: result.summary.get(key) for key in COMPARED}
        except (CaseError, ComputationError) as error:
            entry["failed"] = str(error)
        found[f"{name}_discretisation"] = entry
    return found

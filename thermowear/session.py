"""A run from the command line: case in, results folder and pictures out, on any number of ranks."""

from __future__ import annotations

from pathlib import Path

from . import load
from .case import as_plain
from .errors import CaseError, ComputationError
from .output.console import Progress, Terminal, print_summary
from .output.folder import ResultsFolder
from .parallel import on_root
from .simulation import CycleRow, HeatRow, HistoryRow, Interface, LoadRow, Observer, run
from .simulation.phases import Phases


class Recorder(Observer):
    """Passes what happens to the results folder and to a terminal, on rank 0."""

    def __init__(self, comm, folder, progress: Progress | None = None):
        self._comm = comm
        self._folder = folder
        self._progress = progress
        self._steps = -1

    def phase(self, name: str) -> None:
        if self._progress is not None:
            self._progress.phase(name)

    def step(self, row: HistoryRow, distance: float) -> None:
        self._steps += 1
        self._save(lambda: self._folder.step(row))
        if self._progress is not None:
            self._progress.step(self._steps, row, distance)

    def heat(self, row: HeatRow) -> None:
        self._save(lambda: self._folder.heat(row))

    def load_step(self, row: LoadRow) -> None:
        self._steps += 1
        self._save(lambda: self._folder.load_step(row))
        if self._progress is not None:
            self._progress.load_step(self._steps, row)

    def cycle(self, row: CycleRow) -> None:
        self._save(lambda: self._folder.cycle(row))

    def note(self, text: str) -> None:
        if self._progress is not None:
            self._progress.note(text)

    def output(self, time: float, interface: Interface, friction=None, track=None) -> None:
        self._save(lambda: self._folder.output(time, interface, friction, track))

    def _save(self, action) -> None:
        on_root(self._comm, lambda: _writing(action))


def run_session(chosen, comm, import_seconds: float) -> int:
    """Compute the case of a parsed ``run`` command; every rank calls.

    Raises
    ------
    CaseError, ComputationError
        On every rank alike.
    """
    case = on_root(comm, lambda: load(chosen.case, tuple(chosen.overrides)))
    path = chosen.output or Path("results") / chosen.case.stem
    folder = _on_root_kept(
        comm, lambda: ResultsFolder(path, as_plain(case), comm.size, chosen.overwrite)
    )
    plain = False if comm.size > 1 else None  # a launcher's pseudo-terminal ends in a file
    console = Terminal(highlight=False, quiet=comm.rank != 0, force_terminal=plain)
    try:
        with Progress(console) as progress:
            recorder = Recorder(comm, folder, progress if comm.rank == 0 else None)
            phases = Phases(recorder.phase)
            phases.add("import", import_seconds)
            result = run(case, comm, recorder, phases)
            with phases("write"):
                on_root(comm, lambda: _writing(lambda: folder.finish(result, phases.seconds)))
            if chosen.pictures:
                with phases("pictures"):
                    on_root(comm, lambda: _writing(lambda: _draw(path, console)))
        print_summary(console, result.summary, phases.seconds)
        console.print(f"results in {path}")
        if result.stopped is not None:
            raise result.stopped
    except CaseError:  # found while meshing: nothing was computed, and the next try needs the place
        if folder is not None:
            _writing(folder.abandon)
        raise
    except BaseException as error:
        interrupted = isinstance(error, KeyboardInterrupt)
        _close(folder, "interrupted" if interrupted else "failed", str(error))
        raise
    _close(folder, "done")
    return 0


def _on_root_kept(comm, action):
    """Like `on_root`, but the result stays on rank 0; None elsewhere."""
    kept = []
    on_root(comm, lambda: kept.append(action()))
    return kept[0] if kept else None


def _close(folder: ResultsFolder | None, status: str, message: str = "") -> None:
    if folder is not None:
        _writing(lambda: folder.close(status, message))


def _writing(action) -> None:
    """Turn a disk that does not take the results into a failed computation."""
    try:
        action()
    except OSError as error:
        raise ComputationError(f"results cannot be written: {error}") from None


def _draw(path: Path, console: Terminal) -> None:
    from .output.pictures import make_pictures

    for problem in make_pictures(path):
        console.print(f"note: {problem}")

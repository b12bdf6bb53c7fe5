"""Process that draws with VTK, seen from the program, and its jobs."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import traceback
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryFile
from threading import Event, Timer
from typing import NamedTuple

from .display import ending_with_parent

WARM_UP = ("warm up", ())
"""Kind and arguments of a drawing that loads what all others need."""
_DRAWN_BY = {
    WARM_UP[0]: ("in_space.solids", "warm_up"),
    "bodies": ("bodies", "draw_bodies"),
    "hot spots": ("in_space.hot_spot_views", "draw_views"),
    "animation": ("animation", "draw_animation"),
    "mesh": ("in_space.mesh", "draw_mesh"),
    "contacts": ("from_tables", "draw_other_contacts"),
}
"""Module of the pictures, imported only where it draws, and function of each kind."""


class PictureJob(NamedTuple):
    """Pictures of one kind.

    Attributes
    ----------
    kind : str
    arguments : tuple of (str or float)
        Absolute paths as strings, and numbers.
    in_space : bool
        True for pictures that need VTK.
    timeout : float
        Time after which drawing is given up [s].
    apart : bool
        True for pictures drawn in another process though they need no VTK.
    """

    kind: str
    arguments: tuple[str | float, ...]
    in_space: bool = True
    timeout: float = 180.0
    apart: bool = False


def attempt(kind: str, arguments: tuple[str | float, ...]) -> str:
    """Draw pictures in this process; returns the reason of a failure, empty on success."""
    module, function = _DRAWN_BY[kind]
    try:
        draw = getattr(import_module(f"...pictures.{module}", __name__), function)
        draw(*(Path(each) if isinstance(each, str) else each for each in arguments))
    except Exception as error:
        return traceback.format_exception_only(error)[-1].strip().splitlines()[-1]
    return ""


_MODULE = __package__
_ROOT = Path(__file__).parents[3]
_RANK = ("OMPI_", "PMIX_", "PRTE_", "PMI_")
"""Beginnings of the variables of a rank of a parallel run, which the process is not."""
_PATIENCE = 5.0  # time for the process to end when it is told to [s]


class Renderer:
    """Process for all pictures that need VTK; a context manager at whose end it ends.

    It may be started before there is anything to draw, to be ready then, and draws while its
    caller does something else. A crash costs the pictures being drawn; those after them get a
    new process. It ends with its parent, too.
    """

    def __init__(self) -> None:
        self._process: subprocess.Popen[str] | None = None
        self._jobs: list[PictureJob] = []
        self._refused = ""

    def __enter__(self) -> Renderer:
        self._said = TemporaryFile()  # what it and its libraries print; a pipe might fill up
        return self

    def __exit__(self, *_) -> None:
        self._end()
        self._said.close()

    def start(self) -> None:
        """Start the process unless it runs; jobs hear why if it cannot be started."""
        if self._process is not None and self._process.poll() is not None:
            self._end()
        if self._process is not None:
            return
        try:
            self._process = subprocess.Popen(
                [*ending_with_parent(), sys.executable, "-m", _MODULE],
                env=_environment(),
                cwd=_ROOT,  # no modules or settings from the current folder
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._said,
                text=True,
                start_new_session=True,  # Ctrl-C stops the run, and what it has is drawn
            )
        except OSError as error:
            self._refused = str(error)

    def begin(self, jobs: Sequence[PictureJob]) -> None:
        """Let jobs be drawn in turn."""
        self._jobs = list(jobs)
        if jobs:
            self.start()
            self._send()

    def reasons(self) -> list[str]:
        """Wait for all jobs; returns the reason of the failure of each, empty on success."""
        found = []
        while self._jobs:
            job = self._jobs.pop(0)
            found.append(self._refused if self._process is None else self._answer(job))
            if self._jobs and self._process is None:
                self.begin(self._jobs)
        return found

    def _send(self) -> None:
        if self._process is not None and self._process.stdin is not None:
            with suppress(BrokenPipeError):  # found again when the answer is read
                for job in self._jobs:
                    self._process.stdin.write(
                        json.dumps((job.kind, job.arguments, job.in_space)) + "\n"
                    )
                self._process.stdin.flush()

    def _answer(self, job: PictureJob) -> str:
        """Answer of the process to a job, or how it ended instead."""
        process = self._process
        assert process is not None
        assert process.stdout is not None
        late = Event()  # set before the kill: the thread may outlive the answer that it ends

        def give_up() -> None:
            late.set()
            process.kill()

        watch = Timer(job.timeout, give_up)
        watch.daemon = True
        watch.start()
        try:
            line = process.stdout.readline()
        finally:
            watch.cancel()
        if line:
            return str(json.loads(line))
        code = process.wait()
        self._end()
        return f"not done after {job.timeout:g} s" if late.is_set() else self._last_words(code)

    def _last_words(self, code: int) -> str:
        """End of the process in words, with the last line that it printed."""
        ended = f"ended by {signal.Signals(-code).name}" if code < 0 else f"exit code {code}"
        self._said.seek(0)
        lines = self._said.read().decode(errors="replace").split("\n")
        last = next((line.strip() for line in reversed(lines) if line.strip()), "")
        return f"{ended}: {last}" if last else ended

    def _end(self) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        process.terminate()
        try:
            process.wait(_PATIENCE)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        for pipe in (process.stdin, process.stdout):
            with suppress(BrokenPipeError):
                if pipe is not None:
                    pipe.close()


def _environment() -> dict[str, str]:
    """Environment of the process."""
    path = os.pathsep.join(filter(None, [str(_ROOT), os.environ.get("PYTHONPATH")]))
    kept = {name: value for name, value in os.environ.items() if not name.startswith(_RANK)}
    return kept | {"PYTHONPATH": path, "PYVISTA_OFF_SCREEN": "true"}

"""Reporting of the variants of a command as they end: folder, console, and its exit."""

from __future__ import annotations

import hashlib
import json
import time
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from ...errors import CaseError, ComputationError, UnwritableError
from ...output.files import writing
from ...output.progress import Terminal
from ...output.variants.folder import VariantsFolder


class BatchReport:
    """Reporting of finished variants to the console, and of the end of the command to its folder.

    Parameters
    ----------
    folder : VariantsFolder
    named : callable
        Name of a variant by its number.
    interval : float
        Least time between two lines on successful variants [s].
    """

    def __init__(self, folder: VariantsFolder, named: Callable[[int], str], interval: float = 0.0):
        self._folder, self._named, self._interval = folder, named, interval
        self.console = Terminal()
        self._began = time.perf_counter()
        self._printed = -interval

    def ended(self, number: int, status: str, seconds: float) -> None:
        """Print a line on a variant that has ended."""
        count, now = len(self._folder.ended), time.perf_counter()
        waits = status == "done" and now - self._printed < self._interval
        if waits and count < self._folder.count:
            return
        self._printed = now
        self.say(
            f"{count}/{self._folder.count}   {self._named(number)}   {status}, {seconds:.3f} s"
        )

    def say(self, text: str) -> None:
        """Print a line as it is."""
        self.console.print(text, soft_wrap=True)

    def failures(self) -> str:
        """Failures in one line; empty if all variants succeeded."""
        failed = {k: status for k, status in sorted(self._folder.ended.items()) if status != "done"}
        if not failed:
            return ""
        first, status = next(iter(failed.items()))
        count = f"{len(failed)} of {self._folder.count} variants failed"
        return f"{count}; {self._named(first)}: {status.removeprefix('failed: ')}"

    @contextmanager
    def closing(self, conclude: Callable[[], object], tolerant: bool = False) -> Iterator[None]:
        """Record how the command ended, and write what follows from its variants.

        Parameters
        ----------
        conclude : callable
            Draws and writes; called if any variant succeeded, of an interrupted command, too.
        tolerant : bool
            A record of failed variants among others is that of a complete command.
        """
        status, message = "done", ""
        with resumable():
            try:
                yield
                message = self.failures()
                every = set(self._folder.ended.values())
                if message and not (tolerant and "done" in every):
                    status = "failed"
            except BaseException as error:
                status = "interrupted" if isinstance(error, KeyboardInterrupt) else "failed"
                message = str(error)
                raise
            finally:
                self._folder.close(status, message, time.perf_counter() - self._began)
                if any(each == "done" for each in self._folder.ended.values()):
                    with writing():
                        conclude()
                self.say(f"results in {self._folder.path}")


@contextmanager
def resumable() -> Iterator[None]:
    """Tell how a command goes on whose results could not be written."""
    try:
        yield
    except UnwritableError as error:
        raise UnwritableError(f"{error}; mend this, then --resume goes on from here") from None


def checksum_of(content: Sequence[Any]) -> str:
    """Checksum of cases or other plain values."""
    text = json.dumps(content, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()


def status_of(problem: BaseException | None) -> str:
    """Status of a variant: ``done``, ``interrupted``, or a description of the failure.

    Raises
    ------
    UnwritableError
        If it is one, or an error of a file: its own computation has not failed.
    """
    if isinstance(problem, UnwritableError):
        raise problem
    if isinstance(problem, OSError):
        raise UnwritableError.during_run(problem) from None
    if problem is None:
        return "done"
    if isinstance(problem, KeyboardInterrupt):
        return "interrupted"
    expected = isinstance(problem, CaseError | ComputationError)
    return f"failed: {problem}" if expected else f"failed: {type(problem).__name__}: {problem}"


def message_of(problem: BaseException | None) -> str:
    """Message for the record of a run, with the traceback of unexpected errors."""
    if problem is None or isinstance(problem, CaseError | ComputationError | KeyboardInterrupt):
        return str(problem or "")
    return "".join(traceback.format_exception(problem))

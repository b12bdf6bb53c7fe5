"""Exceptions of failed runs with their exit codes, notes, and shortening of messages."""

from __future__ import annotations

import logging
import warnings
from typing import Any

MOST_FAULTS = 50
"""Largest number of lines reported for one case file."""
_LONGEST = 1100  # characters of a line: the longest list of allowed words has about 1000


def other_mesh(path: str | None) -> str:
    """Error message for a run resumed with a mesh file of other content."""
    return (
        f"--resume: geometry.path: the mesh in {path} differs from that of the run; name "
        "the file with that mesh, or start anew with --overwrite"
    )


class CaseError(Exception):
    """Invalid input of the user (exit code 1).

    Parameters
    ----------
    faults : list of str
        One line per fault, each starting with the key's path; only the first `MOST_FAULTS` are
        kept.
    more : int
        Number of further faults.
    """

    exit_code = 1

    def __init__(self, *faults: str, more: int = 0):
        more += len(faults[MOST_FAULTS:])
        self.faults = [shortened(fault, _LONGEST) for fault in faults[:MOST_FAULTS]]
        if more:
            self.faults.append(f"and {more} further faults")
        super().__init__("\n".join(self.faults))


class ComputationError(Exception):
    """Failed computation (exit code 2)."""

    exit_code = 2


class StandstillError(ComputationError):
    """Time integration that comes to a standstill before its end."""


class UnwritableError(ComputationError):
    """Results cannot be written any more, as a disk is full or not available.

    It ends a command on many runs, as it is no outcome of the run that it happens to.
    """

    @classmethod
    def during_run(cls, error: OSError) -> UnwritableError:
        """Error by a file that a run needs."""
        return cls(f"a file cannot be read or written: {error}")


class CaseNote(UserWarning):
    """Warning about valid but unusual input of a case; printed by the command line."""


class RunNote(CaseNote):
    """Warning about a result; notes of runs without an observer of their own."""


def note(text: str) -> None:
    """Warn about unusual input of a case, attributed to the caller of the calling function."""
    _release_warnings()
    warnings.warn(CaseNote(text), stacklevel=3)


def run_note(text: str) -> None:
    """Warn about a result, in runs that nothing observes."""
    _release_warnings()
    warnings.warn(RunNote(text), stacklevel=3)


def _release_warnings() -> None:
    """Show warnings again after ffcx, at its import, has sent them to a logger without handlers."""
    if getattr(warnings.showwarning, "__module__", "") != logging.__name__:
        return
    handlers = (*logging.getLogger("py.warnings").handlers, *logging.getLogger().handlers)
    if all(isinstance(handler, logging.NullHandler) for handler in handlers):
        logging.captureWarnings(False)


def quoted(value: Any) -> str:
    """Representation of a user's value in messages: its ``repr``, shortened if long."""
    return shortened(repr(value), 100)


def shortened(text: str, most: int) -> str:
    """Shorten a text to about `most` characters by leaving out its middle."""
    if len(text) <= most:
        return text
    end = most // 3
    left_out = len(text) - most
    return f"{text[: most - end]} … {left_out} characters left out … {text[-end:]}"


def percent(part: float) -> str:
    """Fraction as text, with two digits: 0.086 as "8.6 %", 1.41 as "140 %"."""
    return f"{float(f'{100 * part:.2g}'):.12g} %"

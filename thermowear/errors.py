"""The two ways a run can fail, the exit codes that go with them, and how messages stay short."""

from __future__ import annotations

import warnings
from typing import Any

MOST_FAULTS = 50
"""Lines about one case: a file that is wrong all over needs no more of them."""
_LONGEST = 1000  # characters of a line: the longest list of allowed words has about 600


class CaseError(Exception):
    """What the user wrote cannot be run (exit code 1).

    Parameters
    ----------
    faults : list of str
        One line per fault, each starting with the key's path; of many the first `MOST_FAULTS` are
        kept.
    more : int
        Faults besides.
    """

    exit_code = 1

    def __init__(self, *faults: str, more: int = 0):
        more += len(faults[MOST_FAULTS:])
        self.faults = [shortened(fault, _LONGEST) for fault in faults[:MOST_FAULTS]]
        if more:
            self.faults.append(f"and {more} further faults")
        super().__init__("\n".join(self.faults))


class ComputationError(Exception):
    """The computation did not reach an answer (exit code 2)."""

    exit_code = 2


class UnwritableError(ComputationError):
    """Results cannot be written any more: a disk is full, or gone."""


class CaseNote(UserWarning):
    """What is legal in a case, and still odd enough to be said; the command line prints it."""


def note(text: str) -> None:
    """Warn of what is odd about a case, in the name of the caller."""
    warnings.warn(CaseNote(text), stacklevel=3)


def quoted(value: Any) -> str:
    """A value of the user as messages show it: as Python writes it, a long one shortened."""
    return shortened(repr(value), 100)


def shortened(text: str, most: int) -> str:
    """Text of at most about `most` characters: of a longer one the middle is left out."""
    if len(text) <= most:
        return text
    end = most // 3
    left_out = len(text) - most
    return f"{text[: most - end]} … {left_out} characters left out … {text[-end:]}"

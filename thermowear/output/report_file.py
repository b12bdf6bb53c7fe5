"""Atomic writing of a report, never over a file of other origin."""

from __future__ import annotations

import os
import re
from pathlib import Path

from ..errors import CaseError

_GENERATOR = re.compile(rb'<meta name="generator" content="thermowear"')
_HEAD = 1000  # bytes at the beginning of a report that contain its generator tag


def is_report(path: Path) -> bool:
    """Test whether a file is a report written by this program."""
    try:
        with path.open("rb") as file:
            return _GENERATOR.search(file.read(_HEAD)) is not None
    except OSError:
        return False


def put(path: Path, page: str) -> None:
    """Write a page to a draft and rename it, so that readers never see a partial page.

    Raises
    ------
    CaseError
        If another file has that name, or the page cannot be written.
    """
    if os.path.lexists(path) and not is_report(path):
        raise CaseError(
            f"{path}: exists and is not a report of this program; move it away or rename it"
        )
    draft = path.with_name(f".{path.name}.part")
    try:
        draft.write_text(page, encoding="utf-8")
        os.replace(draft, path)
    except OSError as error:
        raise CaseError(f"{path}: cannot be written: {error.strerror}") from None

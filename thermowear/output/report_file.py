"""Where a report is written: never over a file of someone else's, never half."""

from __future__ import annotations

import os
import re
from pathlib import Path

from ..errors import CaseError

_GENERATOR = re.compile(rb'<meta name="generator" content="thermowear"')
_HEAD = 1000  # bytes within which a report names its generator


def is_report(path: Path) -> bool:
    """Whether a file is a report that this program wrote."""
    try:
        with path.open("rb") as file:
            return _GENERATOR.search(file.read(_HEAD)) is not None
    except OSError:
        return False


def put(path: Path, page: str) -> None:
    """Write beside and rename, so that a reader never sees half a page.

    Raises
    ------
    CaseError
        If something else is there, or nothing can be written.
    """
    if os.path.lexists(path) and not is_report(path):
        raise CaseError(
            f"{path}: exists and is no report of this program; move it away or rename it"
        )
    draft = path.with_name(f".{path.name}.part")
    try:
        draft.write_text(page, encoding="utf-8")
        os.replace(draft, path)
    except OSError as error:
        raise CaseError(f"{path}: cannot be written: {error.strerror}") from None

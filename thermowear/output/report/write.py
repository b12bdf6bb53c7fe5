"""Writing of ``report.html`` from a results folder."""

from __future__ import annotations

import os
import re
from pathlib import Path

from ...errors import CaseError
from ..atomic_write import write_text
from ..names import is_report
from .contents import ReportContents, read_contents
from .unit_format import NOTHING

_UNPRINTABLE = re.compile("[^\t\n\x20-\x7e\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def write_report(folder: Path) -> Path:
    """Write ``report.html``, one file with embedded pictures and style.

    Parameters
    ----------
    folder : Path
        Results of a run, finished or not.

    Returns
    -------
    Path
        Path of the report.

    Raises
    ------
    CaseError
        If the folder has no results or a ``report.html`` of other origin, or cannot be written.
    """
    path = folder / "report.html"
    text = page(read_contents(folder))
    if os.path.lexists(path) and not is_report(path):
        raise CaseError(
            f"{path}: exists and is not a report of this program; move it away or rename it"
        )
    try:
        write_text(path, text)
    except OSError as error:
        raise CaseError(f"{path}: cannot be written: {error.strerror}") from None
    return path


def page(contents: ReportContents) -> str:
    """Render the contents as HTML; all text is escaped."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader(__package__, "."),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=_printable,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("report.html").render(report=contents)


def _printable(value: object) -> object:
    """Text without characters that are invalid in HTML; a dash for None."""
    if value is None:
        return NOTHING
    return _UNPRINTABLE.sub("\ufffd", value) if type(value) is str else value

"""From a results folder to its ``report.html``."""

from __future__ import annotations

import re
from pathlib import Path

from ..report_file import put
from .contents import Contents, read_contents
from .engineering import NOTHING

_UNPRINTABLE = re.compile("[^\t\n\x20-\x7e\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def write_report(folder: Path) -> Path:
    """Write ``report.html``: one file, with its pictures and its style within.

    Parameters
    ----------
    folder : Path
        Results of a run, finished or not.

    Returns
    -------
    Path
        Of the report.

    Raises
    ------
    CaseError
        If the folder holds no results, or a ``report.html`` that is not of this program.
    """
    path = folder / "report.html"
    put(path, page(read_contents(folder)))
    return path


def page(contents: Contents) -> str:
    """The contents as HTML; all text is escaped."""
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
    """Text without what no page may hold; a dash for None."""
    if value is None:
        return NOTHING
    return _UNPRINTABLE.sub("\ufffd", value) if type(value) is str else value

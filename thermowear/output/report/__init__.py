"""One page for the mail: ``report.html``, made from the files of a results folder alone."""

from ..report_file import is_report
from .write import write_report

__all__ = ["is_report", "write_report"]

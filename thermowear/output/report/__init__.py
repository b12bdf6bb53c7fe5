"""``report.html``: a self-contained page made from the files of a results folder."""

from ..files import is_report
from .contents import write_report

"""The analyses: initial contact, steady state, running-in."""

from .result import BodyFields, HistoryRow, Interface, Result
from .run import Observer, run

__all__ = ["BodyFields", "HistoryRow", "Interface", "Observer", "Result", "run"]

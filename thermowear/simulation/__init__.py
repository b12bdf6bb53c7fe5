"""The analyses: initial contact, steady state, running-in, fretting."""

from .observer import Observer
from .result import BodyFields, FrictionInterface, HistoryRow, Interface, LoadRow, Result
from .run import run

__all__ = [
    "BodyFields",
    "FrictionInterface",
    "HistoryRow",
    "Interface",
    "LoadRow",
    "Observer",
    "Result",
    "run",
]

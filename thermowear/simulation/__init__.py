"""The analyses: initial contact, steady state, running-in, fretting."""

from .observer import Observer
from .result import BodyFields, Frame, FrictionInterface, Interface, Result, WornTrack
from .rows import CycleRow, HeatRow, HistoryRow, LoadRow
from .run import run

__all__ = [
    "BodyFields",
    "CycleRow",
    "Frame",
    "FrictionInterface",
    "HeatRow",
    "HistoryRow",
    "Interface",
    "LoadRow",
    "Observer",
    "Result",
    "WornTrack",
    "run",
]

"""Simulation: initial contact, steady state, transient, fretting, reciprocating, stability."""

from .analyses.run import run
from .results.result import BodyFields, Frame, FrictionInterface, Interface, Result, WornTrack
from .results.rows import CycleRow, HeatRow, HistoryRow, LoadRow
from .runtime.observer import Observer

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

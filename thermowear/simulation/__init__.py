"""Simulation: initial contact, steady state, transient, fretting, reciprocating, stability."""

from .from_case import run
from .results.result import BodyFields, Frame, FrictionInterface, InterfaceFields, Result, WornTrack
from .results.rows import CycleRow, HeatRow, HistoryRow, LoadRow
from .runtime.observer import Observer

__all__ = [
    "BodyFields",
    "CycleRow",
    "Frame",
    "FrictionInterface",
    "HeatRow",
    "HistoryRow",
    "InterfaceFields",
    "LoadRow",
    "Observer",
    "Result",
    "WornTrack",
    "run",
]

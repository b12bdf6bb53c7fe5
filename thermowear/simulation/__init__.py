"""Simulation: initial contact, steady state, transient, fretting, reciprocating, stability."""

from ..results import (
    BodyFields,
    CycleRow,
    Frame,
    FrictionInterface,
    HeatRow,
    HistoryRow,
    Interface,
    LoadRow,
    Result,
    WornTrack,
)
from .analyses.run import run
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

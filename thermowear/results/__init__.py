"""Results of a run: tables and summary, and the name, label and unit of each quantity."""

from .points import FrictionInterface, Interface, Modes, Profile, WornTrack
from .quantity import TABLES, Quantity, Table, from_key, table_of, unknown
from .result import FIELDS, BodyFields, Frame, FrictionHistory, Result, TrackHistory
from .rows import CycleRow, HeatRow, HistoryRow, LoadRow
from .summary_keys import GROUPS, OTHER, PHASES, group_of, of_key

__all__ = [
    "FIELDS",
    "GROUPS",
    "OTHER",
    "PHASES",
    "TABLES",
    "BodyFields",
    "CycleRow",
    "Frame",
    "FrictionHistory",
    "FrictionInterface",
    "HeatRow",
    "HistoryRow",
    "Interface",
    "LoadRow",
    "Modes",
    "Profile",
    "Quantity",
    "Result",
    "Table",
    "TrackHistory",
    "WornTrack",
    "from_key",
    "group_of",
    "of_key",
    "table_of",
    "unknown",
]

"""Results of a run: tables and summary, and the name, label and unit of each quantity."""

from .hot_spots import GrowthRow, HotSpotFields, HotSpotMode, HotSpotRow
from .points import FrictionInterface, InterfaceFields, Modes, Profile, WornTrack
from .quantity import TABLES
from .result import (
    FIELDS,
    AnyFields,
    BodyFields,
    Frame,
    FrictionHistory,
    HotSpots,
    MixedFields,
    Result,
    TrackHistory,
)
from .rows import (
    ContactRow,
    CycleRow,
    HeatRow,
    HistoryRow,
    HolderRow,
    LoadRow,
    ProbeRow,
    StickRow,
    TangentialRow,
)

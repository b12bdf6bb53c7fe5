"""Rows of the tables that grow on the way."""

from __future__ import annotations

from dataclasses import dataclass

from ...serialise import serialisable_row


@serialisable_row
@dataclass(frozen=True)
class HistoryRow:
    """A step of a running-in; names and units are those of ``history.csv``."""

    time: float
    sliding_distance: float
    max_pressure: float
    contact_area: float
    wear_volume_1: float
    wear_volume_2: float
    max_temperature: float
    approach: float
    step: float
    error: float


@serialisable_row
@dataclass(frozen=True)
class HeatRow:
    """A step of an analysis in which temperatures are followed in time.

    Names and units are those of ``heat.csv``. Heat is counted from the start on; temperatures are
    those of the faces, means are taken over their area.
    """

    time: float
    speed: float
    normal_force: float
    friction_power: float
    heat_in: float
    heat_stored: float
    heat_lost: float
    balance_error: float
    max_temperature_1: float
    max_temperature_2: float
    mean_temperature_1: float
    mean_temperature_2: float


@serialisable_row
@dataclass(frozen=True)
class LoadRow:
    """An increment of a history of loads; names and units are those of ``loads.csv``."""

    time: float
    normal_force: float
    approach: float
    tangential_force: float
    tangential_displacement: float
    max_pressure: float
    contact_area: float
    stick_area: float
    dissipated: float
    iterations: int
    cycle: int
    wear_volume_1: float
    wear_volume_2: float


@serialisable_row
@dataclass(frozen=True)
class CycleRow:
    """A cycle of a history of loads at its end; names and units are those of ``cycles.csv``.

    Area and largest pressure are those of the whole cycle. It ends a jump over so many cycles,
    whose error is relative to the largest depth worn; NaN where it was not estimated.
    """

    cycle: int
    time: float
    wear_volume_1: float
    wear_volume_2: float
    dissipated: float
    max_wear_1: float
    max_wear_2: float
    contact_area: float
    max_pressure: float
    jump: int
    error: float

"""Rows of the history tables that grow during a run."""

from __future__ import annotations

from dataclasses import dataclass

from ...serialise import serialisable_row


@serialisable_row
@dataclass(frozen=True)
class HistoryRow:
    """Step of a running-in; names and units as in ``history.csv``."""

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
    """Step of an analysis with transient conduction.

    Names and units as in ``heat.csv``. Heat is cumulated from the start; temperatures are those of
    the faces, means are taken over their area.
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
    """Increment of a load history; names and units as in ``loads.csv``."""

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
    """Cycle of a load history at its end; names and units as in ``cycles.csv``.

    Area and largest pressure are those of the whole cycle. ``jump`` is the length in cycles of the
    cycle jump that it ends, ``error`` relative to the largest wear depth; NaN if not estimated.
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

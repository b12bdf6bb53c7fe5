"""Experiments: runs of a case under the conditions of the measurements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..case import AnyCase, as_plain, load
from ..case.studies.calibration import CalibrationTable
from ..case.tables.analyses import Fretting, Timed
from ..errors import CaseError
from .measurement import Measurement

_OTHER = ("calibrate", "study", "title")
_EQUAL = 1e-9
"""Relative difference of times that are hit by one step."""
_STEADY = ("distance_from_steady", "rigid_wear_")
"""Numbers of the summary that refer to the steady state."""


@dataclass(frozen=True)
class Experiment:
    """Run that predicts the measurements made under the same conditions.

    Attributes
    ----------
    tables : dict
        Case as plain tables, with the conditions of the measurements.
    measurements : tuple of Measurement
    times : tuple of float
        Times that the steps hit exactly [s].
    located : bool
        False until the times of all sliding distances are known.
    smooth : bool
        False if runs choose cycle jumps of their own, even with equal time steps.
    rows : ndarray of int or None, shape (count,)
        Indices of its values among those of all measurements; by default they follow those of the
        experiments before it.
    """

    tables: dict[str, Any]
    measurements: tuple[Measurement, ...]
    times: tuple[float, ...] = ()
    located: bool = True
    smooth: bool = True
    rows: np.ndarray | None = None

    @property
    def count(self) -> int:
        """Number of measured values."""
        return sum(len(one.values) for one in self.measurements)

    @property
    def described(self) -> str:
        """Conditions that differ from those of the case, as the end of a sentence."""
        conditions = ", ".join(self.measurements[0].conditions)
        return f" with {conditions}" if conditions else ""

    def case(self, overrides: tuple[str, ...]) -> AnyCase:
        """Case with values of the parameters.

        Raises
        ------
        CaseError
        """
        return load(self.tables, overrides)

    def ends_with_times(self) -> bool:
        """Test whether nothing is measured at the end of the run, but all at given times."""
        timed = ({"time", "sliding_distance"} & m.reading.at.keys() for m in self.measurements)
        return self.located and len(self.times) > 0 and all(timed)

    def compares_with_steady(self) -> bool:
        """Test whether a measured quantity refers to the steady state that a run approaches."""
        names = (one.reading.name.rpartition(".")[2] for one in self.measurements)
        return any(name.startswith(_STEADY) for name in names)

    def at_distances(self, time: np.ndarray, distance: np.ndarray) -> Experiment:
        """Experiment whose steps hit the measured sliding distances, too.

        Parameters
        ----------
        time, distance : ndarray
            Rows of a run with the same motion [s, m].
        """
        wanted = [m.reading.at.get("sliding_distance", np.zeros(0)) for m in self.measurements]
        found = np.interp(np.concatenate(wanted), distance, time)  # exact at a constant speed
        found[np.isclose(found, time[-1], rtol=_EQUAL, atol=0.0)] = time[-1]
        times = _distinct([*self.times, *map(float, found)])
        return replace(self, times=times, located=True)


def experiments(case: AnyCase, measurements: Sequence[Measurement]) -> list[Experiment]:
    """Experiments of a case, one for the measurements of equal conditions, ordered by these.

    Raises
    ------
    CaseError
        If the conditions or the times do not fit the case.
    """
    tables = {key: table for key, table in as_plain(case).items() if key not in _OTHER}
    ends = np.cumsum([0, *(len(one.values) for one in measurements)])
    groups: dict[tuple[str, ...], list[int]] = {}
    for k, one in enumerate(measurements):
        groups.setdefault(one.conditions, []).append(k)
    found = []
    for _, chosen in sorted(groups.items()):
        members = [measurements[k] for k in chosen]
        try:
            own = load(tables, members[0].changes)
        except CaseError as error:
            names = ", ".join(one.label for one in members)
            raise CaseError(
                *(f"calibrate.observations ({names}): {f}" for f in error.faults)
            ) from None
        rows = np.concatenate([np.arange(ends[k], ends[k + 1]) for k in chosen])
        found.append(_experiment(own, members, rows))
    return found


def _experiment(case: AnyCase, members: list[Measurement], rows: np.ndarray) -> Experiment:
    """Experiment that records the faces at the times at which they were measured."""
    tables = {key: table for key, table in as_plain(case).items() if key not in _OTHER}
    times = [float(t) for one in members for t in one.reading.times]
    if times and not isinstance(case.analysis, Timed | Fretting):
        raise CaseError(
            f"calibrate.observations: {members[0].label} has times; the analysis "
            f"{case.analysis.type} has none"
        )
    if isinstance(case.analysis, Timed | Fretting):
        shown = [float(t) for one in members if one.reading.places for t in one.reading.times]
        analysis = tables["analysis"] | {
            "frames": 0,
            "output_times": [f"{t!r} s" for t in _distinct(shown)],
        }
        end = getattr(case.analysis, "end_time", None)
        if times and end is not None and max(times) > end:
            raise CaseError(
                f"calibrate.observations: {members[0].label} goes to {max(times):g} s; the "
                "analysis ends before (analysis.end_time)"
            )
        tables = tables | {"analysis": analysis}
    located = not any("sliding_distance" in one.reading.at for one in members)
    smooth = not (isinstance(case.analysis, Fretting) and case.wear)
    return Experiment(tables, tuple(members), _distinct(times), located, smooth, rows)


def _distinct(times: Sequence[float]) -> tuple[float, ...]:
    """Times in order, without the start and without those that are equal up to rounding [s]."""
    found: list[float] = []
    for time in sorted(times):
        if time > (found[-1] * (1 + _EQUAL) if found else 0.0):
            found.append(time)
    return tuple(found)


def overrides_of(table: CalibrationTable, values: np.ndarray) -> tuple[str, ...]:
    """Changes of the case for values of the parameters, in the units of their first values."""
    named = {name: float(value) for name, value in zip(table.parameters, values, strict=True)}
    return table.overrides(named)


_CONDITIONS = {
    "load": ("force", "mean_pressure", "approach"),
    "motion": ("velocity", "angular_velocity"),
}
_CONDITIONS |= {"holders": _CONDITIONS["load"], "motions": _CONDITIONS["motion"]}
_OTHERWISE = 2.0
"""Factor of other conditions."""


def other_conditions(experiment: Experiment) -> dict[str, Experiment]:
    """The experiment at twice a load or speed of the case, by the path of the key."""
    found = {}
    for table, keys in _CONDITIONS.items():
        given = experiment.tables.get(table) or {}
        tables = given.items() if table.endswith("s") else [("", given)]
        for name, own in tables:
            for key in keys:
                if isinstance(own.get(key), str):
                    path = ".".join(filter(None, (table, name, key)))
                    number, _, unit = own[key].partition(" ")
                    changed = f'{path}="{_OTHERWISE * float(number)!r} {unit}"'
                    try:
                        tables_ = as_plain(load(experiment.tables, (changed,)))
                    except CaseError:
                        continue
                    found[path] = replace(experiment, tables=tables_)
    return found

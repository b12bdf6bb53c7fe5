"""Readings: quantities of the results that measurements correspond to."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import chain
from typing import Any

import numpy as np
from scipy.interpolate import LinearNDInterpolator, NearestNDInterpolator, PchipInterpolator

from ..errors import CaseError, ComputationError
from ..results import Result
from ..results.points import InterfaceFields, part_of
from ..results.quantity import TABLES, Quantity, split_key, table_of
from ..results.summary_keys import GROUPS

PLACES = ("x", "y", "z", "s")
"""Columns that points of a contact are found by."""
_ROWS = ("history", "heat", "loads", "cycles", "contacts", "probes")
"""Tables of rows, in the order in which a quantity is looked for; by cycles the table of these."""
_MASSES = {f"worn_mass_{k}": (f"wear_volume_{k}", k) for k in (1, 2)}
_EQUAL = 1e-9
"""Relative difference of times that are the same, and of places in their order."""


@dataclass(frozen=True)
class Reading:
    """Quantity of the results at given times or places.

    Attributes
    ----------
    quantity : Quantity
        Name, label and unit.
    at : dict of str to ndarray
        Times, distances, cycles or coordinates [SI] by the name of their column; empty for a number
        of the summary.
    contact : str or None
        Contact of a model of several bodies.
    factor : float
        Number that the quantity of the results is multiplied by, such as the density.
    count : int
        Number of values.
    """

    quantity: Quantity
    name: str
    count: int
    at: dict[str, np.ndarray] = field(default_factory=dict)
    contact: str | None = None
    factor: float = 1.0

    @property
    def times(self) -> np.ndarray:
        """Times at which results are needed [s]."""
        return self.at.get("time", np.zeros(0))

    @property
    def places(self) -> dict[str, np.ndarray]:
        """Coordinates of points of the contact [m]."""
        return {name: self.at[name] for name in PLACES if name in self.at}

    def of(self, result: Result) -> np.ndarray:
        """Values in a result, shape (count,) [SI].

        Raises
        ------
        CaseError
            If the results do not have the quantity there.
        """
        if self.places:
            values = self._at_places(result)
        elif self.at:
            values = self._in_rows(result)
        else:
            values = np.full(self.count, self._in_summary(result))
        self._check_finite(values)
        return self.factor * values

    def _check_finite(self, values: np.ndarray | float) -> None:
        if not np.isfinite(values).all():
            raise CaseError(f"{self.name}: has no value in the results of this case")

    def _contact_in(self, result: Result) -> str:
        if self.contact is None or self.contact not in result.contacts:
            names = ", ".join(result.contacts)
            raise CaseError(f"{self.name}: needs the contact; one of: {names}")
        return self.contact

    def _in_summary(self, result: Result) -> float:
        summary = result.summary
        if self.contact is not None and result.contacts:
            summary = summary["contacts"][self._contact_in(result)]
        numbers = summary_numbers(summary)
        if self.name in numbers:
            return numbers[self.name]
        known = ", ".join(sorted(numbers))
        raise CaseError(f"{self.name}: is not in the summary of this case; known: {known}")

    def _in_rows(self, result: Result) -> np.ndarray:
        """Values between the rows of a table, by a shape-preserving cubic."""
        (along, wanted) = next(iter(self.at.items()))
        name, part = self.name, self.contact if result.contacts else None
        if name in result.summary.get("probes", {}):
            name, part = "temperature", name
        tables = result.tables()
        for stem in ["cycles"] if along == "cycle" else _ROWS:
            columns = TABLES[stem].columns
            # rows of the whole model are those of no part
            of_part = part is None or not {"contact", "probe"}.isdisjoint(columns)
            if stem in tables and of_part and {name, along} <= columns.keys():
                rows = _of_part(tables[stem], part, result)
                x, values = (np.array([getattr(r, n) for r in rows]) for n in (along, name))
                self._check_finite(values)
                return _between(x, values, wanted, along)
        raise CaseError(
            f"{self.name}: no table of this analysis has it by {along}; "
            "see docs/reference/results.md"
        )

    def _at_places(self, result: Result) -> np.ndarray:
        """Values between the points of the contact at the times of the reading, or at the end."""
        found = np.empty(self.count)
        times = self.times if len(self.times) else np.full(self.count, np.nan)
        for time in np.unique(times):
            chosen = (times == time) | (np.isnan(times) & np.isnan(time))
            fields = self._interface(result, float(time))
            places = {name: values[chosen] for name, values in self.places.items()}
            found[chosen] = _on_face(fields, self._column(fields), self.name, places)
        return found

    def _column(self, fields: InterfaceFields) -> np.ndarray:
        if self.name not in table_of(fields).columns:
            raise CaseError(
                f"{self.name}: is no quantity of interface.csv; see docs/reference/results.md"
            )
        values = getattr(fields, self.name)
        self._check_finite(values)
        return values

    def _interface(self, result: Result, time: float) -> InterfaceFields:
        """Contact points at a time, or at the end of the run for NaN."""
        fields = result.interface
        if not np.isnan(time):
            each = {result.summary.get("time_s", np.nan): fields} | result.outputs
            same = [t for t in each if np.isclose(t, time, rtol=_EQUAL, atol=0.0)]
            if not same:
                raise ComputationError(f"{self.name}: the run has no contact points at {time:g} s")
            fields = each[same[-1]]
        if not result.contacts:
            return fields
        return part_of(fields, result.contacts[self._contact_in(result)])


def summary_numbers(summary: dict[str, Any], above: str = "") -> dict[str, float]:
    """Numbers of a summary by name without unit, those in tables by their path."""
    found: dict[str, float] = {}
    for key, value in summary.items():
        if isinstance(value, dict):
            found |= summary_numbers(value, f"{above}{key}.")
        elif isinstance(value, int | float) and not isinstance(value, bool):
            found[above + "_".join(split_key(key)[0].split())] = float(value)
    return found


def known_quantities(at_places: bool) -> dict[str, Quantity]:
    """Quantities at points of the contact, or else of rows and of the summary, by name."""
    if at_places:
        return dict(TABLES["interface"].columns)
    found: dict[str, Quantity] = {}
    for stem in _ROWS:
        found = dict(TABLES[stem].columns) | found
    summary = chain.from_iterable(GROUPS.values())
    return {"_".join(split_key(one.header)[0].split()): one for one in summary} | found


def _of_part(rows: list, contact: str | None, result: Result) -> list:
    """Rows of one contact or probe, in tables that have several."""
    numbered = next((n for n in ("contact", "probe") if hasattr(rows[0], n)), None)
    if numbered is None:
        return rows
    names = list(result.contacts if numbered == "contact" else result.summary["probes"])
    if contact not in names:
        raise CaseError(f"needs the {numbered}; one of: {', '.join(names)}")
    return [row for row in rows if getattr(row, numbered) == names.index(contact) + 1]


def _between(x: np.ndarray, values: np.ndarray, wanted: np.ndarray, along: str) -> np.ndarray:
    x, first = np.unique(x, return_index=True)
    margin = 1e-9 * max(abs(x[-1]), 1e-300)
    if wanted.min() < x[0] - margin or wanted.max() > x[-1] + margin:
        raise ComputationError(
            f"the run covers {along} from {x[0]:g} to {x[-1]:g}; the data go from "
            f"{wanted.min():g} to {wanted.max():g}"
        )
    if len(x) == 1:
        return np.full(len(wanted), values[first][0])
    return PchipInterpolator(x, values[first])(np.clip(wanted, x[0], x[-1]))


def _on_face(
    fields: InterfaceFields, values: np.ndarray, name: str, places: dict[str, np.ndarray]
) -> np.ndarray:
    """Values at contact points, at places on the contact face."""
    at = np.stack([getattr(fields, place) for place in places], axis=1)
    wanted = np.stack(list(places.values()), axis=1)
    _check_places(fields, name, at, list(places))
    for k, place in enumerate(places):
        margin = 0.02 * np.ptp(at[:, k]) + 1e-12
        low, high = at[:, k].min() - margin, at[:, k].max() + margin
        if wanted[:, k].min() < low or wanted[:, k].max() > high:
            raise CaseError(
                f"{name}: {place} from {wanted[:, k].min():g} to {wanted[:, k].max():g} m lies "
                f"outside the contact face ({at[:, k].min():g} to {at[:, k].max():g} m)"
            )
    if len(places) == 1:
        x, first = np.unique(at[:, 0], return_index=True)
        return PchipInterpolator(x, values[first], extrapolate=True)(wanted[:, 0])
    inside = LinearNDInterpolator(at, values)(wanted)
    return np.where(np.isnan(inside), NearestNDInterpolator(at, values)(wanted), inside)


def _check_places(fields: InterfaceFields, name: str, at: np.ndarray, given: list[str]) -> None:
    """Check that coordinates (n, m) tell the points of a contact face apart."""
    section = bool(np.isfinite(fields.s).all())
    if section:
        steps = np.diff(at[np.argsort(fields.s, kind="stable"), 0])
        largest = np.abs(steps).max(initial=0.0)
        alone = len(given) == 1 and largest > 0.0
        tell = alone and (steps.min() >= -_EQUAL * largest or steps.max() <= _EQUAL * largest)
    else:
        extent = np.linalg.svd(at - at.mean(axis=0), compute_uv=False)
        tell = len(given) == 2 and extent[-1] > _EQUAL * extent[0]
    if not tell:
        words = "one that increases along it, such as s" if section else "two coordinates"
        raise CaseError(
            f"{name}: {', '.join(given)} do not tell the places on the contact face; give {words}"
        )


def reading(
    name: str,
    at: dict[str, np.ndarray],
    count: int,
    contact: str | None,
    densities: dict[int, float],
) -> Reading:
    """Reading of a quantity by its name in the results.

    Parameters
    ----------
    name : str
        Name of a column, of a number of the summary, of a probe, or ``worn_mass_1``.
    at : dict of str to ndarray
    count : int
    contact : str or None
    densities : dict of int to float
        Density of the worn body by its number [kg/m³].

    Raises
    ------
    CaseError
    """
    if name in _MASSES:
        volume, body = _MASSES[name]
        if body not in densities:
            raise CaseError(
                f"{name}: needs the density of the body, and the contact if there are several"
            )
        mass = Quantity(f"{name}_kg", f"worn mass, body {body}", "kg", "kg")
        return Reading(mass, volume, count, at, contact, densities[body])
    known = known_quantities(not at.keys().isdisjoint(PLACES))
    quantity = known.get(name) or Quantity(f"{name}_K", f"temperature, {name}", "K", "°C")
    return Reading(quantity, name, count, at, contact)

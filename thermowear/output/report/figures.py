"""Key figures of a report: all of ``summary.json``, grouped and labelled; and its status line."""

from __future__ import annotations

import math
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from ...balances import ALLOWED, BALANCES, holds
from ...results.quantity import split_key
from ...results.summary_keys import GROUPS, OTHER, PHASES, group_of, of_key
from .unit_format import NOTHING, number, quantity


@dataclass(frozen=True)
class Figure:
    """Line of the key figures.

    Attributes
    ----------
    label, text : str
        Description, and value with its unit.
    source : str
        Key and SI value.
    """

    label: str
    text: str
    source: str


@dataclass(frozen=True)
class BalanceFigure:
    """Result of a balance check; `good` is None if there is nothing to balance."""

    label: str
    text: str
    good: bool | None


def key_figures(summary: dict[str, Any]) -> dict[str, list[Figure]]:
    """Key figures of all keys of a summary by group; keys without a group are in "Other"."""
    keys = {name: [q.header for q in known] for name, known in GROUPS.items()}
    keys[OTHER] = [key for key in summary if group_of(key) == OTHER and key != "title"]
    groups = {}
    for name, own in keys.items():
        found = [figure for key in own if key in summary for figure in _figures(key, summary[key])]
        if found:
            groups[name] = found
    return groups


def balances(summary: dict[str, Any]) -> list[BalanceFigure]:
    """Balance errors of a summary compared with the allowed limit."""
    found = []
    for key, kept in BALANCES.items():
        error = summary.get(key)
        if isinstance(error, int | float):
            text = f"{error:.1e}" if math.isfinite(error) else NOTHING
            found.append(BalanceFigure(kept.name, f"{text} (allowed {ALLOWED:g})", holds(error)))
        elif key in summary:
            found.append(BalanceFigure(kept.name, NOTHING, None))
    return found


def figure_text(key: str, value: Any, entry: str = "") -> str:
    """Format a value of a summary, or of one of its tables, in the unit that suits its size."""
    shown = of_key(key)
    if shown.unit == "°C" and isinstance(
        value, int | float
    ):  # differences of temperatures are in K
        return f"{number(shown.drawn(value))} °C"
    return quantity(value, split_key(entry)[1] or shown.si)


def _figures(key: str, value: Any) -> list[Figure]:
    """One line for a value, or one line per entry of a table."""
    label = of_key(key).label
    if not isinstance(value, dict) or not value:
        return [Figure(label, figure_text(key, value), f"{key} = {value}")]
    return [
        Figure(
            f"{label}: {PHASES.get(entry) or split_key(entry)[0]}",
            figure_text(key, inner, entry),
            f"{key}.{entry} = {inner}",
        )
        for entry, inner in value.items()
    ]


@dataclass(frozen=True)
class Verdict:
    """Status line, with the mark ``good``, ``bad`` or ``unsure``."""

    text: str
    mark: str


def verdict(run: dict[str, Any], summary: dict[str, Any]) -> Verdict:
    """Status line from ``run.json`` and the time reached.

    Parameters
    ----------
    run, summary : dict
        Contents of the files; the summary is empty if the run ended without one.
    """
    status, reason = run.get("status"), run.get("message") or "no reason was recorded"
    if status == "done":
        return Verdict(f"Finished{_when(run)}.", "good")
    texts = {
        "failed": f"Stopped: {reason}.",
        "interrupted": f"Interrupted{_when(run)}.",
        "running": "Still running when this report was written, or killed.",
    }
    text = texts.get(str(status), f"Unknown status: {status}.")
    return Verdict(f"{text} {_reached(summary)}", "bad" if status == "failed" else "unsure")


def _reached(summary: dict[str, Any]) -> str:
    if not summary:
        return "There is no summary."
    time = summary.get("time_s")
    if not isinstance(time, int | float):
        return "The figures are those of the last state computed."
    return f"The figures are those of the state at {number(float(time))} s."


def _when(run: dict[str, Any]) -> str:
    """Time of the end, and duration."""
    try:
        start, end = (datetime.fromisoformat(run[key]) for key in ("started", "finished"))
        return f" {end:%Y-%m-%d %H:%M} {end.tzname()} after {(end - start).total_seconds():g} s"
    except (KeyError, TypeError, ValueError):
        return ""

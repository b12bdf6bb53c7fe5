"""Status of a run in one line."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import Any

from .unit_format import number


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

"""Key figures of a report, grouped and labelled, and its status line.

Numbers are shown in engineering units (50 MPa, 44.6 µm, 2199.11 kN).
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from ...balances import ALLOWED, BALANCES, errors_of, holds
from ...results.quantity import multiple, split_key
from ...results.summary_keys import GROUPS, OTHER, PHASES, group_of, of_key
from ..files import between

NOTHING = "–"
_PARTS = {"contacts": "Contact", "holders": "Holder", "bodies": "Body", "probes": "Probe"}
"""Tables of the summary by part of the model, and what a part is called."""
NOISE = 1e-13
"""Size of rounding errors, relative to the largest number in the same unit."""
_QUANTITY = re.compile(r"([-+]?[.\d]+(?:e[-+]?\d+)?) (\S+)")
_POWERS = str.maketrans({"2": "²", "3": "³", "^": None})


@dataclass(frozen=True)
class Figure:
    """Line of the report.

    Attributes
    ----------
    label, text : str
        Description, and value with its unit.
    source : str
        Key and SI value of a key figure.
    mark : str
        ``good``, ``bad`` or ``unsure``; empty if there is nothing to judge.
    """

    label: str
    text: str
    source: str = ""
    mark: str = ""


def key_figures(summary: dict[str, Any]) -> dict[str, list[Figure]]:
    """Key figures of all keys of a summary by group; keys without a group are in "Other".

    Each contact, holder, body and probe has a group of its own.
    """
    sizes = _sizes(summary)
    keys = {name: [q.header for q in known] for name, known in GROUPS.items()}
    known = {"title", *_PARTS}
    keys[OTHER] = [key for key in summary if group_of(key) == OTHER and key not in known]
    groups, names = {}, between(summary)
    for name, own in keys.items():
        found = [
            figure
            for key in own
            if key in summary
            for figure in _figures(key, summary[key], sizes, names)
        ]
        if found:
            groups[name] = found
    for kind, word in _PARTS.items():
        for name, part in (summary.get(kind) or {}).items():
            own_sizes, names = _sizes(summary | part), between(part)
            groups[f"{word} {name}"] = [
                figure
                for key, value in part.items()
                for figure in _figures(key, value, own_sizes, names, f"{kind}.{name}.")
            ]
    return groups


def balances(summary: dict[str, Any]) -> list[Figure]:
    """Balance errors of a summary compared with the allowed limit."""
    found = []
    for key, kept in BALANCES.items():
        error = summary.get(key)
        if isinstance(error, int | float):
            text = f"{error:.1e}" if math.isfinite(error) else NOTHING
            mark = "good" if holds(error) else "bad"
            found.append(Figure(kept.name, f"{text} (allowed {ALLOWED:g})", mark=mark))
        elif key in summary:
            found.append(Figure(kept.name, NOTHING))
    return found + _worst_of_bodies(summary)


def _worst_of_bodies(summary: dict[str, Any]) -> list[Figure]:
    """Largest balance error of each kind among several bodies."""
    worst: dict[str, tuple[float, str]] = {}
    for where, kept, error in errors_of(summary):
        if where:
            size = abs(error) if math.isfinite(error) else math.inf
            worst[kept.name] = max(worst.get(kept.name, (-1.0, "")), (size, where))
    return [
        Figure(
            f"{name}, worst{where}",
            f"{size:.1e} (allowed {ALLOWED:g})" if size < math.inf else NOTHING,
            mark="good" if holds(size) else "bad",
        )
        for name, (size, where) in worst.items()
    ]


def _sizes(summary: dict[str, Any]) -> dict[str, float]:
    """Largest number of a summary in each SI unit."""
    sizes: dict[str, float] = {}
    for key, value in summary.items():
        si = of_key(key).si
        sizes[si] = max([sizes.get(si, 0.0), *map(abs, _numbers(value))])
    return sizes


def without_noise(value: Any, size: float) -> Any:
    """Value with zero for a number that is a rounding error of others of a size."""
    if isinstance(value, float) and abs(value) < NOISE * size:
        return 0.0
    return value


def figure_text(key: str, value: Any, entry: str = "") -> str:
    """Format a value of a summary, or of one of its tables, in the unit that suits its size."""
    shown = of_key(key)
    # differences of temperatures are in K
    if shown.unit == "°C" and isinstance(value, int | float):
        return f"{number(shown.drawn(value))} °C"
    if key.endswith("_bytes") and isinstance(value, int | float):
        return _memory(value)
    return quantity(value, split_key(entry)[1] or shown.si)


def _memory(size: float) -> str:
    """Format a number of bytes."""
    unit, scale = ("GB", 1e-9) if size >= 1e9 else ("MB", 1e-6)
    return f"{scale * size:.3g} {unit}"


def _figures(
    key: str, value: Any, sizes: dict[str, float], names: tuple[str, str], where: str = ""
) -> list[Figure]:
    """One line for a value, or one line per entry of a table; bodies by their names."""
    label, si = of_key(key).of_bodies(names).label, of_key(key).si
    if not isinstance(value, dict) or not value:
        shown = without_noise(value, sizes[si]) if si else value
        return [Figure(label, figure_text(key, shown), f"{where}{key} = {value}")]
    return [
        Figure(
            f"{label}: {PHASES.get(entry) or split_key(entry)[0]}",
            figure_text(key, inner, entry),
            f"{where}{key}.{entry} = {inner}",
        )
        for entry, inner in value.items()
    ]


def verdict(run: dict[str, Any], summary: dict[str, Any]) -> Figure:
    """Status line from ``run.json`` and the time reached.

    Parameters
    ----------
    run, summary : dict
        Contents of the files; the summary is empty if the run ended without one.
    """
    status, reason = run.get("status"), run.get("message") or "no reason was recorded"
    if status == "done":
        return Figure("status", f"Finished{_when(run)}.", mark="good")
    texts = {
        "failed": f"Stopped: {reason}.",
        "interrupted": f"Interrupted{_when(run)}.",
        "running": "Still running when this report was written, or killed.",
    }
    text = texts.get(str(status), f"Unknown status: {status}.")
    mark = "bad" if status == "failed" else "unsure"
    return Figure("status", f"{text} {_reached(summary)}", mark=mark)


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


def number(value: float) -> str:
    """Format a number with six digits, integers in groups of three; a dash if not finite."""
    if isinstance(value, int):
        return f"{value:,}".replace(",", "\u202f")
    return f"{value + 0.0:.6g}" if math.isfinite(value) else NOTHING


def quantity(value: Any, si: str) -> str:
    """Format any value of ``summary.json`` in the unit that suits its size.

    Parameters
    ----------
    value : object
        Any value of a JSON file.
    si : str
        SI unit of its numbers; may be empty.
    """
    if isinstance(value, dict):
        return ", ".join(_entry(key, inner, si) for key, inner in value.items()) or NOTHING
    sizes = [abs(size) for size in _numbers(value)]
    unit, scale = multiple(si, max(sizes, default=0.0))
    parts = value if _is_list(value) else [value]
    text = ", ".join(_text(part, si, scale) for part in parts) or NOTHING
    return f"{text} {unit}" if unit and sizes else text


def _entry(key: str, value: Any, si: str) -> str:
    name, own = split_key(key)
    return f"{name}: {quantity(value, own or si)}"


def _text(value: Any, si: str, scale: float) -> str:
    """Format one value times a scale; nested lists, such as intervals, in brackets."""
    if _is_list(value):
        return f"[{', '.join(_text(part, si, scale) for part in value)}]"
    if isinstance(value, dict):
        return quantity(value, si)
    if value is None:
        return NOTHING
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int | float):
        return number(value if scale == 1.0 else value * scale)
    return str(value)


def _numbers(value: Any) -> Iterator[float]:
    """Iterate over the finite numbers in a value and in its lists."""
    if _is_list(value):
        for part in value:
            yield from _numbers(part)
    elif isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        yield value


def _is_list(value: Any) -> bool:
    return isinstance(value, list | tuple)


def table_lines(tables: dict[str, Any], name: str, above: str = "") -> list[tuple[str, str]]:
    """Name and content of each table with entries, such as ``bodies.punch``.

    Parameters
    ----------
    tables : dict
        Nested tables of a file.
    name : str
        Name for the keys outside any table.
    above : str
        Path of the tables within the file.
    """
    plain = {key: value for key, value in tables.items() if not isinstance(value, dict)}
    content = " · ".join(f"{split_key(key)[0]} {_shown(value)}" for key, value in plain.items())
    lines = [(above.rstrip(".") or name, content)] if content else []
    for key, inner in tables.items():
        if isinstance(inner, dict):
            lines += table_lines(inner, name, f"{above}{key}.")
    return lines


def _shown(value: Any) -> str:
    """Format a value of a case file; quantities such as ``"0.02 m"`` in a unit that suits them."""
    if isinstance(value, list):
        return ", ".join(map(_shown, value))
    if isinstance(value, dict):
        return ", ".join(f"{key} {_shown(inner)}" for key, inner in value.items())
    written = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    if written is None:
        return quantity(value, "")
    unit = re.sub(r"\^[23]", lambda power: power[0].translate(_POWERS), written[2])
    return quantity(float(written[1]), unit)

"""Console output at the end: summary, discretisations side by side, and verification checks."""

from __future__ import annotations

from math import pi
from typing import Any

from rich.console import Console
from rich.text import Text

from ..balances import errors_of, holds
from ..results.summary_keys import PHASES, of_key
from .files import between
from .progress import PlainTable, readable, readable_unit

_OF_PARTS = {
    "contacts": (
        "normal_force_N",
        "fluid_force_N",
        "friction_torque_Nm",
        "max_pressure_Pa",
        "shape_range_m",
        "friction_power_W",
        "critical_speed_m_per_s",
        "critical_angular_velocity_rad_per_s",
        "dissipated_energy_J",
        "wear_volume_1_m3",
        "wear_volume_2_m3",
    ),
    "holders": ("approach_m", "tangential_force_N", "rigid_wear_velocity_m_per_s"),
    "bodies": ("contact_heat_W", "friction_torque_Nm", "wear_volume_m3"),
    "probes": ("temperature_K",),
}
"""Numbers of parts of a model that are printed."""
_FLAT = 1e-12  # range of the shape up to which a face is flat but for rounding errors [m]
_SMALLEST_SHOWN = 1e-3
"""Smallest error estimate shown as a number [%]; errors of quadrature are far below."""


def print_summary(console: Console, summary: dict, seconds: dict[str, float]) -> None:
    """Print the main results and the wall time by phase."""
    numbers = PlainTable(show_header=False)
    for label, value in _highlights(summary):
        numbers.add_row(label, value)
    console.print(numbers)
    named = "contacts" in summary  # of a single contact, the bodies are in the highlights
    for kind in _OF_PARTS if named else ("probes",):
        parts = summary.get(kind, {})
        keys = [k for k in _OF_PARTS[kind] if any(part.get(k) for part in parts.values())]
        if keys:
            console.print(_side_by_side(kind, parts, keys))
    times = _table("phase", "seconds")
    for name, value in seconds.items():
        times.add_row(PHASES.get(name, name), f"{value:.3f}")
    times.add_row("total", f"{sum(seconds.values()):.3f}")
    console.print(times)


def _side_by_side(kind: str, parts: dict[str, dict[str, Any]], keys: list[str]) -> PlainTable:
    """Numbers of the contacts, holders or bodies of a model, a row for each of them."""
    quantities = [of_key(key) for key in keys]
    table = _table(kind, *(f"{q.label} [{q.unit}]" for q in quantities))
    for name, part in parts.items():
        values = zip(quantities, (part.get(key) for key in keys), strict=True)
        table.add_row(name, *("" if v is None else f"{q.drawn(v):.5g}" for q, v in values))
    return table


def _table(label: str, *columns: str) -> PlainTable:
    """Table without lines: labels in the first column, numbers in the others."""
    table = PlainTable(label)
    for name in columns:
        table.add_column(name, justify="right", overflow="fold")
    return table


def print_discretisations(console: Console, summary: dict, keys: tuple[str, ...]) -> None:
    """Print results on a coarser, the given and a finer discretisation side by side."""
    coarser, finer = (summary[f"{name}_discretisation"] for name in ("coarser", "finer"))
    shown = {"coarser": coarser, "this case": summary, "finer": finer}
    table = _table("quantity", *shown)
    for key in keys:
        values = [numbers.get(key) for numbers in shown.values()]
        if any(value is not None for value in values):
            table.add_row(key, *("" if value is None else f"{value:.6g}" for value in values))
    console.print(table)
    for name, numbers in (("coarser", coarser), ("finer", finer)):
        ended = f"failed: {numbers['failed']}" if "failed" in numbers else numbers["changes"]
        console.print(Text(f"{name}: {ended}"))


def print_checks(console: Console, checks: list) -> None:
    """Print a line per `thermowear.verification.Check`, the sources, and the count."""
    head = ("id", "quantity", "computed", "reference", "error", "allowed", "verdict")
    rows = [head] + [
        (c.id, c.quantity, f"{c.computed:.7g}", f"{c.reference:.7g}", f"{c.error:.1e}")
        + (f"{c.allowed:.0e}", "ok" if c.passed else "FAILED")
        for c in checks
    ]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "  ".join(
            cell.rjust(width) if 2 <= k <= 5 else cell.ljust(width)
            for k, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
    lines += dict.fromkeys(f"{c.id}: {c.source}" for c in checks)
    failed = sum(not c.passed for c in checks)
    lines.append(f"{len(checks) - failed} passed, {failed} failed")
    console.print(Text("\n".join(lines)), soft_wrap=True)


def _highlights(summary: dict):
    """Labels and values of the main results that exist."""

    def exists(key: str) -> bool:
        return summary.get(key) is not None

    def row(key: str, digits: int = 6, label: str = "", unit: str = "", more: str = ""):
        if exists(key):
            value, suited = readable(key, summary[key], unit)
            yield label or of_key(key).label, f"{value:.{digits}g} {suited}{more}"

    first, second = between(summary)
    for where, balance, error in errors_of(summary):
        if not holds(error):
            yield f"NOT BALANCED: {balance.name}{where}", f"relative error {error:.1e}"
    yield from row("normal_force_N", unit="kN")
    if exists("min_pressure_Pa"):
        low, high = (summary[f"{m}_pressure_Pa"] for m in ("min", "max"))
        unit, scale = readable_unit("max_pressure_Pa", high)
        margin = _margin(summary, "pressure", "max_pressure")
        yield "pressure", f"{scale * low:.5g} … {scale * high:.5g} {unit}{margin}"
    yield from row("approach_m", 5, f"approach of the holder towards {second}")
    if summary.get("shape_range_m", 0.0) > _FLAT:
        yield from row("shape_range_m", 5, more=_margin(summary, "shape"))
    if exists("max_temperature_K"):
        yield from row("max_temperature_K", 5, more=_margin(summary, "temperature"))
        yield from row("friction_power_W")
    if exists("contact_heat_1_W") and summary["friction_power_W"] == 0.0:
        yield from row("contact_heat_2_W", label=f"heat from {first} to {second}")
    yield from row("prescribed_heat_W", label="heat through surfaces")
    if exists("peak_temperature_K"):
        time = f" at {summary['peak_temperature_time_s']:.5g} s"
        yield from row("peak_temperature_K", 5, more=time)
    if exists("max_cell_peclet_number"):
        peclet = f"cell Péclet number up to {summary['max_cell_peclet_number']:.3g}"
        yield of_key("heat_advection").label, f"{summary['heat_advection']}, {peclet}"
    yield from row("heat_carried_out_W")
    yield from row("rigid_wear_velocity_m_per_s", 5)
    if exists("dissipated_energy_J"):
        yield from row("tangential_force_N")
        yield from row("dissipated_energy_J", 5)
    if "time_s" in summary:
        yield "time, steps", f"{summary['time_s']:.6g} s, {summary['steps']}"
    if summary.get("cycles"):
        yield "cycles", f"{summary['cycles']:.6g}"
    if max(summary.get(f"wear_volume_{side}_m3", 0.0) for side in (1, 2)) > 0:
        volumes = (value for body in (1, 2) for _, value in row(f"wear_volume_{body}_m3", 5))
        yield f"worn volume, {first} and {second}", " and ".join(volumes)
    for body, name in enumerate((first, second), start=1):
        distance = summary.get(f"worn_through_distance_{body}_m")
        yield from row(
            f"worn_through_time_{body}_s",
            5,
            f"coating worn through, {name}",
            more="" if distance is None else f", {distance:.5g} m",
        )
    for which, label in (("", ""), ("_with_wear", " with wear")):
        if exists(f"critical_speed_factor{which}"):
            yield f"critical speed{label}", _critical(summary, which)
    for which, label in (("", ""), ("_with_wear", " with wear")):
        if exists(f"first_hot_spots{which}_number"):
            yield f"first hot spots{label}", _hot_spots(summary, f"first_hot_spots{which}")
    if exists("growth_rate_per_s"):
        yield "pressure perturbations", _growing(summary)
    if exists("distance_from_steady"):
        yield "distance from the steady state", f"{summary['distance_from_steady']:.2e}"


def _margin(summary: dict, *quantities: str) -> str:
    """Largest estimated discretisation error of some quantities, as text; "" without any."""
    keys = (f"{quantity}_error_estimate_relative" for quantity in quantities)
    known = [summary[key] for key in keys if summary.get(key) is not None]
    if not known:
        return ""
    error = 100 * max(known)
    return f"  (± {error:.2g} %)" if error >= _SMALLEST_SHOWN else f"  (± {_SMALLEST_SHOWN:g} %)"


def _critical(summary: dict, which: str) -> str:
    """Critical speed, and the speed of the case relative to it."""
    part = 1 / summary[f"critical_speed_factor{which}"]
    if "contacts" in summary:
        return f"this case: {part:.3g} times the critical speeds"
    speed = summary[f"critical_speed{which}_m_per_s"]
    turning = summary[f"critical_angular_velocity{which}_rad_per_s"]
    critical = f"{turning:.4g} rad/s" if speed is None else f"{speed * 1e3:.4g} mm/s"
    return f"{critical}; this case: {part:.3g} times the critical speed"


def _hot_spots(summary: dict, name: str) -> str:
    """Number and symmetry of the first hot spots, and their critical speed."""
    number, symmetry = summary[f"{name}_number"], summary[f"{name}_symmetry"]
    kind = "" if symmetry == "whole" else f"{symmetry}, "
    along = f"{number}" if isinstance(number, int) else f"{number:.4g} rad/m along the sliding"
    speeds = (
        of_key(f"{name}_angular_velocity_rad_per_s"),
        of_key(f"{name}_speed_m_per_s"),
    )
    given = [f"{summary[q.header]:.4g} {q.si}" for q in speeds if summary.get(q.header) is not None]
    part = 1 / summary[f"{name}_speed_factor"]
    return f"{along}, {kind}from {given[0]}; this case: {part:.3g} times this speed"


def _growing(summary: dict) -> str:
    """Growth or decay of the least stable pressure perturbation."""
    rate, swing = summary["growth_rate_per_s"], summary["growth_frequency_rad_per_s"]
    word = "grow" if rate > 0 else "decay"
    kind = f", oscillatory with period {2 * pi / swing:.4g} s" if swing > 0 else ""
    return f"{word} with time constant {1 / abs(rate):.4g} s{kind}"

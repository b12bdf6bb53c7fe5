"""Reference of tables, columns and keys in docs/reference/results.md, made from their declarations.

scripts/env python3 -m tests.results.test_reference      # writes it anew
"""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from thermowear.results import TABLES
from thermowear.results.quantity import from_key, key, split_key
from thermowear.results.summary_keys import GROUPS, OTHER, group_of, of_key

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "reference" / "results.md"
DATA = ROOT / "tests" / "output" / "data" / "0.1.0"
START, END = "<!-- made by tests/results/test_reference.py -->\n", "<!-- end -->\n"


def text_of(quantity):
    """Label and meaning of a quantity."""
    return f"{quantity.label}; {quantity.meaning}" if quantity.meaning else quantity.label


def reference() -> str:
    """Generated part of the page."""
    lines = ["| table | content |", "|---|---|"]
    for table in TABLES.values():
        names = [f"`{table.stem}.csv`", *([f"`{table.stem}_TIME.csv`"] * table.at_times)]
        lines.append(f"| {', '.join(names)} | {table.content} |")
    lines += ["", "| column | quantity | tables |", "|---|---|---|"]
    found: dict = {}
    for table in TABLES.values():
        for quantity in table.columns.values():
            found.setdefault(quantity, []).append(table.stem)
    for quantity, stems in found.items():
        lines.append(f"| `{quantity.header}` | {text_of(quantity)} | {', '.join(stems)} |")
    lines += ["", "| key of `summary.json` | quantity |", "|---|---|"]
    for name, group in GROUPS.items():
        lines.append(f"| **{name}** | |")
        lines += [f"| `{quantity.header}` | {text_of(quantity)} |" for quantity in group]
    return "\n".join(lines) + "\n"


def test_the_page_is_up_to_date():
    """requirement: the reference of users is made from the declarations of the program."""
    assert reference() in PAGE.read_text(encoding="utf-8")


def test_a_key_tells_its_unit():
    """requirement: SI units are read from the names that they are written in."""
    for si in ("m", "m²", "m³", "Pa", "N m", "m/s", "W/m²", "J/m²", "rad/s", "1/s"):
        assert split_key(key("a_b", si)) == ("a b", si)
    assert split_key("wear_coefficient_per") == ("wear coefficient per", "")
    assert key("speed_factor", "") == "speed_factor"
    for table in TABLES.values():
        for quantity in table.columns.values():
            assert from_key(quantity.header).si == quantity.si


def test_units_of_plots():
    """requirement: value in the unit of plots, from SI."""
    columns = TABLES["interface"].columns
    assert columns["pressure"].drawn(2e6) == pytest.approx(2.0, rel=1e-12)
    assert columns["wear_rate_1"].drawn(3e-9) == pytest.approx(3.0, rel=1e-12)
    assert columns["temperature_1"].drawn(293.15) == pytest.approx(20.0, rel=1e-12)
    assert columns["heat_flux_2"].drawn(1500.0) == pytest.approx(1.5, rel=1e-12)


def test_a_key_that_is_not_declared_names_itself():
    """requirement: label and unit of any key of a summary."""
    shown = of_key("wear_volume_per_cycle_1_m3")
    assert (shown.label, shown.si, shown.unit) == ("wear volume per cycle 1", "m³", "m³")
    assert group_of("wear_volume_per_cycle_1_m3") == OTHER
    assert of_key("growth_rate_per_s").si == "1/s"
    known = {quantity.header for group in GROUPS.values() for quantity in group}
    for path in DATA.rglob("summary.json"):
        others = set(json.loads(path.read_bytes())) - known
        assert others <= {"title", "cycles", *(f"wear_volume_per_cycle_{k}_m3" for k in (1, 2))}


def test_a_declaration_is_in_one_place():
    """requirement: no key twice; tables and summary share the quantity of a common name."""
    keys = [quantity.header for group in GROUPS.values() for quantity in group]
    assert len(keys) == len(set(keys))
    for table in TABLES.values():
        for name, quantity in table.columns.items():
            assert re.fullmatch(
                rf"{name}|{key(name, quantity.si)}|balance_relative_error", (quantity.header)
            )
            if quantity.header in keys and group_of(quantity.header) != "Times":
                assert of_key(quantity.header).label == quantity.label


if __name__ == "__main__":
    page = PAGE.read_text(encoding="utf-8")
    before, _, rest = page.partition(START)
    PAGE.write_text(before + START + reference() + END + rest.partition(END)[2], encoding="utf-8")

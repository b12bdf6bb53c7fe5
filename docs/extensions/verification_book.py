"""Verification book: problem, sources and numbers of each verification case.

The numbers are those that ``make verification`` has written to ``docs/verification/checks.json``.
"""

from __future__ import annotations

import inspect
import json
from pathlib import Path
from typing import Any

from thermowear.verification import CASES

CHECKS = Path(__file__).parents[1] / "verification" / "checks.json"
_TITLES = {
    "steady": "Steady states and the systems of the papers",
    "contact": "Contact",
    "cycles": "Friction, fretting and reciprocating sliding",
    "heat": "Heat and thermoelastic instability",
    "wear": "Wear in time, coatings, deep wear",
    "assembly": "Several bodies",
    "inference": "Inference and sensitivity",
}
_INTRODUCTION = """# Verification book

`python3 -m thermowear verify ID` computes the numbers of a case anew, `verify` all of them. The
error is relative to the reference, or to the scale that the quantity names. Version {version}:
{count} numbers of {cases} cases.

```{{toctree}}
:maxdepth: 2

{pages}
```
"""


def verification_pages() -> dict[str, str]:
    """Pages of the book by name."""
    book = json.loads(CHECKS.read_text(encoding="utf-8"))
    checks: dict[str, list[dict[str, Any]]] = {}
    for row in book["checks"]:
        checks.setdefault(row["id"], []).append(row)
    pages = {}
    for group, title in _TITLES.items():
        names = [name for name, case in CASES.items() if _group(case) == group and name in checks]
        pages[group] = f"# {title}\n\n" + "\n".join(_section(n, checks[n]) for n in names)
    pages["index"] = _INTRODUCTION.format(
        version=book["version"],
        count=len(book["checks"]),
        cases=len(checks),
        pages="\n".join(_TITLES),
    )
    return pages


def _group(case: Any) -> str:
    """Folder of the module of a case; closed forms of the papers' systems are steady states."""
    folder = case.__module__.split(".")[-2]
    return "steady" if folder == "closed_forms" else folder


def _section(name: str, rows: list[dict[str, Any]]) -> str:
    problem = " ".join((inspect.getdoc(CASES[name]) or "").split("\n\n")[0].split())
    sources = list(dict.fromkeys(row["source"] for row in rows))
    lines = [f"(verify-{name})=", f"## {name}", "", problem, ""]
    if len(sources) == 1:
        lines += [f"Source: {sources[0]}.", ""]
    else:
        lines += ["Sources:", "", *(f"{n}. {each}" for n, each in enumerate(sources, 1)), ""]
    number = {each: f" ({n})" if len(sources) > 1 else "" for n, each in enumerate(sources, 1)}
    lines += ["| quantity | computed | reference | error | allowed |", "|---|---|---|---|---|"]
    for row in rows:
        quantity = row["quantity"].replace("|", "\\|") + number[row["source"]]
        numbers = (_number(row[key]) for key in ("computed", "reference"))
        errors = (f"{row[key]:.1e}" for key in ("error", "allowed"))
        lines.append("| " + " | ".join([quantity, *numbers, *errors]) + " |")
    return "\n".join([*lines, ""])


def _number(value: float | None) -> str:
    return "–" if value is None else f"{value:.7g}"

"""Verification book: problem, sources and numbers of each verification case.

The numbers are those that ``make verification`` has written to ``docs/verification/checks.json``.
"""

from __future__ import annotations

import inspect
import json
from pathlib import Path
from typing import Any

from thermowear.verification import CASES

from .error_pictures import draw_errors

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
_SYSTEMS = {
    "annular-punch": "annular_punch-bodies",
    "ring-3d": "annular_punch-interface",
    "optimal-shape": "annular_punch-speeds",
    "running-in": "annular_punch_running_in-wear",
    "hertz-line": "cylinder_on_block-interface",
    "hertz-sphere": "sphere_on_block-interface",
    "flat-punch": "punch_on_block-interface",
    "mindlin": "cylinder_stick_slip-friction",
    "growing-cylinder": "cylinder_on_block_growing-wear",
    "growing-sphere": "sphere_on_block_growing-wear",
    "block-on-ring": "block_on_ring-wear",
    "beam-shakedown": "beam_on_foundation-wear",
    "fretting-cylinder": "cylinder_fretting-cycles",
    "fuel-fretting": "tube_in_support-cycles",
    "fretting-sphere": "sphere_fretting-cycles",
    "reciprocating": "punch_on_strip_reciprocating-track",
    "braking-stop": "disk_brake_stop-heat",
    "coating": "sphere_on_block_coated-wear",
    "coated-bush": "shaft_in_bush_coated-coating",
    "pad-disk-pad": "disk_brake_two_pads-bodies",
    "clutch-pack": "clutch_pack-bodies",
    "face-seal": "face_seal-bodies",
    "two-shoes": "two_shoe_drum-bodies",
    "floating-caliper": "disk_brake_floating_caliper-bodies",
    "cad-part": "cad_pad-bodies",
    "calibration": "annular_punch_calibration-fit",
    "sobol": "annular_punch_study-tornado",
}
"""Pictures of the gallery that show the system of a case."""
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
    checks, pages = _checks(), {}
    for group, title in _TITLES.items():
        names = [name for name, case in CASES.items() if _group(case) == group and name in checks]
        pages[group] = f"# {title}\n\n" + "\n".join(_section(n, checks[n]) for n in names)
    pages["index"] = _INTRODUCTION.format(
        version=_book()["version"],
        count=sum(map(len, checks.values())),
        cases=len(checks),
        pages="\n".join(_TITLES),
    )
    return pages


def draw_book(folder: Path) -> None:
    """Draw the errors of each case into a folder, if the checks are newer than the pictures."""
    folder.mkdir(exist_ok=True)
    for name, rows in _checks().items():
        path = folder / f"{name}.svg"
        if not path.exists() or path.stat().st_mtime < CHECKS.stat().st_mtime:
            draw_errors(rows, path)


def _checks() -> dict[str, list[dict[str, Any]]]:
    """Checks of each case."""
    found: dict[str, list[dict[str, Any]]] = {}
    for row in _book()["checks"]:
        found.setdefault(row["id"], []).append(row)
    return found


def _book() -> dict[str, Any]:
    return json.loads(CHECKS.read_text(encoding="utf-8"))


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
    if name in _SYSTEMS:
        lines += [f"![System of {name}](../../demos/pictures/{_SYSTEMS[name]}.png){{.system}}", ""]
    lines += [f"![Errors of {name}, and what is allowed](pictures/{name}.svg)", ""]
    lines += [
        "{.checks}",
        "| quantity | computed | reference | error | allowed |",
        "|---|---|---|---|---|",
    ]
    for row in rows:
        quantity = row["quantity"].replace("|", "\\|") + number[row["source"]]
        numbers = (_number(row[key]) for key in ("computed", "reference"))
        errors = (f"{row[key]:.1e}" for key in ("error", "allowed"))
        lines.append("| " + " | ".join([quantity, *numbers, *errors]) + " |")
    return "\n".join([*lines, ""])


def _number(value: float | None) -> str:
    return "–" if value is None else f"{value:.7g}"

"""Numbers of the verification book: runs ``verify --json`` and keeps what the book shows.

make verification                 # or, of some cases only:
scripts/env python3 docs/extensions/write_checks.py ID...
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import thermowear

PAGE = Path(__file__).parents[1] / "verification" / "checks.json"
KEPT = "id", "quantity", "computed", "reference", "error", "allowed", "source"
DIGITS = 8


def rounded(value):
    """Number with the digits that the book needs."""
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value


def main(names: list[str]) -> int:
    """Compute cases, all but the slow ones by default, and replace their numbers in the file."""
    command = [sys.executable, "-m", "thermowear", "verify", "--json", *names]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        print("a number is not within what is allowed: the book is not written", file=sys.stderr)
        return done.returncode
    found = [{key: rounded(row[key]) for key in KEPT} for row in json.loads(done.stdout)]
    if names and PAGE.exists():
        old = json.loads(PAGE.read_text(encoding="utf-8"))["checks"]
        found += [row for row in old if row["id"] not in names]
        place = {row["id"]: number for number, row in enumerate(old)}
        found.sort(key=lambda row: place.get(row["id"], len(old)))
    lines = ",\n".join(json.dumps(row, ensure_ascii=False) for row in found)
    PAGE.parent.mkdir(exist_ok=True)
    PAGE.write_text(
        f'{{"version": "{thermowear.__version__}", "checks": [\n{lines}\n]}}\n', encoding="utf-8"
    )
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))

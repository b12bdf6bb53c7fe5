"""Processor time of `validate` on each starter case, the start of the program included.

scripts/env python3 tests/benchmarks/start.py
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from thermowear.case.starters import starter_text, starters


def of_children() -> float:
    """Processor time of finished child processes, whatever else the machine does [s]."""
    times = os.times()
    return times.children_user + times.children_system


def main() -> None:
    with tempfile.TemporaryDirectory() as place:
        for name in starters():
            path = Path(place, f"{name}.toml")
            path.write_text(starter_text(name), encoding="utf-8")
            command = [sys.executable, "-m", "thermowear", "validate", str(path)]
            began = of_children()
            subprocess.run(command, capture_output=True, check=True)
            print(f"{name:40} {of_children() - began:6.2f} s")


if __name__ == "__main__":
    main()

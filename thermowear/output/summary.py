"""Reading of ``summary.json``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any


def read_summary(folder: Path) -> dict[str, Any]:
    """Summary of the run in a results folder; empty if there is none."""
    path = folder / "summary.json"
    return json.loads(path.read_bytes()) if path.is_file() else {}

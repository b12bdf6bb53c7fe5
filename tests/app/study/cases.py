"""Small cases with a table `study`, and readers of their results."""

from __future__ import annotations

import csv
import json
from pathlib import Path

from ...conftest import HOT, cold_tables

PRESSURE = {"distribution": "normal", "mean": "50 MPa", "deviation": "4 %"}
FRICTION = {"distribution": "uniform", "lower": 0.1, "upper": 0.4}
BOTH = {"load.mean_pressure": PRESSURE, "contact.friction": FRICTION}


def ring(inputs: dict, hot: bool = False, **settings) -> dict:
    """Tables of a ring on a plate, coarse, with uncertain inputs."""
    import tomllib

    tables = tomllib.loads(HOT.read_text(encoding="utf-8")) if hot else cold_tables()
    tables["mesh"] = {"degree": 2, "elements": 3}
    return tables | {"study": {"inputs": inputs} | settings}


def written(tables: dict, path: str = "ring.toml") -> str:
    """Case file in the current folder."""
    import tomli_w

    Path(path).write_text(tomli_w.dumps(tables), encoding="utf-8")
    return path


def rows(path) -> list[dict[str, str]]:
    """Rows of a table."""
    with Path(path).open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def record(folder) -> dict:
    """Record of a study."""
    return json.loads(Path(folder, "run.json").read_text("utf-8"))


def calibration(folder: str, covariance: object, more: dict | None = None, **parameters) -> str:
    """Folder with a calibration, with more entries of its record."""
    Path(folder).mkdir()
    content = {"parameters": parameters, "set": {}, "covariance": covariance} | (more or {})
    Path(folder, "calibration.json").write_text(json.dumps(content))
    return folder

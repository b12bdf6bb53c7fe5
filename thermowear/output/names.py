"""Names of the files of a results folder."""

from __future__ import annotations

import math
import re
from pathlib import Path

from ..results import TABLES
from .atomic_write import final_name

PICTURES = {
    "bodies": "Von Mises stress of the bodies, and their temperature if the case has heat.",
    "deformed": "Deformed bodies, displacements magnified.",
    "interface": "Pressure, temperatures and shape of the worn face along the contact.",
    "profile": "Worn shape.",
    "wear": "Pressure and wear depth along the contact at the output times and at the end.",
    "track": "Wear depths of both bodies along x, body 1 in the middle of its stroke.",
    "history": "Largest pressure and worn volume over time.",
    "heat": "Surface temperatures of both bodies, friction power and largest pressure over time.",
    "friction": "Shear traction with its Coulomb limits, and slip, at the output times.",
    "loads": "Tangential force over displacement, and dissipated energy over time.",
    "cycles": "Largest wear depth and worn volume over the cycles.",
    "mode": "Pressure perturbations: the fastest growing mode and the modes at critical speeds.",
}
"""Pictures of a run with their captions, in the order of the report."""

FRAMES = "frames"
_REPORT_TAG = re.compile(rb'<meta name="generator" content="thermowear"')
_REPORT_HEAD = 1000  # bytes at the beginning of a report that contain its generator tag
_OTHERS = {
    *("summary.json", "checkpoint.npz", "run.json", "case.resolved.toml", "fields.vtu"),
    *(FRAMES, "animation.gif", *(f"{name}.png" for name in PICTURES)),
}


def name_at(stem: str, time: float | None) -> str:
    """File name of a table at an output time, or at the end."""
    return f"{stem}.csv" if time is None else f"{stem}_{time:g}.csv"


def stem_and_time(name: str) -> tuple[str, float | None]:
    """Stem and output time of the file name of a table; without a time the whole stem and None."""
    whole = name.removesuffix(".csv")
    stem, _, text = whole.partition("_")
    try:
        time = float(text)
    except ValueError:
        return whole, None
    return (stem, time) if math.isfinite(time) else (whole, None)


def states(folder: Path, stem: str) -> dict[float, Path]:
    """Files of a table at the output times, in the order of time."""
    found = {stem_and_time(path.name)[1]: path for path in folder.glob(f"{stem}_*.csv")}
    return {time: found[time] for time in sorted(t for t in found if t is not None)}


def is_ours(path: Path) -> bool:
    """Test whether a file is a result of this program; a report is recognised by its head."""
    name = final_name(path)
    if name == "report.html":
        return is_report(path)
    stem, time = stem_and_time(name)
    table = TABLES.get(stem) if name == name_at(stem, time) else None
    return name in _OTHERS or (table is not None and (time is None or table.at_times))


def is_report(path: Path) -> bool:
    """Test whether a file is a report written by this program."""
    try:
        with path.open("rb") as file:
            return _REPORT_TAG.search(file.read(_REPORT_HEAD)) is not None
    except OSError:
        return False

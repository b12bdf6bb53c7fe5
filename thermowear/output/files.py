"""Files of a results folder: names, atomic replacement, and the JSON files."""

from __future__ import annotations

import json
import math
import os
import re
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from ..errors import UnwritableError
from ..results import TABLES

PICTURES = {
    "bodies": "Von Mises stress of the bodies, and their temperature if the case has heat.",
    "deformed": "Deformed bodies, displacements magnified.",
    "faces": "Contact face of the second body in space, and the worn shape magnified.",
    "interface": "Pressure, temperatures and shape of the worn face along the contact.",
    "profile": "Worn shape.",
    "wear": "Pressure and wear depth along the contact at the output times and at the end.",
    "coating": "Thickness left of the coatings at the output times and at the end.",
    "track": "Wear depths of both bodies, body 1 in the middle of its stroke.",
    "history": "Largest pressure and worn volume over time.",
    "heat": "Surface temperatures of both bodies, friction power and largest pressure over time.",
    "friction": "Shear traction with its Coulomb limits, and slip, at the output times; in space "
    "maps of shear, slip, dissipated energy and status at the end.",
    "loads": "Tangential force over displacement, and dissipated energy over time.",
    "cycles": "Largest wear depth and worn volume over the cycles.",
    "mode": "Pressure perturbations: the fastest growing mode and the modes at critical speeds.",
    "hot_spots": "Critical speeds by the number of hot spots, and growth of the first ones.",
    "hot_spots_3d": "Temperature of the first hot spots on the best conductor, from both sides.",
}
"""Pictures of a run with their captions, in the order of the report."""

BY_CONTACT = (
    *("interface", "profile", "wear", "coating", "faces"),
    *("mode", "friction", "track"),
)
"""Pictures by contact in a model of several bodies."""
AT = "_at_"
"""Between the name of a contact and the output time in the names of files."""
FRAMES = "frames"
_REPORT_TAG = re.compile(rb'<meta name="generator" content="thermowear"')
_REPORT_HEAD = 1000  # bytes at the beginning of a report that contain its generator tag
_OTHERS = {
    *("summary.json", "checkpoint.npz", "run.json", "case.resolved.toml", "fields.vtu"),
    "hot_spots.vtu",
    *(FRAMES, "animation.gif", *(f"{name}.png" for name in PICTURES)),
}


def picture(name: str, contact: str = "") -> str:
    """File name of a picture, of one contact in a model of several bodies."""
    return f"{name}_{contact}.png" if contact else f"{name}.png"


class TableFile(NamedTuple):
    """Table of a results folder, by the name of its file.

    Attributes
    ----------
    stem : str
        Of a table; the whole name without ``.csv`` for a file of another name.
    contact : str
        Contact of a model of several bodies; empty in others.
    time : float or None
        Output time; None at the end [s].
    """

    stem: str
    contact: str = ""
    time: float | None = None


def name_at(stem: str, time: float | None, contact: str = "") -> str:
    """File name of a table at an output time, or at the end."""
    if contact:
        stem = f"{stem}_{contact}"
        return f"{stem}.csv" if time is None else f"{stem}{AT}{time:g}.csv"
    return f"{stem}.csv" if time is None else f"{stem}_{time:g}.csv"


def table_file(name: str) -> TableFile:
    """Table, contact and output time of a file name."""
    whole = name.removesuffix(".csv")
    stem, _, rest = whole.partition("_")
    if stem not in TABLES or not rest:
        return TableFile(whole)
    time = _number(rest)
    if time is not None:
        return TableFile(stem, "", time)
    contact, _, text = rest.rpartition(AT)
    time = _number(text) if contact else None
    return TableFile(stem, rest) if time is None else TableFile(stem, contact, time)


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def states(folder: Path, stem: str, contact: str = "") -> dict[float, Path]:
    """Files of a table at the output times, in the order of time."""
    found = ((table_file(path.name), path) for path in folder.glob(f"{stem}_*.csv"))
    times = {file.time: path for file, path in found if file.contact == contact}
    return {time: times[time] for time in sorted(t for t in times if t is not None)}


def contacts_of(folder: Path) -> list[str]:
    """Names of the contacts of the run in a results folder; one empty name for a pair."""
    found = (read_object(folder / "run.json") or {}).get("contacts")
    return [str(name) for name in found] if isinstance(found, list) and found else [""]


def bodies_of(folder: Path, contact: str = "") -> tuple[str, str]:
    """Names of the first and the second body of a contact, or of those of all contacts, for labels.

    Those of a run that has not ended are "body 1" and "body 2".
    """
    summary = read_summary(folder)
    contacts = summary.get("contacts", {})
    if not contacts:
        return between(summary)
    first, second = contacts.get(contact, {}).get("between", ("first bodies", "second bodies"))
    return first, second


def between(summary: dict[str, Any]) -> tuple[str, str]:
    """Names of the first and the second body in the summary of a contact."""
    first, second = summary.get("between", ("body 1", "body 2"))
    return first, second


def is_ours(path: Path) -> bool:
    """Test whether a file is a result of this program; a report is recognised by its head."""
    name = final_name(path)
    if name == "report.html":
        return is_report(path)
    contacts = contacts_of(path.parent)
    pictures = {picture(each, contact) for each in BY_CONTACT for contact in contacts}
    stem, contact, time = table_file(name)
    known = name == name_at(stem, time, contact) and contact in ("", *contacts)
    table = TABLES.get(stem) if known else None
    at_time = table is not None and (time is None or table.at_times)
    return name in _OTHERS or name in pictures or at_time


def is_report(path: Path) -> bool:
    """Test whether a file is a report written by this program."""
    try:
        with path.open("rb") as file:
            return _REPORT_TAG.search(file.read(_REPORT_HEAD)) is not None
    except OSError:
        return False


@contextmanager
def atomic_write(path: Path) -> Iterator[Path]:
    """Write to a draft beside a file and rename it to the file at the end.

    Until then the file remains unchanged, even if the process is killed; after an error, such as a
    full disk, the draft is removed.
    """
    draft = path.with_name(f".{path.name}.part")
    try:
        yield draft
        os.replace(draft, path)
    except BaseException:
        draft.unlink(missing_ok=True)
        raise


def write_text(path: Path, text: str) -> None:
    """Write a text file, atomically."""
    with atomic_write(path) as draft:
        draft.write_text(text, "utf-8")


@contextmanager
def writing() -> Iterator[None]:
    """Turn an error of the disk into a failed computation.

    Raises
    ------
    UnwritableError
    """
    try:
        yield
    except BrokenPipeError:  # of the console
        raise
    except OSError as error:
        raise UnwritableError(f"results cannot be written: {error}") from None


def final_name(path: Path) -> str:
    """Name of the file that a draft will become; the name itself if the path is no draft."""
    name = path.name
    is_draft = name.startswith(".") and name.endswith(".part")
    return name[1:].removesuffix(".part") if is_draft else name


def read_object(path: Path) -> dict[str, Any] | None:
    """Content of a JSON file; None if it is missing, unreadable, or not an object."""
    try:
        found = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) else None


def read_summary(folder: Path) -> dict[str, Any]:
    """Summary of the run in a results folder; empty if there is none.

    Raises
    ------
    ValueError
        If the file is damaged.
    """
    path = folder / "summary.json"
    if not path.is_file():
        return {}
    found = json.loads(path.read_bytes())
    if not isinstance(found, dict):
        raise ValueError(f"{path}: is damaged: no table of numbers")
    return found


def model_of(folder: Path) -> str:
    """Kinematic model of the run in a results folder; empty if it is not known."""
    case = folder / "case.resolved.toml"
    if (folder / "summary.json").is_file() or not case.is_file():
        return read_summary(folder).get("model", "")
    return tomllib.loads(case.read_text("utf-8")).get("model", "")

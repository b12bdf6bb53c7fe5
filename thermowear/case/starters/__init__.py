"""Starter cases: complete, commented case files."""

from __future__ import annotations

import tomllib
from importlib import resources

from ...errors import CaseError


def starters() -> dict[str, str]:
    """Names and titles of all starter cases."""
    files = (f for f in resources.files(__name__).iterdir() if f.name.endswith(".toml"))
    found = {f.name.removesuffix(".toml"): f.read_text("utf-8") for f in files}
    return {name: tomllib.loads(text)["title"] for name, text in sorted(found.items())}


def starter_text(name: str) -> str:
    """Text of the case file of a starter case.

    Raises
    ------
    CaseError
        If no starter case has this name.
    """
    if name not in starters():
        raise CaseError(f"init {name}: no such starter case; one of: {', '.join(starters())}")
    return (resources.files(__name__) / f"{name}.toml").read_text("utf-8")


def command_for(text: str) -> str:
    """Command that a case file is made for: that of its own table, or ``run``."""
    tables = tomllib.loads(text)
    return next((name for name in ("calibrate", "study") if name in tables), "run")


def starter_files(name: str) -> dict[str, bytes]:
    """Files that a starter case reads from its own folder, by name.

    Raises
    ------
    CaseError
        If no starter case has this name.
    """
    tables = tomllib.loads(starter_text(name))
    geometry = tables["geometry"]
    paths = [geometry["path"]] if "path" in geometry else [*geometry.get("paths", {}).values()]
    observations = tables.get("calibrate", {}).get("observations", {}).values()
    paths += [own["file"] for own in observations if "file" in own]
    return {path: (resources.files(__name__) / path).read_bytes() for path in paths}

"""Paths of files named by a case, independent of the working directory."""

from __future__ import annotations

import os
from typing import Annotated

from pydantic import AfterValidator, ValidationInfo

from ...errors import note

FOLDER = "folder"
"""Key of the case file's folder in the validation context."""


def _resolve_path(path: str, info: ValidationInfo) -> str:
    """Absolute path of a file: relative to the folder of the case file, or else to the current one.

    A case without a file of its own (tables in Python) uses the current folder only.
    """
    here = os.path.abspath(path)
    folder = (info.context or {}).get(FOLDER)
    if folder is None:
        return here
    in_folder = os.path.abspath(os.path.join(folder, path))
    if here == in_folder or not os.path.exists(here):
        return in_folder
    if os.path.exists(in_folder):
        note(f"found {in_folder}, next to the case file; the other file {here} is not read")
        return in_folder
    note(
        f"found {here} in the current folder; paths are relative to the folder of the case "
        f"file: {folder}"
    )
    return here


UserFile = Annotated[str, AfterValidator(_resolve_path)]
"""Type of a key that holds the path of a file, made absolute."""

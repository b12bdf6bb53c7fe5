"""Files that a case names: where they are, wherever the program is called."""

from __future__ import annotations

import os
from typing import Annotated

from pydantic import AfterValidator, ValidationInfo

from ...errors import note

FOLDER = "folder"
"""Key of the folder of the case file in the context of validation."""


def _found(path: str, info: ValidationInfo) -> str:
    """The absolute path of a file: from the folder of the case file, or else from the current one.

    A case without a file of its own (tables in Python) has only the current folder.
    """
    here = os.path.abspath(path)
    folder = (info.context or {}).get(FOLDER)
    if folder is None:
        return here
    beside = os.path.abspath(os.path.join(folder, path))
    if here == beside or not os.path.exists(here):
        return beside
    if os.path.exists(beside):
        note(f"found {beside}, beside the case file; {here} is another file, and is not read")
        return beside
    note(f"found {here} in the current folder; paths are meant from the case file's: {folder}")
    return here


UserFile = Annotated[str, AfterValidator(_found)]
"""Type of a key that holds the path of a file: absolute inside."""

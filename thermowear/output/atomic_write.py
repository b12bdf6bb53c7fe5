"""Files that are there whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A draft beside a file, which takes its place in the end.

    Until then the file is what it was, whenever the process is killed; where the disk is full, the
    room that the draft took is free again.
    """
    draft = path.with_name(f".{path.name}.part")
    try:
        yield draft
        os.replace(draft, path)
    except BaseException:
        draft.unlink(missing_ok=True)
        raise


def final_name(path: Path) -> str:
    """Of the file that a path, if it is a draft, will become."""
    name = path.name
    is_draft = name.startswith(".") and name.endswith(".part")
    return name[1:].removesuffix(".part") if is_draft else name

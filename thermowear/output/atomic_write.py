"""Atomic replacement of files."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


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


def final_name(path: Path) -> str:
    """Name of the file that a draft will become; the name itself if the path is no draft."""
    name = path.name
    is_draft = name.startswith(".") and name.endswith(".part")
    return name[1:].removesuffix(".part") if is_draft else name

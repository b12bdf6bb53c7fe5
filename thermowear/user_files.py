"""Reading of files named by the user: regular files only, up to a given size.

Reading a pipe or a device may block or never end.
"""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path


def read_text(path: Path, largest: int) -> str:
    """Read a text file in UTF-8, with or without a byte order mark.

    Parameters
    ----------
    path : Path
    largest : int
        Largest size accepted [bytes].

    Raises
    ------
    OSError
        If the file cannot be read, is not a regular file, or is larger.
    ValueError
        If the file is not in UTF-8.
    """
    try:
        return read_bytes(path, largest).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError("is not text in UTF-8") from None


def read_bytes(path: Path, largest: int) -> bytes:
    """Read the content of a file; for parameters and errors see `read_text`."""
    # non-blocking: opening a pipe without a writer would block
    handle = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    try:
        mode = os.fstat(handle).st_mode
        if not stat.S_ISREG(mode):
            if stat.S_ISDIR(mode):
                raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
            raise OSError(errno.EINVAL, "is a pipe, a device or a socket, not a file")
        with open(handle, "rb", closefd=False) as file:
            content = file.read(largest + 1)
    finally:
        os.close(handle)
    if len(content) > largest:
        raise OSError(errno.EFBIG, f"has more than {largest} bytes, the limit for such a file")
    return content

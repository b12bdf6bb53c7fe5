"""Files that the user names: only regular ones are read, and only up to a size.

A pipe or a device may never end, and may never even begin.
"""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path


def read_text(path: Path, largest: int) -> str:
    """The text of a file in UTF-8, with or without a byte order mark.

    Parameters
    ----------
    path : Path
    largest : int
        Size up to which it is read [bytes].

    Raises
    ------
    OSError
        If it cannot be read, is no regular file, or is larger.
    ValueError
        If it is not in UTF-8.
    """
    try:
        return read_bytes(path, largest).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError("is not text in UTF-8") from None


def read_bytes(path: Path, largest: int) -> bytes:
    """The content of a file; for parameters and errors see `read_text`."""
    # opened without waiting: a pipe that nobody writes to would block
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

"""Lock of a results folder against simultaneous runs."""

from __future__ import annotations

import fcntl
import os
import weakref
from pathlib import Path

from ..errors import CaseError


class Lock:
    """Exclusive lock of a folder, released when the process ends in any way.

    Parameters
    ----------
    path : Path
        Folder to lock.

    Raises
    ------
    CaseError
        If another run has locked the folder.
    """

    def __init__(self, path: Path):
        handle = os.open(path, os.O_RDONLY)
        self.release = weakref.finalize(self, os.close, handle)
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise CaseError(f"-o {path}: in use by another run") from None
        except OSError:  # a file system without locks
            return

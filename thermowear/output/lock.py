"""One run at a time in a folder."""

from __future__ import annotations

import fcntl
import os
import weakref
from pathlib import Path

from ..errors import CaseError


class Lock:
    """Keeps other runs out of a folder; it goes with the process, however that ends.

    Parameters
    ----------
    path : Path
        Of the folder.

    Raises
    ------
    CaseError
        If another run is in it.
    """

    def __init__(self, path: Path):
        handle = os.open(path, os.O_RDONLY)
        self.release = weakref.finalize(self, os.close, handle)
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise CaseError(f"-o {path}: another run is being computed in it") from None
        except OSError:  # a file system without locks
            return

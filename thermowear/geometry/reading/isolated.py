"""Reading of mesh files by libraries in a separate process.

Readers of XML and HDF5 files may crash, hang or exhaust the memory on a malformed or hostile
file; a separate process with resource limits protects the program.
"""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

from .contents import CellBlock, MeshContents

_READER = Path(__file__).with_name("isolated_reader.py")
_SECONDS = 60
"""Largest elapsed time, regardless of processor time."""
_MEMORY = 2**30
"""Address space for the libraries and a small file [bytes], larger than the memory used."""
_PER_BYTE = 16
"""Additional memory per byte of a file."""
_LONGEST = 300
"""Largest number of characters of an error message."""


def read_isolated(path: Path, ending: str) -> MeshContents:
    """Read a .vtu, .xdmf or .med file.

    Raises
    ------
    ValueError
        If it is malformed, refers to other files, or exceeds the limits of memory or time.
    """
    memory = _MEMORY + _PER_BYTE * path.stat().st_size
    command = [sys.executable, "-P", str(_READER), str(path.resolve()), ending, str(memory)]
    single = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
    try:
        done = subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=_SECONDS,
            env=os.environ | single,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise ValueError(f"reading it took more than {_SECONDS} s") from None
    if done.returncode == 1:
        reason = done.stderr.decode("utf-8", "replace").rpartition("\n")[2]
        raise ValueError(reason[:_LONGEST] or "it is malformed")
    if done.returncode:
        raise ValueError("its reader was stopped: the file is malformed, or takes too long to read")
    return _unpacked(done.stdout)


def _unpacked(data: bytes) -> MeshContents:
    with np.load(io.BytesIO(data), allow_pickle=False) as file:
        arrays = dict(file)
    contents = json.loads(str(arrays["contents"]))
    blocks = [
        CellBlock(kind, arrays[f"nodes_{index}"], {})
        for index, kind in enumerate(contents["kinds"])
    ]
    for number, (index, name) in enumerate(contents["sets"]):
        blocks[index].sets[name] = arrays[f"set_{number}"]
    sets = {name: arrays[f"node_set_{n}"] for n, name in enumerate(contents["node_sets"])}
    return MeshContents(arrays["points"], blocks, sets)

"""Reading of untrusted mesh files: neither ending nor contents are assumed to be valid.

Only meshes are read. A file is checked before it is passed to a reader, and no reader executes
commands, opens other files or writes any. Readers of XML and HDF5 files may crash, hang or exhaust
the memory on a malformed or hostile file; a separate process with resource limits protects the
program.
"""

from __future__ import annotations

import io
import json
import os
import stat
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...errors import CaseError
from .abaqus import read_abaqus
from .contents import VTK_ORDER, CellBlock, MeshContents, shown
from .gmsh import read_gmsh

_MARK = b"\xef\xbb\xbf"
"""Byte order mark of UTF-8."""
_LARGEST = {2: 32 * 2**20, 3: 1024 * 2**20}
"""Largest size of a file by the dimension of its bodies [bytes]: half a million nodes of a section,
or some million cells in space, as text."""
_READER = Path(__file__).with_name("isolated_reader.py")
_SECONDS = 60
"""Largest elapsed time, regardless of processor time."""
_MEMORY = 2**30
"""Address space for the libraries and a small file [bytes], larger than the memory used."""
_PER_BYTE = 16
"""Additional memory per byte of a file."""
_LONGEST = 300
"""Largest number of characters of an error message."""


class _Kind(NamedTuple):
    """Format: its name, its first bytes, and its reader."""

    name: str
    heads: tuple[bytes, ...]
    read: Callable[[Path, int], MeshContents]


def read_contents(path: Path, dim: int = 2, key: str = "geometry.path") -> MeshContents:
    """Read a mesh file with bodies of a dimension; its ending selects the format.

    Raises
    ------
    CaseError
        One line, reported at the key.
    """
    kind = _KINDS.get(path.suffix.lower())
    if kind is None:
        raise CaseError(f"{key}: {path}: unknown file ending; must be one of: {', '.join(_KINDS)}")
    try:
        check_file(path, kind.name, kind.heads, _LARGEST[dim])
        contents = kind.read(path, dim).checked(dim)
    except OSError as error:
        raise CaseError(f"{key}: {path} cannot be read: {error.strerror}") from None
    except Exception as error:  # readers raise any exception for a malformed file
        reason = " ".join(str(error).split()) or type(error).__name__
        raise CaseError(f"{key}: {path} cannot be read: {reason}") from None
    if not any(block.dim == dim for block in contents.blocks):
        kinds = "plane cells" if dim == 2 else "tetrahedra or hexahedra"
        raise CaseError(f"{key}: {path} has no {kinds}")
    return contents


def check_file(path: Path, name: str, heads: tuple[bytes, ...], largest: int) -> None:
    """Reject non-files, files too large, and files without the first bytes of the format.

    Parameters
    ----------
    path : Path
    name : str
        Name of the format, for the message.
    heads : tuple of bytes
        What a file begins with.
    largest : int
        Largest size [bytes].

    Raises
    ------
    OSError, ValueError
    """
    about = os.stat(path)
    if stat.S_ISDIR(about.st_mode):
        raise ValueError("Is a directory")
    if not stat.S_ISREG(about.st_mode):
        raise ValueError("it is a pipe or a device, not a file")
    if about.st_size > largest:
        raise ValueError(
            f"it has {about.st_size / 2**20:.0f} MB; at most {largest / 2**20:.0f} MB are allowed"
        )
    with path.open("rb") as file:
        head = file.read(4096).removeprefix(_MARK).lstrip()
    if not head:
        raise ValueError("it is empty")
    if not head.startswith(heads):
        raise ValueError(
            f"it is not a {name}: it begins with {shown(head.splitlines()[0])}; only meshes "
            "are read, commands are never executed"
        )


def read_isolated(path: Path, dim: int) -> MeshContents:
    """Read a .vtu, .xdmf or .med file.

    Raises
    ------
    ValueError
        If it is malformed, refers to other files, or exceeds the limits of memory or time.
    """
    memory = _MEMORY * (dim - 1) + _PER_BYTE * path.stat().st_size
    command = [sys.executable, "-P", str(_READER), str(path.resolve())]
    single = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
    try:
        done = subprocess.run(
            [*command, path.suffix.lower(), str(memory)],
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
        CellBlock(kind, _in_order(kind, arrays[f"nodes_{k}"]), {})
        for k, kind in enumerate(contents["kinds"])
    ]
    for number, (index, name) in enumerate(contents["sets"]):
        blocks[index].sets[name] = arrays[f"set_{number}"]
    sets = {name: arrays[f"node_set_{n}"] for n, name in enumerate(contents["node_sets"])}
    return MeshContents(arrays["points"], blocks, sets)


def _in_order(kind: str, nodes: np.ndarray) -> np.ndarray:
    """Nodes of elements in gmsh's order instead of VTK's."""
    return nodes[:, VTK_ORDER[kind]] if kind in VTK_ORDER else nodes


_KINDS = {
    ".msh": _Kind(
        "gmsh mesh",
        (b"$MeshFormat", b"$Comments"),
        lambda path, _: read_gmsh(path.read_bytes().removeprefix(_MARK)),
    ),
    ".inp": _Kind(
        "Abaqus input file",
        (b"*",),
        lambda path, dim: read_abaqus(path.read_text("utf-8-sig", "replace"), dim),
    ),
    ".vtu": _Kind("VTK unstructured grid", (b"<?xml", b"<VTKFile", b"<!--"), read_isolated),
    ".xdmf": _Kind("XDMF file", (b"<?xml", b"<Xdmf", b"<!--", b"<!DOCTYPE Xdmf"), read_isolated),
    ".med": _Kind("MED file", (b"\x89HDF\r\n\x1a\n",), read_isolated),
}

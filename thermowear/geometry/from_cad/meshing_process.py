"""Meshing of CAD files in a process of its own, where OpenCASCADE may crash or hang.

The same request and files give the same mesh; the last ones are kept.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import pickle
import subprocess
import sys
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import CaseError
from ..reading.contents import CellBlock, MeshContents
from ..reading.file_contents import check_file
from .request import CadRequest
from .touching import CurvedPlace

ENDINGS = (".step", ".stp", ".brep")
"""Endings of CAD files."""
_STEP = "STEP file", (b"ISO-10303-21;",)
_BREP = "BREP file", (b"DBRep_DrawableShape", b"CASCADE Topology V")
_OUTSIDE = (b"DOCUMENT_FILE", b"EXTERNALLY_DEFINED_REPRESENTATION")
"""Entities that refer to other files."""
_LARGEST = 256 * 2**20
"""Largest size of a file [bytes]."""
_SECONDS = 900
"""Largest processor time and elapsed time of meshing [s]."""
_MEMORY = 6 * 2**30
"""Address space [bytes]."""
_LONGEST = 2000
"""Largest number of characters of an error message."""
_ROOT = Path(__file__).parents[3]


def meshed_contents(request: CadRequest) -> MeshContents:
    """Mesh of CAD files, with a body each, like the contents of a mesh file [m].

    Cell sets are named like solids, sets of facets like the surfaces of the request.

    Raises
    ------
    CaseError
        One line, reported at the key at fault.
    """
    return _meshed(_with_digests(request))


def touching_bodies(request: CadRequest) -> list[tuple[str, str]]:
    """Names of bodies that touch, two each.

    Raises
    ------
    CaseError
        One line, reported at the key at fault.
    """
    return _touching(_with_digests(request))


def curved_places(request: CadRequest) -> tuple[CurvedPlace, ...]:
    """Places where the faces of contacts curve against each other.

    Raises
    ------
    CaseError
        One line, reported at the key at fault.
    """
    return _curved(_with_digests(request))


def _with_digests(request: CadRequest) -> CadRequest:
    """Request that is equal only for the same files, which are checked."""
    digests = tuple(_checked(Path(body.path), body.key) for body in request.bodies)
    return replace(request, digests=digests)


def _checked(path: Path, key: str) -> str:
    """SHA-256 of a file, which must be what its ending says and refer to no other."""
    if path.suffix.lower() not in ENDINGS:
        raise CaseError(f"{key}: {path}: unknown file ending; must be one of: {', '.join(ENDINGS)}")
    is_step = path.suffix.lower() != ".brep"
    kind, heads = _STEP if is_step else _BREP
    try:
        check_file(path, kind, heads, _LARGEST)
        data = path.read_bytes()
        if is_step and any(word in data for word in _OUTSIDE):
            raise ValueError("it refers to another file; a part must be in one file")
    except OSError as error:
        raise CaseError(f"{key}: {path} cannot be read: {error.strerror}") from None
    except ValueError as error:
        raise CaseError(f"{key}: {path} cannot be read: {error}") from None
    return hashlib.sha256(data).hexdigest()


@lru_cache(maxsize=4)
def _meshed(request: CadRequest) -> MeshContents:
    arrays = _run("mesh", request)
    contents = json.loads(str(arrays["contents"]))
    blocks = []
    for b, body in enumerate(request.bodies):
        cells = arrays[f"cells_{b}"]
        sets = {body.name: np.arange(len(cells))}
        for s, names in enumerate(contents["solids"][b]):
            for name in set(names) - {body.name}:  # several solids may have one label
                known = sets.get(name, np.empty(0, dtype=np.int64))
                sets[name] = np.concatenate([known, arrays[f"solid_{b}_{s}"]])
        blocks.append(CellBlock("tetra10", cells, sets, b))
        on_body = {
            name: arrays[f"surface_{b}_{k}"]
            for k, name in enumerate(contents["surfaces"])
            if f"surface_{b}_{k}" in arrays
        }
        blocks.append(CellBlock("triangle6", arrays[f"facets_{b}"], on_body, b))
    return MeshContents(arrays["points"], blocks, dim=3)


@lru_cache(maxsize=4)
def _curved(request: CadRequest) -> tuple[CurvedPlace, ...]:
    places = json.loads(str(_run("curved", request)["contents"]))
    return tuple(
        CurvedPlace(**{key: _as_tuples(value) for key, value in place.items()}) for place in places
    )


@lru_cache(maxsize=4)
def _touching(request: CadRequest) -> list[tuple[str, str]]:
    pairs = json.loads(str(_run("touching", request)["contents"]))
    return [(one, other) for one, other in pairs]


def _as_tuples(value: Any) -> Any:
    """Value of JSON with tuples for lists, which can be a key."""
    return tuple(map(_as_tuples, value)) if isinstance(value, list) else value


def _run(task: str, request: CadRequest) -> dict[str, np.ndarray]:
    """Result of the program; its failure as a `CaseError`."""
    limits = str(_MEMORY), str(_SECONDS)
    command = [sys.executable, "-P", "-m", f"{__package__}.program", task, *limits]
    key = request.bodies[0].key
    try:
        done = subprocess.run(
            command,
            input=pickle.dumps(request),
            capture_output=True,
            timeout=_SECONDS,
            env=_environment(),
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise CaseError(f"{key}: meshing the CAD files took more than {_SECONDS} s") from None
    if done.returncode == 1:
        reason = done.stderr.decode("utf-8", "replace").rpartition("\n")[2]
        raise CaseError(reason[:_LONGEST] or f"{key}: the CAD files cannot be meshed")
    if done.returncode:
        raise CaseError(
            f"{key}: the process that meshes the CAD files was stopped: a file is malformed, or "
            "its shapes are beyond OpenCASCADE; repair it in the CAD program, or use other sizes"
        )
    with np.load(io.BytesIO(done.stdout), allow_pickle=False) as file:
        return dict(file)


def _environment() -> dict[str, str]:
    """Environment of a process with one thread that is no part of a parallel run."""
    launcher = ("OMPI_", "PMIX_", "PMI_", "PRTE_")
    kept = {name: value for name, value in os.environ.items() if not name.startswith(launcher)}
    paths = os.pathsep.join(filter(None, (str(_ROOT), kept.get("PYTHONPATH"))))
    single = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
    return kept | single | {"PYTHONPATH": paths}

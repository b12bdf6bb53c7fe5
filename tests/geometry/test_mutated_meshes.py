"""Mutated mesh files: an answer that can be right, or one line.

A small sample of each way runs always. ``THERMOWEAR_MUTATIONS=N`` in the environment asks for N of
each, ``THERMOWEAR_SEED=M`` for others; the slow test also solves the contact of those accepted.
"""

from __future__ import annotations

import math
import os
import warnings

import numpy as np
import pytest

import thermowear as tw
from thermowear.errors import CaseError, CaseNote, ComputationError

from .mutations import AS_BYTES, AS_MESH, HARMLESS, spoilt
from .plain import NAMES, NUMBERED, blocks, inp, meshio_file, msh
from .test_mesh_file import GMSH_NAMES, gmsh_blocks

STEEL = {"young_modulus": "200 GPa", "poisson_ratio": 0.3}
FORCE = 100.0
SAMPLE = int(os.environ.get("THERMOWEAR_MUTATIONS", "3"))
SEED = [int(seed) for seed in os.environ.get("THERMOWEAR_SEED", "").split()]
FORMATS = ["2.2", "4.1", "binary", "inp", "vtu", "xdmf", "med"]
BASE = blocks(round_face=0.02)
"""A punch with a slightly round face, so that the contact is in the middle."""


@pytest.fixture(scope="module")
def originals(tmp_path_factory):
    """A sound file of each format: its bytes, its ending and the names in it."""
    place = tmp_path_factory.mktemp("originals")
    gmsh_blocks(place / "4.1.msh", 4.1)
    gmsh_blocks(place / "binary.msh", 4.1, Binary=1)
    (place / "2.2.msh").write_text(msh(BASE))
    (place / "inp.inp").write_text(inp(BASE))
    for ending in ("vtu", "xdmf", "med"):
        meshio_file(BASE, place / f"{ending}.{ending}")
    names = {"4.1": GMSH_NAMES, "binary": GMSH_NAMES, "vtu": NUMBERED, "xdmf": NUMBERED}
    return {
        path.name.rpartition(".")[0]: (path.read_bytes(), path.suffix, names.get(path.stem, NAMES))
        for path in place.iterdir()
    }


def case(path, keys) -> tw.Case:
    return tw.load(
        {
            "model": "plane-strain",
            "geometry": {"type": "file", "path": str(path)} | keys,
            "bodies": {"punch": STEEL, "plate": STEEL},
            "load": {"force": f"{FORCE} N"},
            "mesh": {"degree": 1},
            "analysis": {"type": "initial"},
        }
    )


def accepted(path, keys):
    """The case and its mesh; None where it was refused in one line."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", CaseNote)
        try:
            found = case(path, keys)
            return found, found.tagged_mesh()
        except CaseError as error:
            (line,) = error.faults
            assert "\n" not in line
            assert line.startswith(("geometry", "load", "mesh"))
            assert len(line) < 1000
            return None


def check_sound(mesh) -> None:
    """Check any mesh of two plane bodies, by other methods than the program's."""
    assert np.isfinite(mesh.points).all()
    corners = mesh.cells[:, : 3 if mesh.cell_type == "triangle" else 4]
    x, y = np.moveaxis(mesh.points[corners], 2, 0)
    dx, dy = np.roll(x, -1, axis=1) - x, np.roll(y, -1, axis=1) - y
    turns = dx * np.roll(dy, -1, axis=1) - dy * np.roll(dx, -1, axis=1)
    assert np.all(turns > 0), "a cell is not convex and counter-clockwise"
    for tag in (1, 2):
        of_body = corners[mesh.cell_tags == tag]
        ends = np.stack([of_body, np.roll(of_body, -1, axis=1)], axis=2).reshape(-1, 2)
        directed = {tuple(pair) for pair in ends.tolist()}
        assert len(directed) == len(ends), "an edge is run along twice the same way"
        outer = np.array([pair for pair in directed if pair[::-1] not in directed])
        px, py = mesh.points[outer].transpose(2, 1, 0)
        around = 0.5 * np.sum(px[0] * py[1] - px[1] * py[0])
        cx, cy = np.moveaxis(mesh.points[of_body], 2, 0)
        area = 0.5 * np.sum(cx * np.roll(cy, -1, axis=1) - cy * np.roll(cx, -1, axis=1))
        assert area == pytest.approx(around, rel=1e-9)


def check_solved(found, largest: float) -> float | None:
    """Largest pressure of an accepted case; None where the computation fails and says so."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CaseNote)
        try:
            result = tw.run(found)
        except (CaseError, ComputationError) as error:
            assert str(error)
            return None
    if result.stopped is not None:
        return None
    carried = math.hypot(FORCE, result.summary["guide_force_N"])  # inclined faces push aside, too
    assert result.summary["normal_force_N"] == pytest.approx(carried, rel=1e-6)
    pressure = result.interface.pressure.max()
    assert pressure < largest
    return pressure


def mutated_bytes(originals, kind: str, change, number: int, place):
    data, ending, keys = originals[kind]
    rng = np.random.default_rng([number, FORMATS.index(kind), AS_BYTES.index(change), *SEED])
    path = place / f"mesh{ending}"
    path.write_bytes(change(data, rng))
    return path, keys


def mutated_mesh(change, number: int, place):
    rng = np.random.default_rng([number, AS_MESH.index(change), *SEED])
    mesh = spoilt(BASE, change, rng)
    text, ending = (msh(mesh), "msh") if number % 2 else (inp(mesh), "inp")
    path = place / f"mesh.{ending}"
    path.write_text(text)
    return path


@pytest.mark.parametrize("change", AS_BYTES)
@pytest.mark.parametrize("kind", FORMATS)
def test_mutated_files(kind, change, originals, tmp_path):
    """
    requirement: no traceback, crash or hang, whatever happens to a file on its way; what is still
    read is a mesh.
    """
    by_libraries = kind in ("vtu", "xdmf", "med")
    for number in range(max(SAMPLE // 3, 1) if by_libraries else SAMPLE):
        found = accepted(*mutated_bytes(originals, kind, change, number, tmp_path))
        if found is not None:
            check_sound(found[1])


@pytest.mark.parametrize("change", AS_MESH)
def test_mutated_meshes(change, tmp_path):
    """
    requirement: meshes that are spoilt as such are refused, or are meshes still.
    """
    for number in range(2 * SAMPLE):
        found = accepted(mutated_mesh(change, number, tmp_path), NAMES)
        if found is not None:
            check_sound(found[1])
        assert found is not None or change not in HARMLESS


@pytest.mark.slow
@pytest.mark.parametrize("change", AS_MESH)
def test_contact_of_mutated_meshes(change, tmp_path):
    """
    requirement: of 200 mutated meshes, each is refused in one line or solved: the force is carried,
    at a pressure that can be; harmless ones give the same one.
    """
    sound = tmp_path / "sound.msh"
    sound.write_text(msh(BASE))
    known = check_solved(case(sound, NAMES), np.inf)
    for number in range(max(12, SAMPLE)):
        found = accepted(mutated_mesh(change, number, tmp_path), NAMES)
        pressure = None if found is None else check_solved(found[0], 200e9)
        if change in HARMLESS:
            assert pressure == pytest.approx(known, rel=1e-9)

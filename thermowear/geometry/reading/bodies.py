"""Meshes of bodies from one file or a file each, with their named surfaces and cell sets."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from ...errors import CaseError
from ..mesh.curved import curved
from ..mesh.mixed import AnyMesh
from .assembly import assemble, divided
from .contents import MeshContents, joined
from .file_contents import read_contents
from .named import Named


def read_bodies(
    path: str | None,
    paths: Mapping[str, str],
    dim: int,
    length_unit: float,
    cells: Mapping[str, tuple[str, ...]],
    surfaces: Sequence[Named],
    with_material: Mapping[str, Mapping[str, str]],
    smooth: Sequence[str] = (),
) -> AnyMesh:
    """Read bodies, the nodes of each apart from those of the others.

    Parameters
    ----------
    path : str or None
        File of all bodies.
    paths : mapping of str to str
        Files by body instead, in the order of the bodies.
    dim : int
        Dimension of the bodies.
    length_unit : float
        Length of one unit of the files [m].
    cells : mapping of str to tuple of str
        Cell sets of each body.
    surfaces : sequence of Named
    with_material : mapping of str to mapping of str to str
        Cell sets that become parts of their own, by body, with the paths of their tables.
    smooth : sequence of str
        Surfaces that are curved, see `curved.curved`.

    Raises
    ------
    CaseError
        One line, reported at the key at fault.
    """
    contents = _contents(path, {body: paths[body] for body in cells if paths}, dim)
    contents = replace(contents, points=contents.points * length_unit)
    mesh = bodies_in(contents, cells, surfaces, with_material)
    return curved(mesh, smooth, "geometry.curved") if smooth else mesh


def has_surface(name: str, path: str | None, paths: Mapping[str, str], dim: int) -> bool:
    """Test whether files can be read and name a surface, see `read_bodies`."""
    try:
        contents = _contents(path, paths, dim)
    except CaseError:
        return False
    return contents.spelled(name) in (*contents.names(dim - 1), *contents.node_sets)


def bodies_in(
    contents: MeshContents,
    cells: Mapping[str, tuple[str, ...]],
    surfaces: Sequence[Named],
    with_material: Mapping[str, Mapping[str, str]],
) -> AnyMesh:
    """Mesh of bodies from contents in metres, see `read_bodies`."""

    def in_file(parts: Iterable[Named]) -> list[Named]:
        return [replace(of, sets=tuple(map(contents.spelled, of.sets))) for of in parts]

    bodies = [
        Named(body, sets, f"geometry.bodies.{body}", index)
        for index, (body, sets) in enumerate(cells.items())
    ]
    parts = [
        Named(f"{body}.{name}", (name,), key, index)
        for index, body in enumerate(cells)
        for name, key in with_material.get(body, {}).items()
    ]
    bodies, parts = in_file(bodies), in_file(parts)
    return divided(assemble(contents, bodies, in_file(surfaces)), contents, bodies, parts)


def _contents(path: str | None, paths: Mapping[str, str], dim: int) -> MeshContents:
    """Contents of the file, or of those of all bodies."""
    if path is not None:
        return read_contents(Path(path), dim)
    each = [read_contents(Path(of), dim, f"geometry.paths.{b}") for b, of in paths.items()]
    return joined(each)

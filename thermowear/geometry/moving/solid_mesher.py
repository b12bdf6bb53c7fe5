"""Program that fills closed surfaces with tetrahedra by gmsh, run by `remeshed_solid`.

Started by its path in a process of its own, so that this package is not imported: on a surface
that intersects itself gmsh may crash or not terminate. Reads arrays from the standard input and
writes arrays to the standard output, both as ``.npz``.

Input: ``points`` (n, 3), ``triangles`` (m, 3) of all shells, ``shell`` (m,) of each triangle, and
``volume`` (n_shells,) that each shell bounds; shells and volumes numbered from 0, the outer shell
of a volume first. ``settings``: algorithm of gmsh, and quality below which it optimises cells.
Output: ``points``, first the given ones, ``cells`` (n_cells, 4) and ``volume`` (n_cells,).
"""

from __future__ import annotations

import io
import os
import sys

import numpy as np

_TRIANGLE, _TETRAHEDRON = 2, 4
"""Element types of gmsh."""


def fill(points, triangles, shell, volume, settings) -> dict[str, np.ndarray]:
    """Tetrahedra inside of shells."""
    import gmsh

    gmsh.initialize(["-noenv"], interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.Algorithm3D", int(settings[0]))
    gmsh.option.setNumber("Mesh.OptimizeThreshold", float(settings[1]))
    gmsh.option.setNumber("Mesh.Renumber", 0)
    model = gmsh.model
    model.add("worn body")
    _draw(model, points, triangles, shell)
    for number in np.unique(volume):
        loops = [model.geo.addSurfaceLoop([int(k) + 1]) for k in np.flatnonzero(volume == number)]
        model.geo.addVolume(loops, int(number) + 1)
    model.geo.synchronize()
    model.mesh.generate(3)
    return _read(model, len(points), np.unique(volume))


def _draw(model, points, triangles, shell) -> None:
    """Add the triangles as discrete surfaces."""
    drawn = np.zeros(len(points), dtype=bool)
    for number in np.unique(shell):
        own = triangles[shell == number] + 1
        nodes = np.unique(own)
        nodes = nodes[~drawn[nodes - 1]]
        drawn[nodes - 1] = True
        model.addDiscreteEntity(2, int(number) + 1)
        model.mesh.addNodes(2, int(number) + 1, nodes, points[nodes - 1].ravel())
        model.mesh.addElementsByType(int(number) + 1, _TRIANGLE, [], own.ravel())


def _read(model, given: int, volumes) -> dict[str, np.ndarray]:
    """Nodes and tetrahedra of a meshed model."""
    numbers, places, _ = model.mesh.getNodes()
    numbers = numbers.astype(np.int64)
    points = np.full((int(numbers.max()), 3), np.nan)
    points[numbers - 1] = places.reshape(-1, 3)
    parts = [
        model.mesh.getElementsByType(_TETRAHEDRON, int(number) + 1)[1].reshape(-1, 4)
        for number in volumes
    ]
    cells = np.concatenate(parts).astype(np.int64) - 1
    row = np.full(len(points), -1)
    row[:given] = np.arange(given)
    added = np.setdiff1d(cells, np.arange(given))
    row[added] = given + np.arange(len(added))
    return {
        "points": np.concatenate([points[:given], points[added]]),
        "cells": row[cells],
        "volume": np.repeat(volumes, [len(part) for part in parts]),
    }


def main() -> int:
    """Write the tetrahedra, or one line with the reason of a failure."""
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # output of gmsh goes to stderr
    packed = io.BytesIO()
    try:
        with np.load(io.BytesIO(sys.stdin.buffer.read()), allow_pickle=False) as given:
            found = fill(**given)
        np.savez(packed, allow_pickle=False, **found)
    except Exception as error:  # gmsh raises plain Exception
        sys.stderr.write("\n" + (" ".join(str(error).split()) or type(error).__name__))
        return 1
    out.write(packed.getbuffer())
    out.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Export of a design as a mesh with moved contact face and nodal displacements."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from ..mesh.orders import quadratic
from ..mesh.tagged import TaggedMesh
from ..moving.moved import Extension
from ..reading.export import write_mesh
from .design import Design
from .worn_body import moved_body


def write_design_mesh(
    mesh: TaggedMesh, design: Design, face: str, path: Path, extension: Extension
) -> None:
    """Write the mesh of a body whose contact face has a worn shape.

    Straight-sided cells become quadratic to follow the shape; .vtu supports no higher order.
    ``displacement_m`` holds the displacement of the nodes.

    Parameters
    ----------
    mesh : TaggedMesh
        Mesh of the unworn body.
    design : Design
    face : str
        Name of its contact face.
    path : Path
    extension : callable
        Factory of harmonic extensions, see `moved_body`.

    Raises
    ------
    CaseError
        If the file cannot be written.
    """
    if mesh.order == 1 or (path.suffix == ".vtu" and mesh.order > 2):
        mesh = quadratic(mesh)
    points = moved_body(mesh, design, face, extension)
    told = np.pad(points - mesh.points, ((0, 0), (0, 3 - points.shape[1])))
    write_mesh(replace(mesh, points=points), path, {"displacement_m": told})

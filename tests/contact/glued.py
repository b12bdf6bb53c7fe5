"""Boxes that are glued to each other, in the plane and in space, for tests."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from mpi4py import MPI

import numpy as np

from thermowear.bulk.bodies import Bodies, distribute
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.heat.heat_equation import ThermalMaterial, conduction
from thermowear.bulk.kinematics import Kinematics, PlaneStrain, Spatial
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.contact.faces.face import gather_faces
from thermowear.contact.ties import elastic_joints, glued_points, thermal_joints
from thermowear.geometry.mesh.mixed import joined
from thermowear.geometry.meshing.cells import (
    Sheet,
    divided_hexahedra,
    grid,
    mesh_body,
    mesh_lattice,
    tagged_bodies,
)

from ..bulk.fields import empty_matrix

COMM = MPI.COMM_WORLD
PLANE = PlaneStrain(0.01)


class Box(NamedTuple):
    """Box by its name, its ends along each axis [m], and the elements along each of them.

    Surfaces are ``name_low_x``, ``name_high_x`` and so on.
    """

    name: str
    ends: tuple[tuple[float, float], ...]
    counts: tuple[int, ...]


def boxes(*given: Box, order=1, cells="quadrilateral", place=np.asarray) -> Bodies:
    """Distributed meshes of boxes, placed by a map of their coordinates; see `tagged_boxes`."""
    tagged = tagged_boxes(given, order, cells, place) if COMM.rank == 0 else None
    return distribute(tagged, COMM)


def tagged_boxes(given, order=1, cells="quadrilateral", place=np.asarray):
    """Mesh of boxes; cells of one kind, or of a kind for each box."""
    if not isinstance(cells, str):
        pairs = zip(given, cells, strict=True)
        return joined([tagged_boxes([box], order, kind, place) for box, kind in pairs])
    meshed, claims = {}, {}
    for name, ends, counts in given:
        lines = [np.linspace(*span, n + 1) for span, n in zip(ends, counts, strict=True)]
        if len(lines) == 2:
            meshed[name] = mesh_body([Sheet(grid(*lines))], order)
        else:
            meshed[name] = mesh_lattice(lines, order)
        if cells == "tetrahedron":
            meshed[name] = divided_hexahedra(meshed[name], order)
        for axis, (letter, span) in enumerate(zip("xyz", ends, strict=False)):
            for side, value in zip(("low", "high"), span, strict=True):
                claims[f"{name}_{side}_{letter}"] = _level(axis, value)
    tagged = tagged_bodies(meshed, claims)
    if cells == "triangle":
        halves = np.concatenate([tagged.cells[:, [0, 1, 2]], tagged.cells[:, [0, 2, 3]]])
        tagged = replace(tagged, cells=halves, cell_tags=np.tile(tagged.cell_tags, 2))
    return replace(tagged, cell_type=cells, points=place(tagged.points))


def _level(axis, value):
    return lambda p: np.all(np.abs(p[..., axis] - value) < 1e-9, axis=1)


def turned(angle):
    """Rotation about the last axis, after one about the first in space."""
    c, s = np.cos(angle), np.sin(angle)

    def place(p):
        if p.shape[1] == 2:
            return p @ np.array([[c, s], [-s, c]])
        about_z = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
        return p @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]]) @ about_z

    return place


def kinematics_of(bodies: Bodies) -> Kinematics:
    """Spatial or plane-strain kinematics by the dimension."""
    return Spatial() if bodies.dim == 3 else PLANE


def ties_of(bodies, degree, pairs, kinematics=None):
    """Pairs of points of pairs of surfaces."""
    chosen = kinematics or kinematics_of(bodies)
    return [glued_points(*gather_faces(bodies, pair), chosen, degree) for pair in pairs]


def glued_elasticity(bodies, degree, pairs, materials, clamped, kinematics=None, **supports):
    """Elasticity of bodies glued at pairs of surfaces, and the ties."""
    chosen = kinematics or kinematics_of(bodies)
    ties = ties_of(bodies, degree, pairs, chosen)
    materials = {name: ElasticMaterial(*values) for name, values in materials.items()}
    joints = lambda spaces: elastic_joints(spaces, ties)  # noqa: E731
    return elasticity(bodies, chosen, degree, materials, clamped, joints=joints, **supports), ties


def glued_conduction(
    bodies, degree, pairs, conductances, materials, given, cooling=None, kinematics=None
):
    """Conduction in bodies glued at pairs of surfaces, and the ties."""
    chosen = kinematics or kinematics_of(bodies)
    ties = ties_of(bodies, degree, pairs, chosen)
    spaces = lagrange_spaces(bodies, degree)
    joints = thermal_joints(spaces, ties, conductances)
    materials = {name: ThermalMaterial(*values) for name, values in materials.items()}
    nothing = empty_matrix(spaces)
    known = bodies, chosen, spaces, materials, cooling or {}, given, nothing
    return conduction(*known, joints=joints), ties

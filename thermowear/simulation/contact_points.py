"""Where the faces of a case are integrated: contact points and pressure space."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..bulk.kinematics import Model
from ..case.schema import Case
from ..contact.face import Face
from ..contact.pairing import Pairing, pair
from ..contact.pressure import pressure_basis
from ..laws.motions import RigidMotion
from .initial_shape import initial_gap
from .worn_geometry import WornGeometry

_SLIVER = 1e-3
"""Of a facet: so near to its ends, facets that matched when they were new meet worn ones."""


def contact_points(case: Case, comm, model: Model, face_1, face_2) -> tuple[Pairing, np.ndarray]:
    """Contact points, with the shape that body 1 starts from, and pressure space Ψ."""
    pairing, basis = _points(case, model, face_1, face_2)
    if case.geometry.initial_shape is not None:
        gap = initial_gap(comm, case.geometry.initial_shape, pairing)
        pairing = replace(pairing, gap=gap)
    return pairing, basis


def worn_contact_points(
    case: Case, model: Model, worn: WornGeometry, face_1: Face, face_2: Face
) -> tuple[Pairing, np.ndarray]:
    """The same of worn faces, paired where body 1 has got to; the gap is that of unworn faces."""
    moved, turned = worn.holder
    motion = RigidMotion(moved, turned, np.zeros(3))
    closer = replace(face_1, nodes=face_1.nodes + motion.at(face_1.nodes))
    pairing, basis = _points(case, model, closer, face_2, _SLIVER)
    first, second = pairing.sides
    points = face_1.points(first.facet, first.t)
    apart = np.einsum("ni,ni->n", pairing.normals, motion.at(points))
    unworn = worn.carried(worn.lacking - worn.depth.sum(axis=0), pairing)
    return replace(
        pairing,
        points=points,
        gap=pairing.gap + apart + unworn,
        sides=(replace(first, face=face_1), second),
    ), basis


def _points(
    case: Case, model: Model, face_1, face_2, sliver: float = 1e-9
) -> tuple[Pairing, np.ndarray]:
    """Contact points of two faces, and pressure space Ψ."""
    degree, pressure_degree = case.mesh.degree, case.contact.pressure_degree
    if pressure_degree == "lobatto":  # point by point, at the nodes of body 1's facets
        pairing = pair(face_1, face_2, model, degree + 1, refine=False)
        return pairing, np.eye(len(pairing.weights))
    pairing = pair(face_1, face_2, model, degree + 2, sliver=sliver)
    return pairing, pressure_basis(pairing, pressure_degree or max(degree - 1, 1))

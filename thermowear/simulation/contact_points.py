"""Where the faces of a case are integrated: contact points, pressure space, parts that touch."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..bulk.bodies import Bodies
from ..bulk.kinematics import Model
from ..case.facing import Facing
from ..case.schema import Case
from ..contact.face import Face
from ..contact.facets import parts_of_facets
from ..contact.pairing import Pairing, pair, paired
from ..contact.pressure import pressure_basis
from ..contact.projection import ahead
from ..contact.refinement import BESIDE
from ..contact.surface import Surface
from ..contact.worn_face import ways_at
from ..laws.motions import RigidMotion
from .initial_shape import initial_gap
from .worn_geometry import WornGeometry

_SLIVER = 1e-3
"""Of a facet: so near to its ends, facets that matched when they were new meet worn ones."""
_ALONG = 0.05
"""Of a face: so far a holder may take it along the other one, past its end."""


def contact_points(case: Case, comm, model: Model, face_1, face_2) -> tuple[Pairing, np.ndarray]:
    """Contact points, with the shape that body 1 starts from, and pressure space Ψ."""
    pairing, basis = _points(case, model, face_1, face_2)
    if case.geometry.initial_shape is not None:
        gap = initial_gap(comm, case.geometry.initial_shape, pairing)
        pairing = replace(pairing, gap=gap)
    return pairing, basis


def worn_contact_points(
    case: Case, model: Model, worn: WornGeometry, face_1: Face | Surface, face_2: Face | Surface
) -> tuple[Pairing, np.ndarray]:
    """The same of worn faces, paired where body 1 has got to; the gap is that of unworn faces.

    It is measured between points that lie opposite along the ways on which the nodes have gone:
    meshes that move open it by just the depths that they lose, even where the faces are slanted
    against each other. They are where a mesh cannot follow the edge of its wear: they overlap by
    what is kept of it. Closest points or those along the normals would change the gap there.
    """
    moved, turned = worn.holder
    motion = RigidMotion(moved, turned, np.zeros(3))
    closer = replace(face_1, nodes=face_1.nodes + motion.at(face_1.nodes))
    if worn.pieces is None:
        pairing, basis = _points(case, model, closer, face_2, _SLIVER, _beside(worn, face_1))
    else:
        pairing = paired(closer, face_2, model, worn.pieces)
        basis = _basis(case, pairing)
    first, second = pairing.sides
    points = face_1.points(first.facet, first.t)
    to = motion.at(points)
    apart = np.einsum("ni,ni->n", pairing.normals, to)
    ways = _ways(worn, pairing)
    facet, t, way = ahead(face_2, points + to, ways)
    gap = way * np.einsum("ni,ni->n", pairing.normals, ways)
    sides = replace(first, face=face_1), replace(second, facet=facet, t=t)
    worn_pairing = replace(pairing, points=points, sides=sides)
    unworn = worn.carried(worn.lacking, pairing) - worn.moved(worn_pairing).sum(axis=0)
    return replace(worn_pairing, gap=gap + apart + unworn), basis


def _ways(worn: WornGeometry, pairing: Pairing) -> np.ndarray:
    """Ways on which body 2 lies opposite, unit vectors at the points, shape (n, gdim).

    Those out of body 1 and into body 2 of the nodes, by how far each face has gone.
    """
    out_1, out_2 = (
        ways_at(side, directions)
        for side, directions in zip(pairing.sides, worn.directions, strict=True)
    )
    gone_1, gone_2 = np.abs(worn.depth).max(axis=1)
    ways = gone_1 * out_1 - gone_2 * out_2
    return ways / np.linalg.norm(ways, axis=1, keepdims=True)


def _beside(worn: WornGeometry, face_1: Face | Surface) -> float:
    """How far a face may get beside the other one, of its size.

    Not at all where it has reached beyond it from the beginning. Where it has not, it is its holder
    that has taken it along, over a body that goes on.
    """
    opposite = worn.at[0] == 0.0 and worn.at[-1] == len(face_1.nodes)
    return _ALONG if opposite else BESIDE


def _points(
    case: Case, model: Model, face_1, face_2, sliver: float = 1e-9, beside: float = BESIDE
) -> tuple[Pairing, np.ndarray]:
    """Contact points of two faces, and pressure space Ψ."""
    degree, pressure_degree = case.mesh.degree, case.contact.pressure_degree
    if pressure_degree == "lobatto":  # point by point, at the nodes of body 1's facets
        pairing = pair(face_1, face_2, model, degree + 1, refine=False)
        return pairing, np.eye(len(pairing.weights))
    pairing = pair(face_1, face_2, model, degree + 2, sliver=sliver, beside=beside)
    return pairing, _basis(case, pairing)


def _basis(case: Case, pairing: Pairing) -> np.ndarray:
    """Pressure space Ψ, by default a degree below the displacement."""
    degree = case.contact.pressure_degree
    assert degree != "lobatto"
    return pressure_basis(pairing, degree or max(case.mesh.degree - 1, 1))


def facing_parts(bodies: Bodies, pairing: Pairing) -> Facing:
    """The parts of both bodies that touch at the contact points. Every rank calls."""
    first, second = (parts_of_facets(bodies, side.face)[side.facet] for side in pairing.sides)
    return Facing(bodies.names, (first, second))

"""Two bodies in space, one on the other, for tests."""

from __future__ import annotations

from dataclasses import replace

from mpi4py import MPI

import numpy as np

from thermowear.bulk.bodies import distribute
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.kinematics import Spatial
from thermowear.contact.faces.face import gather_face
from thermowear.contact.operators.condensation import condense, gap_trace
from thermowear.contact.operators.pressure import pressure_basis
from thermowear.contact.operators.rigid_motion import RigidMode, hold
from thermowear.contact.search.pairing import Contacts, pair
from thermowear.geometry.meshing.cells import divided_hexahedra, mesh_lattice, tagged_bodies
from thermowear.laws.motions import translation

COMM = MPI.COMM_WORLD
SIZE, HEIGHTS = (0.04, 0.03), (0.02, 0.03)
MODULI = {"upper": 2e11, "lower": 7e10}
MATCHING = ((3, 3, 2), (3, 3, 2))


def straight(p):
    return p


def skewed(p):
    """Boxes become parallelepipeds."""
    x, y, z = np.moveaxis(p, -1, 0)
    return np.stack([x + 0.3 * y, y + 0.2 * x, z], axis=-1)


def turned(p):
    """The first coordinate becomes a radius, the second an angle: a quarter of a ring."""
    x, y, z = np.moveaxis(p, -1, 0)
    r, angle = 0.05 + x, y / SIZE[1] * np.pi / 2
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1)


def bent(p):
    """A smooth distortion that keeps the outer faces of the boxes."""
    x, y, z = np.moveaxis(p, -1, 0)
    within = np.sin(np.pi * x / SIZE[0]) * np.sin(np.pi * y / SIZE[1])
    rows = np.sin(np.pi * z / np.where(z > 0, *HEIGHTS))
    moved = 2e-3 * within * np.cos(60 * y), 1.5e-3 * within * np.cos(50 * x + 1)
    return np.stack(
        [x + moved[0], y + moved[1], z + 1e-3 * rows * np.cos(50 * x + 40 * y)], axis=-1
    )


def two_solids(divisions=MATCHING, order=1, maps=(straight, straight), cell_type="hexahedron"):
    """Two boxes, mapped. Surfaces of ``upper`` are ``upper_face``, ``upper_end``, ``upper_low_x``,
    ``upper_high_x`` and so on by the parameters before they are mapped; of ``lower`` likewise.
    """
    bodies, claims, points = {}, {}, []
    spans = {"upper": (0.0, HEIGHTS[0]), "lower": (-HEIGHTS[1], 0.0)}
    for (name, span), counts, place in zip(spans.items(), divisions, maps, strict=True):
        limits = ((0.0, SIZE[0]), (0.0, SIZE[1]), span)
        ends = tuple(np.linspace(*limit, n + 1) for limit, n in zip(limits, counts, strict=True))
        body = mesh_lattice(ends, order, straight)
        bodies[name] = body if cell_type == "hexahedron" else divided_hexahedra(body, order)
        points.append(place(bodies[name].points))
        levels = {"face": (2, 0.0), "end": (2, sum(span))}
        for axis, letter in enumerate("xy"):
            levels |= {f"low_{letter}": (axis, 0.0), f"high_{letter}": (axis, SIZE[axis])}
        claims |= {f"{name}_{surface}": _claim(*level) for surface, level in levels.items()}
    tagged = replace(tagged_bodies(bodies, claims), cell_type=cell_type)
    return replace(tagged, points=np.concatenate(points))


def _claim(axis, value):
    return lambda p: np.all(np.abs(p[..., axis] - value) < 1e-9, axis=1)


def gathered(tagged):
    """Distributed bodies and their faces."""
    bodies = distribute(tagged if COMM.rank == 0 else None, COMM)
    return bodies, (gather_face(bodies, "upper_face"), gather_face(bodies, "lower_face"))


def elastic_bodies(bodies, degree, poisson_ratio=0.0, expansion=0.0, **supports):
    materials = {name: ElasticMaterial(E, poisson_ratio, expansion) for name, E in MODULI.items()}
    return elasticity(bodies, Spatial(), degree, materials, ["upper_end", "lower_end"], **supports)


def condensed(tagged, degree, poisson_ratio=0.0, force=1.0, rigid_modes=None, **supports):
    """The pairing, the holder and the condensed contact of two bodies pressed on each other."""
    bodies, faces = gathered(tagged)
    elastic = elastic_bodies(bodies, degree, poisson_ratio, **supports)
    pairing = pair(*faces, Spatial(), degree + 2)
    trace = gap_trace(elastic.spaces, Contacts((pairing,)))
    basis = pressure_basis(pairing, max(degree - 1, 1))
    rigid_modes = rigid_modes or [RigidMode(translation((0.0, 0.0, -1.0)), load=force)]
    holder = hold(Contacts((pairing,)), pairing.normals, rigid_modes)
    return pairing, holder, condense(elastic, pairing.weights, trace, trace, basis, holder)

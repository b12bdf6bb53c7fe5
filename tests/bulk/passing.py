"""Bodies that pass: a strip and a ring alone, and conduction in them."""

from mpi4py import MPI

import numpy as np

from thermowear.bulk.bodies import distribute
from thermowear.bulk.heat.advection import Passage
from thermowear.bulk.heat.heat_equation import ThermalMaterial, conduction
from thermowear.bulk.kinematics import PlaneStrain
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.geometry.meshing.cells import Sheet, grid, mesh_body, tagged_bodies
from thermowear.geometry.meshing.rings import Polar

from .fields import empty_matrix

COMM = MPI.COMM_WORLD
STEEL = ThermalMaterial(50.0, 2e6)
INNER, OUTER = 0.01, 0.02


def strip(columns=4, rows=4, length=0.02, height=0.01, bend=0.0):
    """Rectangle with a corner at the origin; inner cells are curved if `bend` is not zero."""

    def place(p):
        x, y = p[..., 0] * length, p[..., 1] * height
        wave = bend * np.sin(np.pi * p[..., 0]) * np.sin(np.pi * p[..., 1])
        return np.stack([x + wave * length, y - 0.7 * wave * height], axis=-1)

    sheet = Sheet(grid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1)), place)
    body = mesh_body([sheet], 3 if bend else 1)
    eps = 1e-9
    surfaces = {
        "strip_left": lambda p: np.all(p[..., 0] < eps, axis=1),
        "strip_right": lambda p: np.all(p[..., 0] > length - eps, axis=1),
        "strip_bottom": lambda p: np.all(p[..., 1] < eps, axis=1),
        "strip_top": lambda p: np.all(p[..., 1] > height - eps, axis=1),
    }
    return _distributed({"strip": body}, surfaces)


def ring(columns=24, rows=3):
    """Ring of curved cells about the origin."""
    angles, radii = np.linspace(0, 2 * np.pi, columns + 1), np.linspace(INNER, OUTER, rows + 1)
    at = Polar()
    surfaces = {
        "ring_rim": at.circle(OUTER),
        "ring_bore": at.circle(INNER),
    }
    return _distributed({"ring": mesh_body([at.sheet(angles, radii)], 3)}, surfaces)


def _distributed(bodies, surfaces):
    return distribute(tagged_bodies(bodies, surfaces) if COMM.rank == 0 else None, COMM)


def along(speed):
    return Passage(("strip",), None, speed, spread=False)


def turning(speed, spread=False):
    return Passage(("ring",), (0.0, 0.0), speed, spread)


def conducting(bodies, degree, passage=None, given=None, cooling=None, material=STEEL):
    """Conduction, a metre thick, without a bath."""
    spaces = lagrange_spaces(bodies, degree)
    nothing = empty_matrix(spaces)
    materials = dict.fromkeys(bodies.names, material)
    return conduction(
        bodies, PlaneStrain(1.0), spaces, materials, cooling or {}, given or {}, nothing, passage
    )


def total(values):
    return COMM.allreduce(float(np.sum(values)))


def largest(values):
    return max(COMM.allgather(float(np.abs(values).max(initial=0.0))))

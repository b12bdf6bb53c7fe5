"""Parts of a body in space that have materials of their own."""

from dataclasses import replace

from mpi4py import MPI

import numpy as np

from thermowear.bulk.bodies import distribute
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.kinematics import Spatial
from thermowear.geometry.meshing.cells import level, mesh_lattice, tagged_bodies

COMM = MPI.COMM_WORLD
ENDS = (np.linspace(0.0, 0.02, 3), np.linspace(0.0, 0.01, 3), np.array([0.0, 0.01, 0.03, 0.04]))


def bar():
    """Bar of three layers of 10, 20 and 10 mm, the middle one a part, loaded at its top."""
    body = mesh_lattice(ENDS, 1)
    middles = body.points[body.cells].mean(axis=1)[:, 2]
    body = replace(body, zones={"core": np.flatnonzero((middles > 0.01) & (middles < 0.03))})
    surfaces = {"bar_bottom": level(2, 0.0), "bar_top": level(2, 0.04)}
    return tagged_bodies({"bar": body}, surfaces)


def test_layers_in_series():
    """requirement: each layer is compressed by p h/E under a pressure on the top."""
    bodies = distribute(bar() if COMM.rank == 0 else None, COMM)
    materials = {"bar": ElasticMaterial(2e9, 0.0), "core": ElasticMaterial(5e10, 0.0)}
    elastic = elasticity(bodies, Spatial(), 2, materials, ["bar_bottom"])
    u = elastic.solve(elastic.spaces.loads(elastic.pressure_work("bar_top", 3e6))).reshape(-1, 3)
    top = np.abs(elastic.nodes()[:, 2] - 0.04) < 1e-12
    np.testing.assert_allclose(u[top, 2], -3e6 * (0.02 / 2e9 + 0.02 / 5e10), rtol=1e-9)
    (body,) = bodies.each
    parts = body.parts_of_cells(np.arange(body.n_cells))
    assert COMM.allreduce(int(parts.sum())) == 4
    assert bodies.names == ("bar", "core")
    assert COMM.allreduce(len(parts)) == 12

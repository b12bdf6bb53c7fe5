"""Fields of bodies as functions on the user's meshes."""

from dataclasses import replace

from mpi4py import MPI

import basix.ufl
import dolfinx
import numpy as np
import pytest
from dolfinx.mesh import locate_entities_boundary, meshtags

import thermowear as tw

WIDTH, HEIGHT, FORCE, THICKNESS = 0.02, 0.01, 1e4, 0.01
MODULI = {"upper": 200e9, "lower": 100e9}


def block(bottom, reverse, gdim):
    """Triangles of a block, every other one clockwise; facets 7 below, 8 above, 9 at the sides."""
    n = 3
    x = [(WIDTH * i / n, bottom + HEIGHT * j / n, 0.0) for j in range(n + 1) for i in range(n + 1)]
    corners = [(j * (n + 1) + i) for j in range(n) for i in range(n)]
    cells = np.array(
        [c for k in corners for c in ((k, k + 1, k + n + 2), (k, k + n + 2, k + n + 1))]
    )
    if reverse:
        cells[::2] = cells[::2][:, [0, 2, 1]]
    element = basix.ufl.element("Lagrange", "triangle", 1, shape=(gdim,))
    points = np.array(x)[:, :gdim]
    mesh = dolfinx.mesh.create_mesh(MPI.COMM_SELF, cells=cells, x=points, e=element)
    places = {
        7: lambda x: np.isclose(x[1], bottom),
        8: lambda x: np.isclose(x[1], bottom + HEIGHT),
    }
    found = {tag: locate_entities_boundary(mesh, 1, at) for tag, at in places.items()}
    mesh.topology.create_connectivity(1, 2)
    facets = np.concatenate(list(found.values()))
    tags = np.repeat(np.array(list(found), np.int32), [len(f) for f in found.values()])
    order = np.argsort(facets)
    return mesh, meshtags(mesh, 1, facets[order], tags[order])


@pytest.mark.parametrize(("reverse", "gdim"), [(False, 2), (True, 3)])
def test_linear_fields(reverse, gdim):
    """requirement: T and u at every node of the user's mesh, whatever the cells' orientation.

    Two blocks of a material without lateral contraction, heated above and cooled below.
    """
    bodies = {}
    for name, bottom in (("lower", -HEIGHT), ("upper", 0.0)):
        mesh, facets = block(bottom, reverse, gdim)
        material = tw.Material(MODULI[name], 0.0, conductivity=50.0)
        sides = {"fixed": 7} if name == "lower" else {}
        bodies[name] = tw.Body(name, mesh, None, facets, material, **sides)
    upper, lower = bodies["upper"], bodies["lower"]
    face = tw.Interface(lower.surface(8), upper.surface(7), wear={upper: tw.PowerWear(1e-15)})
    model = tw.Model(
        [face],
        [tw.Holder(upper.surface(8), force=FORCE)],
        heat=tw.Heat(temperature={upper.surface(8): "60 degC", lower.surface(7): "20 degC"}),
        kinematics="plane-strain",
        thickness=THICKNESS,
        degree=3,
    )
    found = model.initial()
    for name, body in bodies.items():
        T, u = found.temperature(body), found.displacement(body)
        assert T.function_space.mesh is body.mesh
        y = T.function_space.tabulate_dof_coordinates()[:, 1]
        at = (y + HEIGHT) / (2 * HEIGHT)
        np.testing.assert_allclose(T.x.array, 293.15 + 40 * at, rtol=1e-10)
        y = u.function_space.tabulate_dof_coordinates()[:, 1]
        stress = FORCE / WIDTH / THICKNESS
        moved = -stress * (np.minimum(y, 0) + HEIGHT) / MODULI["lower"]
        if name == "upper":
            moved -= stress * y / MODULI["upper"]
        expected = np.zeros((len(y), gdim))
        expected[:, 1] = moved
        np.testing.assert_allclose(
            u.x.array.reshape(-1, gdim), expected, atol=1e-9 * np.abs(moved).max()
        )
    assert np.mean(found.pressure(face)) == pytest.approx(stress, rel=1e-9)
    with pytest.raises(tw.CaseError, match="no heat"):
        replace(model, heat=None).initial().temperature(upper)

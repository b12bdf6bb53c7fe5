"""Normal traction of body 1 at the contact points."""

from dataclasses import replace

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.bulk.bodies import distribute
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.kinematics import kinematics_of
from thermowear.contact.faces.face import gather_face
from thermowear.contact.full.nitsche import (
    normal_traction,
    on_every_facet,
    thermal_traction,
)
from thermowear.contact.search.pairing import pair
from thermowear.geometry.mesh.gmsh_session import gmsh_model
from thermowear.parallel import sum_over_ranks

from ..bulk.fields import interpolated
from ..gmsh_meshes import tagged_mesh

COMM = MPI.COMM_WORLD
MATERIALS = {
    "upper": ElasticMaterial(2e11, 0.3, 1.2e-5),
    "lower": ElasticMaterial(7e10, 0.2, 2e-5),
}
MODELS = ["axisymmetric", "plane-strain", "plane-stress"]


def bent(points):
    """A smooth distortion that keeps the axis x = 0."""
    x, y = points.T
    return np.column_stack([x * (1 + 4 * y), y + 1e-3 * np.sin(60 * x) * (1 + 30 * y)])


def deformed_blocks(kind, order, inner=0.05, columns=(3, 4)):
    """Two blocks one above the other, of distorted or (order > 1) curved cells."""
    with gmsh_model("blocks") as gmsh:
        geo, groups = gmsh.model.geo, []
        for low, high, count in ((0.0, 0.02, columns[0]), (-0.02, 0.0, columns[1])):
            corners = [(inner, low), (inner + 0.04, low), (inner + 0.04, high), (inner, high)]
            points = [geo.addPoint(*corner, 0) for corner in corners]
            lines = [geo.addLine(points[i], points[(i + 1) % 4]) for i in range(4)]
            for line, elements in zip(lines, (count, 2, count, 2), strict=True):
                geo.mesh.setTransfiniteCurve(line, elements + 1)
            surface = geo.addPlaneSurface([geo.addCurveLoop(lines)])
            if kind == "quadrilateral":
                geo.mesh.setTransfiniteSurface(surface)
                geo.mesh.setRecombine(2, surface)
            groups.append((surface, lines))
        geo.synchronize()
        for name, (surface, lines), face in zip(MATERIALS, groups, (0, 2), strict=True):
            gmsh.model.addPhysicalGroup(2, [surface], name=name)
            gmsh.model.addPhysicalGroup(1, [lines[face]], name=f"{name}_face")
            gmsh.model.addPhysicalGroup(1, [lines[2 - face]], name=f"{name}_end")
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(order)
        surfaces = ("upper_face", "upper_end", "lower_face", "lower_end")
        tagged = tagged_mesh(gmsh.model, tuple(MATERIALS), surfaces)
    return replace(tagged, points=bent(tagged.points))


def build(tagged, model, degree, materials=MATERIALS):
    bodies = distribute(tagged if COMM.rank == 0 else None, COMM)
    elastic = elasticity(bodies, model, degree, materials, ["upper_end", "lower_end"])
    faces = gather_face(bodies, "upper_face"), gather_face(bodies, "lower_face")
    return elastic, pair(*faces, model, degree + 2)


def traction_of(elastic, pairing, displacement):
    """S u of a field given at x of shape (3, n)."""
    own = interpolated(elastic.spaces, displacement)
    return sum_over_ranks(COMM, normal_traction(elastic, pairing).T @ own)


def along_common_face(pairing, gradient):
    """ε of the traction on the facets of body 1 along the normals of the common face, by its area.

    Facets that share a point have normals of their own there.
    """
    side, point, share = on_every_facet(pairing)
    n, own = pairing.normals[point], side.face.normals(side.facet, side.t)
    strain = (gradient + gradient.T) / 2
    across = np.einsum("ni,ij,nj->n", n, strain, own) / np.einsum("ni,ni->n", n, own)
    return np.bincount(point, share * across)


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("degree", [1, 2, 3, 4])
@pytest.mark.parametrize("kind", ["quadrilateral", "triangle"])
@pytest.mark.parametrize("order", [1, 2, 3])
def test_linear_fields_are_exact(kind, order, degree, name):
    """requirement: n·σn by Hooke's law of each model, on distorted and on curved cells."""
    model = kinematics_of(name, 0.01)
    elastic, pairing = build(deformed_blocks(kind, order), model, max(degree, order))
    H = 1e-3 * np.array([[1.0, -0.7], [0.4, 2.0]])
    found = traction_of(elastic, pairing, lambda x: H @ x[:2] + 1e-5)
    E, ν = MATERIALS["upper"].young_modulus, MATERIALS["upper"].poisson_ratio
    side = pairing.sides[0]
    points = side.face.points(side.facet, side.t)
    r = points[:, 0]
    hoop = (points @ H[0] + 1e-5) / r if name == "axisymmetric" else 0 * r
    if name == "plane-stress":
        hoop = -ν / (1 - ν) * np.trace(H) + 0 * r
    trace = np.trace(H) + hoop
    normal = along_common_face(pairing, H)
    expected = E / (1 + ν) * (normal + ν / (1 - 2 * ν) * trace)
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("kind", ["quadrilateral", "triangle"])
def test_on_the_axis(kind):
    """requirement: u_r / r has the limit du_r/dr on the axis."""
    tagged = deformed_blocks(kind, 2, inner=0.0)
    elastic, pairing = build(tagged, kinematics_of("axisymmetric", None), 3)
    assert pairing.points[:, 0].min() == 0.0
    found = traction_of(elastic, pairing, lambda x: np.stack([2e-3 * x[0], -1e-3 * x[1]]))
    E, ν = 2e11, 0.3
    normal = along_common_face(pairing, np.diag([2e-3, -1e-3]))
    expected = E / (1 + ν) * (normal + ν / (1 - 2 * ν) * 3e-3)
    np.testing.assert_allclose(found, expected, rtol=1e-11)


def test_smooth_fields_converge_at_shared_points():
    """requirement: the mean of two cells is a stress, to the degree's accuracy."""
    errors = []
    for columns in (4, 8):
        tagged = deformed_blocks("quadrilateral", 2, columns=(columns, columns))
        elastic, pairing = build(tagged, kinematics_of("plane-strain", 1.0), 2)
        found = traction_of(elastic, pairing, lambda x: np.stack([0 * x[0], np.sin(40 * x[0])]))
        n, E, ν = pairing.normals, 2e11, 0.3
        side = pairing.sides[0]
        slope = 40 * np.cos(40 * side.face.points(side.facet, side.t)[:, 0])
        errors.append(np.abs(found - E / (1 + ν) * n[:, 0] * n[:, 1] * slope).max())
    assert errors[1] < errors[0] / 3


@pytest.mark.parametrize("name", MODELS)
def test_thermal_part_is_that_of_body_1(name):
    """requirement: prevented expansion adds -E α ΔT/(1 - 2ν), in plane stress -E α ΔT/(1 - ν)."""
    model = kinematics_of(name, 0.01)
    elastic, pairing = build(deformed_blocks("triangle", 1), model, 1)
    per_kelvin = 2e11 * 1.2e-5 / (0.7 if name == "plane-stress" else 0.4)
    np.testing.assert_allclose(thermal_traction(elastic, pairing), per_kelvin, rtol=1e-12)

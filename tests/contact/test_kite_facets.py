"""Common refinement of facets that are far from parallelograms, as of subdivided tetrahedra."""

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.bulk.bodies import distribute
from thermowear.bulk.kinematics import Spatial
from thermowear.case.tables.mesh import MeshTable
from thermowear.case.values.section import MODEL
from thermowear.contact.faces.face import gather_faces
from thermowear.contact.search.clipping import parts_opposite
from thermowear.contact.search.pairing import pair
from thermowear.geometry.geometries.mesh_file import MeshFile

from ..solid_meshes import BLOCKS, PAD, write_blocks


@pytest.mark.parametrize("hexahedra", [(True, True), (True, False), (False, True)])
@pytest.mark.parametrize("orders", [(1, 1), (2, 1)])
def test_parts_of_facets_cover_them_once(tmp_path, hexahedra, orders):
    """
    requirement: gmsh's hexahedra (each tetrahedron cut into four) have facets whose bilinear map
    folds over beside them; whatever they meet, the parts fill each facet of body 1 without overlap.
    """
    paths = {
        body: str(write_blocks(tmp_path / f"{body}.msh", order, of_body, size=size))
        for body, of_body, order, size in zip(
            ("pad", "disk"), hexahedra, orders, (12.0, 9.0), strict=True
        )
    }
    tables = {"type": "file", "paths": paths, "length_unit": "1 mm"} | BLOCKS
    geometry = MeshFile.model_validate(tables, context={MODEL: "3d"})
    bodies = distribute(geometry.build(MeshTable(), None), MPI.COMM_WORLD)
    faces = gather_faces(bodies, ("PAD_FACE", "DISK_FACE"))
    facet, corners = parts_opposite(*faces)
    (x, y), (u, v) = corners.transpose(2, 0, 1), np.roll(corners, -1, axis=1).transpose(2, 0, 1)
    areas = np.sum(x * v - u * y, axis=1) / 2
    assert areas.min() > -1e-9
    covered = np.bincount(facet, areas) / faces[0].measure
    np.testing.assert_allclose(covered, 1.0, rtol=1e-12)
    pairing = pair(*faces, Spatial(), 4)
    assert pairing.weights.sum() == pytest.approx(1e-6 * PAD[0] * PAD[1], rel=1e-12)
    assert pairing.unpaired < 1e-12

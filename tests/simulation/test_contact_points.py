"""Contact points of worn faces: what the meshes lose is what opens the gap between them."""

from dataclasses import replace

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.bulk.mesh_motion import extended
from thermowear.simulation.geometry_update.moving_faces import MovingFaces, movable_body
from thermowear.simulation.points.worn_geometry import along
from thermowear.simulation.system.building import build
from thermowear.simulation.system.setup_cache import SetupCache
from thermowear.timer import Phases
from thermowear.verification.check import run_starter, starter

from ..systems import built

RADIUS = 2e-3
CYLINDER = (
    "cylinder-on-block-growing",
    "geometry.radius=2 mm",
    "geometry.block_width=12 mm",
    "geometry.block_height=6 mm",
    "geometry.zone=1 mm",
    "mesh.elements=30",
    "wear.block.coefficient=2e-6 1/MPa",
    "analysis.output_times=[]",
    "wear.update=0.02",
)


def grooved(depth):
    """The system whose block has lost a depth at the abscissae of the contact points."""
    system = built(starter(*CYLINDER), MPI.COMM_SELF)
    kept = MovingFaces(system)
    block = 0, 1
    face, body = kept.faces[block], movable_body(system, kept.geometry.mesh, block)
    amounts = face.offsets(depth(system.pairing.points[:, 0]))
    outlined = body.outlined(face.displacement(amounts))
    points = kept.geometry.mesh.points + extended(system.bodies, outlined)
    depth = np.stack([np.zeros(len(system.weights)), face.depths(amounts)])
    (contact,) = kept.geometry.contacts
    worn = replace(
        kept.geometry,
        mesh=replace(kept.geometry.mesh, points=points),
        contacts=(replace(contact, at=along(system.pairing), depth=depth),),
        updates=1,
    )
    return build(system.model, MPI.COMM_SELF, Phases(), None, SetupCache(), worn)


def test_the_unworn_gap_stays_where_faces_are_slanted():
    """The cylinder is up to 0.3 from the block's normals; far more is worn off than it presses."""
    wide, deep = 0.6e-3, 40e-6
    after = grooved(lambda x: deep * np.maximum(1 - x / wide, 0.0)).pairing
    near = after.points[:, 0] < wide
    assert after.normals[near, 0].max() > 0.25
    assert after.sides[1].face.nodes[0, 0, 1] == pytest.approx(-deep, rel=0.01)
    cos = -after.normals[:, 1]  # those of the cylinder, the block wears
    unworn = RADIUS * (1 / cos - 1)  # of a circle above a plane, along its normals
    assert after.gap[near] == pytest.approx(unworn[near], abs=2e-4 * deep)


@pytest.mark.slow
def test_pressures_go_on_after_an_update_of_a_steep_contact():
    """requirement: uniform over the contact, but for its edge; updates change next to nothing."""
    result = run_starter(*CYLINDER, "analysis.end_time=50 s")
    summary, i = result.summary, result.interface
    assert summary["geometry_updates"] >= 4
    assert summary["geometry_change"] < 4e-3
    half = i.x[i.pressure > 0].max()
    assert half > 0.3 * RADIUS
    mean = 20.0 / (2 * half * 1e-3)
    assert summary["max_pressure_Pa"] == pytest.approx(mean, rel=0.3)


def test_a_ring_whose_groove_has_coarse_walls_goes_on():
    """Faces overlap on a slope if the plate cannot follow the edge of the ring."""
    result = run_starter(
        "annular-punch-running-in",
        "mesh.degree=6",
        "mesh.elements=8",
        "wear.plate.coefficient=1e-7 1/MPa",
        "analysis.tolerance=1e-3",
        "analysis.end_time=3000 s",
        "analysis.output_times=[]",
        "analysis.max_steps=60",
    )
    i = result.interface
    assert result.stopped is None
    assert result.summary["geometry_updates"] >= 2
    assert i.pressure * i.x == pytest.approx(50e6 * 0.07, rel=1e-3)  # Páczelt and Mróz

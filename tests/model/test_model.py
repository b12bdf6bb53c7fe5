"""Models made in Python, without a case file."""

from dataclasses import dataclass, fields, replace

import numpy as np
import pytest

import thermowear as tw
from thermowear.geometry.mesh.tagged import TaggedMesh
from thermowear.laws import PowerWear
from thermowear.laws.interfaces import Constant
from thermowear.model import (
    Body,
    Discretisation,
    FaceWear,
    Heat,
    Holder,
    Interface,
    Material,
    Model,
    Motion,
    StaticAnalysis,
    TransientAnalysis,
)
from thermowear.simulation.analyses.run import run
from thermowear.simulation.from_case import model_of

from ..case.starter import STEADY, tables

COARSE = ("mesh.degree=3", "mesh.elements=6")
IN_TIME = ("analysis.type=transient", "analysis.end_time=200 s")
STEEL = Material(200e9, 0.3, expansion=1.2e-5, conductivity=50.0, label="steel")
FRICTION = 0.25


@dataclass(frozen=True)
class OneMesh:
    """Source of a mesh that a user has at hand."""

    tagged: TaggedMesh
    path: None = None

    def mesh(self, zone):
        return self.tagged

    def expected_zone(self, force, approach, modulus):
        return None


@pytest.fixture(scope="module")
def ring():
    """The hot ring of the starter case."""
    mesh = tw.load(tables(STEADY), COARSE).tagged_mesh()
    wear = FaceWear(PowerWear.per_friction_stress(2e-13, FRICTION, 1.0, 1.0), friction_exponent=1.0)
    return Model(
        kinematics="axisymmetric",
        bodies=(
            Body("punch", {"punch": STEEL}, fixed=("punch_top",)),
            Body("plate", {"plate": STEEL}, fixed=("plate_bottom",)),
        ),
        interfaces=(
            Interface(
                faces=("punch_face", "plate_face"),
                motion=Motion(angular_velocity=0.1),
                friction=Constant(FRICTION),
                conductance=Constant(1e6),
                wear={0: wear},
            ),
        ),
        holders=(
            Holder((0.0, -1.0), (0.0, 0.0), (0.0, 0.0), force=50e6 * np.pi * (0.12**2 - 0.02**2)),
        ),
        meshes=OneMesh(mesh),
        discretisation=Discretisation(3),
        heat=Heat(cooling={"punch_top": 2000.0, "plate_bottom": 2000.0}),
    )


def same(found, known):
    """The interface fields of two results agree to rounding."""
    for field in fields(known.interface):
        one, two = (getattr(result.interface, field.name) for result in (found, known))
        scale = np.nanmax(np.abs(two), initial=0.0)
        np.testing.assert_allclose(one, two, rtol=0.0, atol=1e-12 * scale, err_msg=field.name)


def test_a_model_in_python_is_the_case(ring):
    """requirement: the same steady state to 1e-12, without a case file."""
    same(run(ring, StaticAnalysis("steady")), tw.run(tw.load(tables(STEADY), COARSE)))


def test_a_model_in_python_runs_in_as_the_case(ring):
    """requirement: the same transient to 1e-12, without a case file."""
    known = tw.run(tw.load(tables(STEADY), (*COARSE, *IN_TIME)))
    found = run(ring, TransientAnalysis(end_time=200.0))
    same(found, known)
    times = [[row.time for row in result.history] for result in (found, known)]
    assert times[0] == pytest.approx(times[1], rel=1e-9)


def test_bodies_of_interfaces_and_holders(ring):
    """requirement: interfaces and holders of missing bodies, and two holders, are refused."""
    with pytest.raises(tw.CaseError, match=r"refer to the bodies \[0, 1\] of 1"):
        replace(ring, bodies=ring.bodies[:1])
    with pytest.raises(tw.CaseError, match="each may have one holder only"):
        replace(ring, holders=2 * ring.holders)
    with pytest.raises(tw.CaseError, match="at least one interface"):
        replace(ring, interfaces=())


def test_a_missing_property_is_named_by_its_material(ring):
    """requirement: heat without a conductivity is refused with the name of the material."""
    punch = replace(ring.bodies[0], materials={"punch": replace(STEEL, conductivity=None)})
    cold = replace(ring, bodies=(punch, ring.bodies[1]))
    with pytest.raises(tw.CaseError, match=r"^steel\.conductivity: missing"):
        run(cold, StaticAnalysis("steady"))


def test_fretting_needs_a_history(ring):
    """requirement: no analysis fails by an assertion where a model lacks what it needs."""
    from thermowear.model import FrettingAnalysis

    still = replace(ring, heat=None, interfaces=(replace(ring.interface, motion=Motion()),))
    with pytest.raises(tw.CaseError, match=r"^load\.history: missing"):
        run(still, FrettingAnalysis())


def test_equal_cases_make_equal_models():
    """requirement: models can be compared, as the cache of set-up results does."""
    one, two, other = (
        model_of(tw.load(tables(STEADY), (*COARSE, f"contact.friction={mu}")))
        for mu in (0.25, 0.25, 0.3)
    )
    assert one == two
    assert one != other
    assert replace(other, interfaces=one.interfaces) == one

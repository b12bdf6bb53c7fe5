"""Bodies that are factorised for the time of their condensation alone."""

import numpy as np

from thermowear.bulk.kinematics import Spatial
from thermowear.bulk.solvers.choice import SolverChoice
from thermowear.contact.operators.condensation import condense, gap_trace
from thermowear.contact.operators.pressure import pressure_basis
from thermowear.contact.operators.rigid_motion import RigidMode, hold
from thermowear.contact.search.pairing import Contacts, pair
from thermowear.laws.motions import translation

from .solids import bent, elastic_bodies, gathered, two_solids


def compliance(choice):
    divisions = (2, 2, 2), (2, 2, 2)
    bodies, faces = gathered(two_solids(divisions, 2, (bent, bent), cell_type="tetrahedron"))
    guided = "upper_face", "lower_face"  # loads along y on the bent faces count for nothing
    elastic = elastic_bodies(bodies, 2, 0.3, choice=choice, rollers=guided)
    pairing = pair(*faces, Spatial(), 4)
    trace, basis = gap_trace(elastic.spaces, Contacts((pairing,))), pressure_basis(pairing, 1)
    holder = hold(
        Contacts((pairing,)), pairing.normals, [RigidMode(translation((0.0, 0.0, -1.0)), load=1.0)]
    )
    return condense(elastic, pairing.weights, trace, trace, basis, holder).compliance


def test_compliance_of_both_bodies():
    """requirement: as by the factors of a direct solver, to 1e-10."""
    choice = SolverChoice("multigrid", largest_factor=1.0, available=1e12)
    assert choice.factorises_columns
    assert not SolverChoice("multigrid", largest_factor=1e12, available=1e12).factorises_columns
    expected, found = compliance(None), compliance(choice)
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-10 * np.abs(expected).max())

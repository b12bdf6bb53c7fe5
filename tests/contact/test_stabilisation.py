"""Defaults of the penalty and of Nitsche's stabilisation, and the limit of stability."""

import numpy as np
import pytest

from thermowear import ComputationError
from thermowear.bulk.elasticity.elasticity import ElasticMaterial
from thermowear.bulk.kinematics import kinematics_of
from thermowear.contact.full.full_system import FullContact
from thermowear.contact.full.nitsche import (
    default_penalty,
    nitsche_stiffness,
    nitsche_warning,
    normal_traction,
    stability_limit,
)
from thermowear.contact.operators.condensation import gap_trace
from thermowear.contact.search.pairing import Contacts

from .test_traction import MODELS, build, deformed_blocks


def materials(poisson_ratio):
    return {
        "upper": ElasticMaterial(2e11, poisson_ratio),
        "lower": ElasticMaterial(7e10, poisson_ratio),
    }


def solve(elastic, pairing, stiffness, theta):
    """A cylinder on deformed blocks; theta None: penalty."""
    modes = (pairing.normals @ [0.0, -1.0])[:, None]
    trace = gap_trace(elastic.spaces, Contacts((pairing,)))
    stress = None if theta is None else normal_traction(elastic, pairing)
    contact = FullContact(
        elastic, pairing, trace, trace, modes, modes, stiffness, stress, theta or 0
    )
    x = pairing.points[:, 0]
    gap = pairing.gap + (x - x.min() - 0.02) ** 2 / 4.0
    return contact.solve(gap, np.array([1e4]))


@pytest.mark.parametrize("poisson_ratio", [0.0, 0.3, 0.49])
@pytest.mark.parametrize("degree", [1, 2, 4, 8])
@pytest.mark.parametrize("kind", ["quadrilateral", "triangle"])
@pytest.mark.parametrize("name", MODELS)
def test_default_is_stable_for_all_cells(name, kind, degree, poisson_ratio):
    """requirement: γ0 needs no tuning: twice the limit or more, on the axis and beside it."""
    for inner in (0.0, 0.05):
        tagged = deformed_blocks(kind, 1, inner)
        model = kinematics_of(name, 0.01)
        elastic, pairing = build(tagged, model, degree, materials(poisson_ratio))
        stiffness, limit = nitsche_stiffness(elastic, pairing), stability_limit(elastic, pairing)
        assert 2 < (stiffness / limit).min() < 40
        assert nitsche_warning(stiffness, limit, 1) is None


@pytest.mark.parametrize("theta", [None, 1, 0, -1])
@pytest.mark.parametrize("inner", [0.0, 0.05])
@pytest.mark.parametrize(
    ("kind", "order", "degree"),
    [("quadrilateral", 2, 3), ("triangle", 1, 1), ("triangle", 3, 3), ("quadrilateral", 1, 8)],
)
def test_defaults_converge_on_curved_cells(kind, order, degree, inner, theta):
    """requirement: faces that do not match, curved, of any degree, on the axis and beside it."""
    tagged = deformed_blocks(kind, order, inner, columns=(16 // degree + 3, 16 // degree + 4))
    elastic, pairing = build(tagged, kinematics_of("axisymmetric", None), degree)
    choose = default_penalty if theta is None else nitsche_stiffness
    solution = solve(elastic, pairing, choose(elastic, pairing), theta)
    assert solution.iterations <= 12
    carried = pairing.weights @ (solution.pressure * -pairing.normals[:, 1])
    assert carried == pytest.approx(1e4, rel=1e-9)


@pytest.mark.parametrize("kind", ["quadrilateral", "triangle"])
def test_limit_is_where_the_symmetric_variant_fails(kind):
    """requirement: just above the limit there is a solution, far below it an error and advice."""
    elastic, pairing = build(deformed_blocks(kind, 1), kinematics_of("plane-strain", 0.01), 2)
    limit = stability_limit(elastic, pairing)
    assert solve(elastic, pairing, 1.01 * limit, 1).active.any()
    with pytest.raises(ComputationError, match=r"contact\.gamma"):
        solve(elastic, pairing, 0.3 * limit, 1)
    assert "times too small" in nitsche_warning(0.3 * limit, limit, 1)
    assert nitsche_warning(0.3 * limit, limit, -1) is None
    assert "ill conditioned" in nitsche_warning(1e6 * limit, limit, -1)

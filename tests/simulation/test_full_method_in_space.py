"""Penalty and Nitsche's method in space: the patch test through faces that do not match."""

import pytest

import thermowear as tw
from thermowear.verification.cases.contact.contact_methods import HEIGHTS, MODULI, PRESSURE
from thermowear.verification.cases.contact.patch_in_space import PatchInSpace

CELLS = {
    "hexahedra": (False, False),
    "tetrahedra": (True, True),
    "tetrahedra on hexahedra": (True, False),
}


@pytest.mark.parametrize("theta", [-1, 1])
@pytest.mark.parametrize("cells", list(CELLS))
@pytest.mark.parametrize(("order", "degree"), [(1, 1), (1, 2), (2, 2)])
def test_uniform_pressure_is_exact(cells, order, degree, theta):
    """requirement: pressure and approach, by Nitsche's method and by penalty (theta 1), 1e-10."""
    method = "nitsche" if theta == -1 else "penalty"
    contact = {"method": method}
    contact |= {"theta": theta} if method == "nitsche" else {"penalty": "1e15 Pa/m"}
    tables = {
        "model": "3d",
        "geometry": PatchInSpace(columns=(2, 3), orders=(order, order), tetrahedra=CELLS[cells]),
        "mesh": {"degree": degree},
        "bodies": {
            name: {"young_modulus": E, "poisson_ratio": 0.0}
            for name, E in zip(PatchInSpace.bodies, (f"{E} Pa" for E in MODULI), strict=True)
        },
        "load": {"mean_pressure": f"{PRESSURE} Pa"},
        "contact": contact,
        "analysis": {"type": "initial"},
    }
    result = tw.run(tw.load(tables))
    assert result.interface.pressure == pytest.approx(PRESSURE, rel=1e-10)
    expected = PRESSURE * sum(h / E for h, E in zip(HEIGHTS, MODULI, strict=True))
    expected += PRESSURE / 1e15 if method == "penalty" else 0.0
    assert result.summary["approach_m"] == pytest.approx(expected, rel=1e-10)

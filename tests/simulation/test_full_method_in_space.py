"""Penalty and Nitsche's method in space: patch test through faces that do not match, pressures."""

import pytest

import thermowear as tw
from thermowear.verification.cases.contact.contact_methods import HEIGHTS, MODULI, PRESSURE
from thermowear.verification.cases.contact.patch_in_space import PatchInSpace

from ..case.starter import tables
from .space import PUNCH

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


def unworn(body, method):
    """Unworn bodies in contact without friction, by a method."""
    given = tables("pin-on-disk-ball") if body == "ball" else PUNCH
    kept = ("title", "model", "geometry", "bodies", "load")
    return tw.run(
        tw.load(
            {key: given[key] for key in kept}
            | {
                "mesh": {"degree": 2, "elements": 10 if body == "ball" else 4},
                "contact": {"method": method},
                "analysis": {"type": "initial"},
            }
        )
    )


@pytest.mark.parametrize("body", ["ball", "pad"])
def test_three_methods_agree_at_points(body):
    """requirement: largest pressure within 1 % (ball) and 4 % (sharp edge of a pad) of condensed
    contact, pressures at all points within 4 % of it, forces to 1e-9.
    """
    known, *others = (unworn(body, method) for method in ("condensed", "penalty", "nitsche"))
    largest = known.interface.pressure.max()
    assert known.summary["max_pressure_Pa"] == largest
    for found in others:
        assert found.summary["normal_force_N"] == pytest.approx(
            known.summary["normal_force_N"], rel=1e-9, abs=0.0
        )
        assert found.summary["max_pressure_Pa"] == pytest.approx(
            largest, rel={"ball": 0.01, "pad": 0.04}[body], abs=0.0
        )
        assert found.interface.pressure == pytest.approx(
            known.interface.pressure, rel=0.0, abs=0.04 * largest
        )

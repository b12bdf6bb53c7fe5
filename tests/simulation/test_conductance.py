"""From hardly any conductance of the contact to perfect contact, one way."""

from itertools import pairwise

import numpy as np
import pytest

import thermowear as tw

from ..conftest import HOT

COARSE = ("mesh.degree=3", "mesh.elements=6", "mesh.bodies.plate.elements=8")
VALUES = [10.0**k for k in (3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 18, 20, 25, 30)]
ANALYSES = {
    "steady": ("contact.friction=0.25",),
    "in time": (
        'analysis={type="transient", end_time="2 s", tolerance=0.1}',
        "heat.transient=true",
        "bodies.punch.density=7800 kg/m^3",
        "bodies.punch.specific_heat=460 J/(kg K)",
    ),
}


@pytest.mark.parametrize(
    "analysis", [ANALYSES["steady"], pytest.param(ANALYSES["in time"], marks=pytest.mark.slow)]
)
def test_conductances_tend_to_perfect_contact(analysis, tmp_path):
    """requirement: temperatures and heat fluxes tend monotonically to those of perfect contact, on
    faces that do not match; heat balances to 1e-9 throughout. 1e20 W/(m² K) made 1731 °C of 95 °C.
    """
    text = HOT.read_text(encoding="utf-8")
    path = tmp_path / "perfect.toml"
    path.write_text(text.replace("\nconductance =", "\n#"), encoding="utf-8")
    perfect = tw.run(tw.load(path, (*COARSE, *analysis)))
    over = {"heat.conductance": [f"{h:g} W/(m^2 K)" for h in VALUES]}
    results = [result for _, result in tw.sweep(tw.load(HOT, (*COARSE, *analysis)), over)]
    assert all(r.summary["heat_balance_relative_error"] < 1e-9 for r in (*results, perfect))
    for column in ("temperature_1", "temperature_2", "heat_flux_1"):
        known, w = getattr(perfect.interface, column), perfect.interface.weight
        missed = [np.abs(getattr(r.interface, column) - known) @ w for r in results]
        rounding = 1e-10 * (np.abs(known) @ w)
        assert missed[-1] <= rounding
        assert all(b < a or b <= rounding for a, b in pairwise(missed))
        assert missed[0] > 1e3 * rounding


@pytest.mark.parametrize("conductance", [1e12, 1e30])
def test_laws_of_the_pressure_tend_to_it_too(conductance):
    """requirement: point by point and with a conductance of the gap, balance 1e-9."""
    law = 'heat.conductance={type="table", pressure=["0 Pa", "1 GPa"], '
    law += f'conductance=["{conductance:g} W/(m^2 K)", "{10 * conductance:g} W/(m^2 K)"]}}'
    result = tw.run(tw.load(HOT, (*COARSE, law, "heat.gap_conductance=1e-3 W/(m^2 K)")))
    assert result.stopped is None
    assert result.summary["heat_balance_relative_error"] < 1e-9
    assert result.summary["max_temperature_K"] - 273.15 == pytest.approx(95.24, abs=0.05)

"""Layers on a contact face: ``[wear.BODY.layers]``."""

import pytest

from thermowear.case import as_plain, load
from thermowear.errors import CaseError
from thermowear.laws import PowerWear
from thermowear.laws.wear import LayeredWear
from thermowear.simulation.from_case import model_of

from .starter import changed, tables

LAYERS = {"thickness": ["5 um", "2 um"], "coefficient": ["2e-9 1/MPa", "4e-9 1/MPa"]}
BODY = {"coefficient": "8e-8 1/MPa", "per": "pressure", "layers": LAYERS}
CASE = tables(
    "stacked-blocks",
    {"wear": {"upper": BODY}, "analysis": {"type": "transient", "end_time": "9 s"}},
)
STRESS = {"at": ["20 degC", "90 degC"], "factor": [1.0, 0.8]}


def read(**changes):
    return load(changed(CASE, {key.replace("__", "."): value for key, value in changes.items()}))


def law(case):
    return model_of(case).interface.wear[0].law


def test_round_trip():
    """
    requirement: a resolved case is read back to the same; it has no keys that were not given.
    """
    case = read()
    written = as_plain(case)["wear"]["upper"]
    assert set(written["layers"]) == {"thickness", "coefficient"}
    assert load(as_plain(case)) == case
    assert "layers" not in as_plain(read(wear__upper=BODY | {"layers": None}))["wear"]["upper"]


def test_laws_of_the_layers():
    """
    requirement: from the surface down, the body's own law last; its keys hold for the layers.
    """
    found = law(read())
    assert found.thickness == pytest.approx((5e-6, 2e-6), rel=1e-14, abs=0.0)
    coefficients = [each.coefficient for each in found.laws]
    assert coefficients == pytest.approx([2e-15, 4e-15, 8e-14], rel=1e-14, abs=0.0)
    square = BODY | {
        "coefficient": "8e-8 1/MPa^2",
        "pressure_exponent": 2,
        "layers": LAYERS | {"coefficient": ["2e-9 1/MPa^2", "4e-9 1/MPa^2"]},
    }
    assert {each.pressure_exponent for each in law(read(wear__upper=square)).laws} == {2.0}


def test_lists_of_their_own():
    """
    requirement: per and exponents by layer, thicknesses with a common unit.
    """
    own = {
        "thickness": {"values": [5, 2], "unit": "um"},
        "coefficient": ["2e-9 1/MPa^2", "4e-9 1/MPa"],
        "pressure_exponent": [2, 1],
        "per": ["pressure", "friction-stress"],
    }
    found = law(read(wear__upper__layers=own))
    assert isinstance(found, LayeredWear)
    assert [each.pressure_exponent for each in found.laws] == [2.0, 1.0, 1.0]
    coefficients = [each.coefficient for each in found.laws]
    assert coefficients == pytest.approx([2e-21, 0.2 * 4e-15, 8e-14], rel=1e-14, abs=0.0)


def test_rates():
    """
    requirement: any law in place of the coefficients, also beside a coefficient of the body.
    """
    rates = {"thickness": ["5 um"], "rate": ["2e-9/MPa*p*v*(1 + depth/(1 um))"]}
    found = law(read(wear__upper__layers=rates))
    assert found.laws[0].variables == {"p", "v", "depth"}
    assert type(found.laws[1]) is PowerWear


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("thickness", ["5 um"], "layers.coefficient: has 2 values for 1 layers"),
        ("per", ["pressure"], "layers.per: has 1 values for 2 layers"),
        ("thickness", ["5 um", "0 um"], 'layers.thickness.1: found "0 um"; must be greater than 0'),
        ("thickness", ["5 um", "-2 um"], "layers.thickness.1: found"),
        ("thickness", ["5 um", "2 s"], "layers.thickness.1: "),
        ("thickness", "5 um", "layers.thickness: "),
        ("coefficient", ["2e-9 1/MPa", "0 1/MPa"], "layers.coefficient.1: found"),
        ("coefficient", ["2e-9 1/MPa", "1 1/m"], 'layers.coefficient.1: the unit of "1.0 1/m"'),
        ("pressure_exponent", [1, 2], "layers.coefficient.1: the unit"),
        ("pressure_exponent", [1, 20], "layers.pressure_exponent.1: found 20; must"),
        ("rate", ["2e-9/MPa*p*v"] * 2, "layers.coefficient: not allowed together with rate"),
        ("hardness", ["2 GPa"], "layers.hardness: unknown key"),
    ],
)
def test_faults(key, value, message):
    refused(message, {f"wear.upper.layers.{key}": value})


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"wear.upper.layers": {"thickness": []}}, "upper.layers.thickness: is empty"),
        ({"wear.upper.layers": {"thickness": ["5 um"]}}, "layers.coefficient: missing; each layer"),
        ({"wear.upper": {"layers": LAYERS}}, "wear.upper.coefficient: missing"),
        (
            {"analysis": {"type": "fretting"}},
            "wear.upper.layers: is not supported in a fretting analysis",
        ),
        (
            {"wear.upper.materials": {"zone": {"coefficient": "1e-9 1/MPa"}}},
            "wear.upper.layers: is not supported together with materials",
        ),
        (
            {
                "wear.upper.layers": {"thickness": ["5 um"], "rate": ["1e-9/MPa*p*v*T/(1 K)"]},
                "heat": None,
            },
            "wear.upper.layers.rate.0: depends on T; requires a [heat] table",
        ),
        (
            {"wear.upper.layers.per": ["friction-stress"] * 2, "contact": {}, "heat": None},
            "contact.friction: is 0; layer 0 of wear.upper.layers is per friction stress",
        ),
        (
            {
                "wear.upper.layers.per": ["friction-stress", "pressure"],
                "contact.friction_factor": {"temperature": STRESS},
            },
            "wear.upper.layers: requires the same per and pressure_exponent as the body",
        ),
    ],
)
def test_refused_together(changes, message):
    refused(message, changes)


def refused(message, changes):
    with pytest.raises(CaseError) as caught:
        load(changed(CASE, changes))
    assert [fault for fault in caught.value.faults if message in fault], caught.value.faults
    assert all("\n" not in fault for fault in caught.value.faults)

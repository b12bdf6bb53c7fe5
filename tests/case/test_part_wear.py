"""Wear laws of the parts of a face: ``[wear.BODY.materials.PART]``."""

import pytest

from thermowear.case import as_plain, load
from thermowear.errors import CaseError
from thermowear.laws import PowerWear
from thermowear.simulation.from_case import model_of
from thermowear.verification.cases.wear.composite_face import Composite

from .starter import changed

CASE = Composite("plane-strain").tables("blocks.msh") | {"analysis": {"type": "steady"}}
OWN = {"coefficient": "5e-14 1/Pa", "per": "pressure"}


def read(**changes):
    return load(changed(CASE, {key.replace("__", "."): value for key, value in changes.items()}))


def test_round_trip():
    """
    requirement: a resolved case is read back to the same; it has no keys that were not given.
    """
    case = read()
    written = as_plain(case)["wear"]["upper"]
    assert set(written) == {"materials", "spread"}
    assert set(written["materials"]["insert"]) == {
        "coefficient", "per", "pressure_exponent", "velocity_exponent", "factor",
    }  # fmt: skip
    assert load(as_plain(case)) == case
    plain = read(wear__upper=OWN)
    assert "materials" not in as_plain(plain)["wear"]["upper"]


def test_laws_of_the_parts():
    """
    requirement: each part has its own law, and all others that of the body.
    """
    case = read(wear__upper=OWN | {"materials": {"insert": {"rate": "1e-14/Pa*p*v"}}})
    ((index, wear),) = model_of(case).interface.wear.items()
    assert index == 0
    assert set(wear.parts) == {"upper", "upper.upper", "upper.insert"}
    assert wear.parts["upper.upper"].law == PowerWear(5e-14) == wear.parts["upper"].law
    assert wear.parts["upper.insert"].law.variables == {"p", "v"}
    assert [wear.group_of(part) for part in ("upper", "upper.upper", "upper.insert")] == [0, 0, 1]


def test_a_cell_set_may_have_a_wear_law_only():
    """
    requirement: cell sets with the material of their body wear by their own law.
    """
    solid = {"young_modulus": "4 GPa", "poisson_ratio": 0.3}
    model = model_of(read(bodies__upper=solid))
    assert model.materials["upper.insert"] == model.materials["upper"]
    assert set(model.interface.wear[0].parts) == {"upper.upper", "upper.insert"}


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("wear.upper", {}, "wear.upper.coefficient: missing"),
        ("wear.upper.per", "pressure", "wear.upper.coefficient: missing"),
        ("wear.upper.materials.insert", {}, "wear.upper.materials.insert.coefficient: missing"),
        (
            "wear.upper.materials.insert.rate",
            "1e-9 m/s",
            "wear.upper.materials.insert.rate: there is wear without pressure",
        ),
        (
            "wear.upper.materials.insert.spread",
            "track",
            "wear.upper.materials.insert.spread: unknown key",
        ),
        (
            "wear.upper.materials.insert.per",
            "friction-stress",
            "wear.upper.materials.insert is per friction stress",
        ),
        (
            "wear.upper.materials.insert.factor",
            {"temperature": {"at": ["20 degC", "90 degC"], "factor": [1.0, 2.0]}},
            "wear.upper.materials.insert.factor.temperature: needs a [heat] table",
        ),
        (
            "wear.upper.materials.insert",
            {"rate": "1e-14/Pa*p*v*T/(1 K)"},
            "wear.upper.materials.insert.rate: depends on T; requires a [heat] table",
        ),
        (
            "wear.lower",
            {"spread": "track", "materials": {"inlay": OWN}},
            "wear.lower.materials: requires spread = \"in-place\"; found 'track'",
        ),
        (
            "analysis",
            {"type": "fretting"},
            "wear.upper.materials: is not supported in a fretting analysis",
        ),
    ],
)
def test_faults(key, value, message):
    with pytest.raises(CaseError) as caught:
        load(changed(CASE, {key: value}))
    found = [fault for fault in caught.value.faults if message in fault]
    assert found, caught.value.faults
    assert all("\n" not in fault for fault in caught.value.faults)


def test_parts_of_other_geometries():
    """
    requirement: a zone of a geometry is a part; unknown names, or bodies without parts, are told.
    """
    from thermowear.verification.check import starter

    law = "{coefficient='5e-14 1/Pa', per='pressure'}"
    with pytest.raises(CaseError, match="unknown part; must be one of: lining"):
        starter("drum-brake", f"wear.shoe.materials.plate={law}")
    with pytest.raises(CaseError, match="'annular-punch' has no parts of punch"):
        starter("annular-punch", f"wear.punch.materials.pad={law}")

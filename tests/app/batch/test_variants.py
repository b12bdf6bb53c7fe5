"""Variants of a case: their combinations, and their faults."""

from __future__ import annotations

import pytest

from thermowear.app.batch.variants import parse_over, variants, written
from thermowear.case.starters import starter_text
from thermowear.errors import CaseError


@pytest.fixture
def ring(tmp_path):
    path = tmp_path / "ring.toml"
    path.write_text(starter_text("annular-punch"), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("a.b=1,2,3", ["1", "2", "3"]),
        ("a.b=1 kN, 2 kN", ["1 kN", "2 kN"]),
        ('a.b="1 kN","2, or 3"', ['"1 kN"', '"2, or 3"']),
        ("a.b=['x, y'],[]", ["['x, y']", "[]"]),
        ("a.b={c=1, d=[1, 2]},{c=2}", ["{c=1, d=[1, 2]}", "{c=2}"]),
        ("a.b=1 W/(m^2 K)", ["1 W/(m^2 K)"]),
        ("a.b=x=y", ["x=y"]),
    ],
)
def test_values_are_split_at_commas(text, values):
    """requirement: commas within brackets and quotes belong to the value."""
    assert parse_over([text]) == {"a.b": values}


@pytest.mark.parametrize("text", ["a", "=1", "a=", "a=1,,2", "a=1,", ""])
def test_over_that_says_nothing(text):
    """requirement: one line with the correct syntax."""
    with pytest.raises(CaseError, match=r"--over .*must be KEY=V1,V2") as error:
        parse_over([text])
    assert len(error.value.faults) == 1


def test_a_key_twice():
    """requirement: a key cannot have two lists of values."""
    with pytest.raises(CaseError, match="twice"):
        parse_over(["a=1", "a=2"])


def test_all_combinations(ring):
    """requirement: the Cartesian product, the last key fastest, with --set in all of them."""
    over = parse_over(["contact.friction=0.1,0.2,0.3", "load.mean_pressure=1 MPa,2 MPa"])
    found = variants(ring, over, ("mesh.degree=3",))
    assert [v.number for v in found] == [1, 2, 3, 4, 5, 6]
    pairs = [(v.case.contact.friction, v.case.load.mean_pressure) for v in found]
    assert pairs == [(μ, p) for μ in (0.1, 0.2, 0.3) for p in (1e6, 2e6)]
    assert {v.case.mesh.degree for v in found} == {3}


def test_every_fault_is_said_once_with_its_variant(ring):
    """requirement: all variants are checked, one line a fault."""
    with pytest.raises(CaseError) as error:
        variants(ring, parse_over(["contact.friction=0.1,-1", "mesh.degree=2,0,11"]))
    faults = error.value.faults
    assert len(faults) == 3 + 2 * 2  # the friction in three of them, each degree in two
    assert faults[0].startswith("variant 2 (contact.friction=0.1, mesh.degree=0): mesh.degree: ")
    with pytest.raises(CaseError) as error:
        variants(ring, parse_over(["mesh.degree=2,3"]), ("contact.friction=-1",))
    (fault,) = error.value.faults
    assert fault.startswith("contact.friction: ")


@pytest.mark.parametrize(
    "value", ["1 kN", 'say "x"', 3, 2.5, True, ["1 m", "2 m"], {"type": "table", "at": [1, 2.0]}]
)
def test_values_of_python_are_written_as_toml(value):
    """requirement: values from Python need no quotes."""
    import tomllib

    assert tomllib.loads(f"value = {written(value)}")["value"] == value

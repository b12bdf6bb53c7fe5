"""JSON schema of case files: what the program reads it accepts, and typing errors it rejects."""

from __future__ import annotations

import contextlib
import tomllib
from typing import Annotated

import jsonschema
import pytest
from pydantic import TypeAdapter, ValidationError

import thermowear as tw
from thermowear.app.cli import main
from thermowear.app.schema import all_tables, case_schema
from thermowear.case.assembly.schema import AssemblyCase
from thermowear.case.starters import starter_text, starters
from thermowear.case.tables.schema import Case
from thermowear.case.values.json_schema import UNIT
from thermowear.errors import CaseError

from ...case.mutations import CLASSES, endless, mutated

VALIDATOR = jsonschema.Draft202012Validator(case_schema())


def tables(name="annular-punch"):
    return tomllib.loads(starter_text(name))


def changed(path, value):
    """Starter with one key changed."""
    found = tables()
    *where, key = path.split(".")
    table = found
    for name in where:
        table = table[name]
    table[key] = value
    return found


def test_the_schema_is_one():
    """requirement: the schema obeys its dialect."""
    jsonschema.Draft202012Validator.check_schema(case_schema())


@pytest.mark.parametrize("name", starters())
def test_starters_are_accepted(name):
    """requirement: editors report no faults in starters."""
    VALIDATOR.validate(tables(name))


def is_read(case):
    """True if all keys of a case, of two bodies or of several, can be read."""
    for kind in (Case, AssemblyCase):
        with contextlib.suppress(ValidationError, CaseError):
            kind.model_validate(case)
            return True
    return False


def test_what_is_read_is_accepted():
    """requirement: no case that the program reads is underlined in an editor."""
    read = 0
    for seed in range(420):
        if CLASSES[seed % len(CLASSES)] is endless:  # takes long to read, and is refused
            continue
        with contextlib.suppress(tomllib.TOMLDecodeError, UnicodeDecodeError):
            case = tomllib.loads(mutated(seed)[1][0].decode())
            if is_read(case):
                VALIDATOR.validate(case)
                read += 1
    assert read > 20


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("mesh.degre", 6),
        ("mesh.degree", 6.5),
        ("mesh.degree", 11),
        ("load.mean_pressure", 50),
        ("load.mean_pressure", "fifty MPa"),
        ("geometry.type", "annular-punsh"),
        ("geometry.inner_radius", None),
        ("geometry.tube_radius", "20 mm"),
        ("analysis.type", "steady-state"),
        ("contact.method", "mortar"),
        ("bodies.punch.poisson_ratio", 0.5),
    ],
)
def test_typing_errors_are_rejected(path, value):
    """requirement: unknown keys, wrong types, words and plain bounds are reported while typing."""
    case = changed(path, value)
    if value is None:
        del case["geometry"]["inner_radius"]
    assert not VALIDATOR.is_valid(case)
    with pytest.raises(CaseError):
        tw.load(case)


def test_a_list_with_a_common_unit():
    """requirement: both ways to write a list of quantities are accepted, others are not."""
    for good in (["1 s", "2 s"], {"values": [1, 2], "unit": "s"}):
        case = changed("analysis", {"type": "transient", "end_time": "9 s", "output_times": good})
        VALIDATOR.validate(case)
        assert tw.load(case).analysis.output_times == (1.0, 2.0)
    case["analysis"]["output_times"] = {"values": [1, 2]}
    assert not VALIDATOR.is_valid(case)


def quantities(schema, found):
    """Schemas of quantities with an example, anywhere in a schema."""
    if isinstance(schema, dict):
        if UNIT in schema:
            found.append(schema)
        for value in schema.values():
            quantities(value, found)
    if isinstance(schema, list):
        for value in schema:
            quantities(value, found)
    return found


def test_examples_and_bounds_are_those_of_the_program():
    """requirement: the example of each quantity has its unit and lies within its bounds."""
    seen = quantities(case_schema(), [])
    assert len(seen) > 200
    for schema in seen:
        example = tw.case.values.units.parse(schema["examples"][0], "1 m").to(schema[UNIT])
        assert example.magnitude >= schema.get("x-at-least", -1e99)
        assert example.magnitude > schema.get("x-greater-than", -1e99)
        assert example.magnitude <= schema.get("x-at-most", 1e99)


@pytest.mark.parametrize("key", ["friction", "fluid_pressure"])
def test_examples_of_expressions_are_read(key):
    """requirement: the expressions that the schema offers can be copied into a case."""
    field = type(Case.model_fields["contact"].default).model_fields[key]
    kind = TypeAdapter(Annotated[field.annotation, *field.metadata, key])
    forms = kind.json_schema()["anyOf"]
    examples = [example for form in forms for example in form.get("examples", ())]
    assert examples
    for example in examples:
        kind.validate_python(example)
    with pytest.raises(ValidationError):
        kind.validate_python("0.2 +")


def test_every_key_has_a_meaning():
    """requirement: no key and no table without a description."""
    found = all_tables()
    missing = [f"{t.name}.{k.name}" for t in found.values() for k in t.keys if not k.meaning]
    assert missing == []
    assert [t.name for t in found.values() if not t.meaning] == []


def test_rows_of_the_reference():
    """requirement: a row has the unit, default, bounds and the meaning of a key in the model."""
    found = all_tables()
    keys = {key.name: key for key in found["BodyTable"].keys}
    assert found["BodyTable"].paths == ("bodies.NAME",)
    assert keys["young_modulus"].kinds == ("[Pa]",)
    assert keys["young_modulus"].limits == "> 0"
    assert keys["young_modulus"].meaning == "Young's modulus."
    assert keys["poisson_ratio"].limits == "> -1, < 0.5"
    assert "<TemperatureTable>" in keys["conductivity_factor"].kinds
    heat = {key.name: key for key in found["HeatTable"].keys}
    assert heat["ambient"].default == "293.15 K"
    assert heat["partition"].kinds == ("number", '"effusivity"')
    assert heat["cooling"].kinds == ("NAME = [W/m^2/K]",)
    force = next(key for key in found["LoadTable"].keys if key.name == "force")
    assert "on the whole ring" in force.meaning
    holder = next(key for key in found["HolderTable"].keys if key.name == "free")
    assert "rotation" in holder.meaning  # from the docstring of the model
    assert "wear.NAME.materials.NAME" in found["PartWearTable"].paths


def test_the_command(tmp_path, capsys):
    """requirement: the schema is printed, or written to a file that is not overwritten unasked."""
    assert main(["schema"]) == 0
    printed = capsys.readouterr().out
    path = tmp_path / "s.json"
    assert main(["schema", "-o", str(path)]) == 0
    assert path.read_text(encoding="utf-8") == printed
    assert main(["schema", "-o", str(path)]) == 1
    assert "exists" in capsys.readouterr().err
    assert main(["schema", "-o", str(tmp_path / "no" / "s.json")]) == 1

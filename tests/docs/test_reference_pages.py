"""Pages of the site that are made from the program: nothing is missing, no link leads nowhere."""

from __future__ import annotations

import importlib
import inspect
import re
import sys
from pathlib import Path

import pytest

import thermowear as tw
from thermowear.app.cli import COMMANDS
from thermowear.app.schema import all_tables
from thermowear.case.tables.geometry_choice import known_geometries

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def extensions():
    """The modules that write the pages."""
    sys.path.insert(0, str(DOCS))
    yield {
        name: importlib.import_module(f"extensions.{name}")
        for name in ("case_keys", "python_names")
    }
    sys.path.remove(str(DOCS))


@pytest.fixture(scope="module")
def keys(extensions):
    return extensions["case_keys"].key_pages()


def test_every_key_has_a_row(keys):
    """requirement G2: each key of each table is explained on one page."""
    sections = {}
    for text in keys.values():
        for name, body in re.findall(
            r"^\((keys-[\w-]+)\)=\n(.*?)(?=^\(keys-|\Z)", text, re.M | re.S
        ):
            assert name not in sections
            sections[name] = body
    assert len(sections) == len(all_tables())
    rows = [row for body in sections.values() for row in re.findall(r"^\| `(\w+)` \|", body, re.M)]
    assert sorted(rows) == sorted(k.name for t in all_tables().values() for k in t.keys)


def test_every_geometry_has_a_section(keys):
    """requirement G2: the page of geometries is complete."""
    for name in known_geometries():
        assert f'`type = "{name}"`' in keys["geometry"]


def test_links_between_tables_lead_somewhere(keys):
    """requirement: a kind of value that is a table leads to its keys."""
    targets = {
        name for text in keys.values() for name in re.findall(r"^\((keys-[\w-]+)\)=", text, re.M)
    }
    links = [link for text in keys.values() for link in re.findall(r"\]\(#([\w-]+)\)", text)]
    assert len(links) > 100
    assert set(links) <= targets


def test_a_row_says_what_a_key_is(keys):
    """requirement: unit, default, limits and meaning of a key."""
    (row,) = re.findall(r"^\| `ambient` .*$", keys["heat"], re.M)
    assert row == (
        "| `ambient` | [K] | `293.15 K`; ≥ 0 | "
        "Temperature of the surroundings and of the stress-free state. |"
    )


def test_every_public_name_has_an_entry(extensions):
    """requirement G2: what the package and its rooms offer is in the reference, once."""
    pages = "\n".join(extensions["python_names"].python_pages().values())
    entries = re.findall(r"^\.\. auto(?:class|function):: ([\w.]+)$", pages, re.M)
    names = [f"thermowear.{name}" for name in tw.__all__ if name not in tw._ROOMS]
    assert set(names) <= set(entries)
    assert len({entry.rpartition(".")[2] for entry in entries}) == len(entries)
    for entry in ("laws.steady_pressure", "contact.condense", "bulk.elasticity", "inference.fit"):
        assert f"thermowear.{entry}" in entries


def test_every_public_name_is_described(extensions):
    """requirement G2: no entry without a docstring of its own."""
    for module, names in extensions["python_names"].public_names().items():
        for name in names:
            value = getattr(importlib.import_module(module), name)
            assert inspect.getdoc(value), f"{module}.{name}"
            if inspect.isclass(value) and value.__doc__ is not None:
                assert not value.__doc__.startswith(f"{name}("), (
                    f"{module}.{name}: made by dataclass"
                )


def test_every_command_is_in_the_readme():
    """requirement: no command that only its help names."""
    readme = (DOCS.parent / "README.md").read_text(encoding="utf-8")
    for command in COMMANDS:
        assert re.search(rf"`{command}[` ]", readme), command

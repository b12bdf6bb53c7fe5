"""Fragments of cases, commands and programs in README and docs: all of them are valid."""

from __future__ import annotations

import ast
import copy
import re
import tomllib

import jsonschema
import pytest

import thermowear as tw
from thermowear.app.arguments import parser
from thermowear.app.schema import case_schema
from thermowear.case.starters import starter_files, starter_text, starters

from .blocks import PAGES, TOP, calls, fenced

OWN_FILES = {"docs/tutorials/own-mesh.md"}
"""Pages whose programs write the files that their cases name."""


def without_required(schema):
    """Schema of fragments: no key is missing."""
    if isinstance(schema, dict):
        return {key: without_required(value) for key, value in schema.items() if key != "required"}
    return [without_required(value) for value in schema] if isinstance(schema, list) else schema


FRAGMENT = jsonschema.Draft202012Validator(without_required(copy.deepcopy(case_schema())))


@pytest.mark.parametrize("block", fenced("toml"), ids=lambda block: block.id)
def test_fragments_of_cases(block):
    """requirement: keys and values of the documents are those of the program."""
    found = tomllib.loads(block.text.replace("…", ""))
    if set(found) == {"schema"}:  # of an editor
        return
    fault = jsonschema.exceptions.best_match(FRAGMENT.iter_errors(found))
    assert fault is None, fault.message


def our_calls(page):
    """Calls of the program on a page with their arguments, but those that stand for any."""
    found = [(call, call.arguments()) for call in calls(page)]
    return [
        (call, words)
        for call, words in found
        if words and words[0] not in ("COMMAND", "--help") and "CASE" not in words
    ]


@pytest.mark.parametrize("page", [page for page in PAGES if our_calls(page)])
def test_commands(page, tmp_path):
    """requirement: commands of the documents are accepted, with their cases and changes of keys."""
    written = set()
    for call, words in our_calls(page):
        chosen = parser().parse_args(words)
        if chosen.command == "init":
            written.add(f"{chosen.name}.toml")
            (tmp_path / f"{chosen.name}.toml").write_text(starter_text(chosen.name))
            for name, data in starter_files(chosen.name).items():
                (tmp_path / name).write_bytes(data)
        if not hasattr(chosen, "case") or page in OWN_FILES:
            continue
        case = (tmp_path if str(chosen.case) in written else TOP) / chosen.case
        if any(line.startswith("error:") for line in call.output):
            with pytest.raises(tw.CaseError):
                tw.load(case, tuple(chosen.overrides))
        else:
            tw.load(case, tuple(chosen.overrides))


@pytest.mark.parametrize("block", fenced("python"), ids=lambda block: block.id)
def test_programs(block):
    """requirement: programs of the documents have no faults of syntax, and use names that exist."""
    tree = ast.parse(block.text.replace("…", "..."))
    for node in ast.walk(tree):
        of_us = isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name)
        if of_us and node.value.id == "tw":
            assert hasattr(tw, node.attr), f"tw.{node.attr}"


def test_starters_are_named_rightly():
    """requirement: a starter that the first page names exists."""
    text = PAGES["docs/start.md"].read_text(encoding="utf-8")
    named = re.findall(r"starters? ((?:`[\w-]+`(?:, | or )?)+)", text)
    names = [name for group in named for name in re.findall(r"`([\w-]+)`", group)]
    assert len(names) > 5
    assert set(names) <= set(starters())

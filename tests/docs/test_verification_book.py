"""Verification book: every case of `verify`, with problem, source and numbers."""

from __future__ import annotations

import importlib
import inspect
import json
import re
import sys

import pytest

from thermowear.verification import CASES, SLOW

from .blocks import TOP

BOOK = json.loads((TOP / "docs" / "verification" / "checks.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def pages():
    sys.path.insert(0, str(TOP / "docs"))
    yield importlib.import_module("extensions.verification_book").verification_pages()
    sys.path.remove(str(TOP / "docs"))


def test_every_case_is_in_the_book(pages):
    """requirement G2: no case is missing, none is in two places."""
    names = re.findall(r"^\(verify-([\w-]+)\)=$", "\n".join(pages.values()), re.MULTILINE)
    assert sorted(names) == sorted({row["id"] for row in BOOK["checks"]})
    assert set(CASES) - SLOW <= set(names)


def test_numbers_are_within_what_is_allowed():
    """requirement: the book shows what the program asserts, each with its source."""
    assert len(BOOK["checks"]) > 2000
    for row in BOOK["checks"]:
        assert row["error"] <= row["allowed"], row
        assert row["source"]


@pytest.mark.parametrize("name", CASES)
def test_every_case_says_its_problem(name):
    """requirement: the problem of a case in a sentence."""
    assert len(inspect.getdoc(CASES[name]) or "") > 30


def test_pictures(pages, tmp_path, monkeypatch):
    """requirement: each case has a picture of its errors; pictures of systems exist."""
    book = importlib.import_module("extensions.verification_book")
    few = [row for row in BOOK["checks"] if row["id"] in ("case-1", "patch")]
    monkeypatch.setattr(book, "_book", lambda: BOOK | {"checks": few})
    book.draw_book(tmp_path)
    assert sorted(path.stem for path in tmp_path.glob("*.svg")) == ["case-1", "patch"]
    assert all("</svg>" in path.read_text() for path in tmp_path.glob("*.svg"))
    text = "\n".join(pages.values())
    named = re.findall(r"\(pictures/([\w-]+)\.svg\)", text)
    assert sorted(named) == sorted({row["id"] for row in BOOK["checks"]})
    systems = re.findall(r"\(\.\./\.\./(demos/pictures/[\w-]+\.png)\)", text)
    assert len(systems) > 20
    assert all((TOP / name).exists() for name in systems)

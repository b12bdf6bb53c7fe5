"""Links of the site: what is broken is found."""

from __future__ import annotations

import importlib
import sys

import pytest

from .blocks import TOP


@pytest.fixture
def check(monkeypatch):
    monkeypatch.setattr(sys, "path", [str(TOP / "docs"), *sys.path])
    return importlib.import_module("extensions.check_links")


def test_broken_links_are_found(check, tmp_path, capsys):
    """requirement G1: files and anchors that do not exist are named with their page."""
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "index.html").write_text('<h1 id="top">x</h1><a href="../a.html#no">')
    good = '<a href="folder/#top"> <a href="#here"><p id="here"> <a href="https://example.org">'
    bad = '<img src="none.png"> <a href="folder/index.html#below">'
    (tmp_path / "a.html").write_text(good + bad)
    assert check.main(tmp_path) == 1
    said = capsys.readouterr()
    assert sorted(said.err.splitlines()) == [
        "broken link in a.html: folder/index.html#below",
        "broken link in a.html: none.png",
        "broken link in folder/index.html: ../a.html#no",
    ]
    assert said.out == "5 links, 3 of them broken; 1 links to other sites\n"

"""Release: one version everywhere, with notes; data files are part of the package."""

from __future__ import annotations

import re
import tomllib
from fnmatch import fnmatch
from pathlib import Path

import thermowear as tw

TOP = Path(__file__).parents[1]


def found(pattern, name):
    """First match of a pattern in a file at the top."""
    return re.search(pattern, (TOP / name).read_text(encoding="utf-8"), re.MULTILINE)


def test_one_version():
    """requirement: package, citation, recipe and notes are of the same release."""
    assert found(r"^version: (\S+)$", "CITATION.cff")[1] == tw.__version__
    assert found(r'^  version: "(\S+)"$', "conda/recipe.yaml")[1] == tw.__version__
    released = found(rf"^## \[{re.escape(tw.__version__)}\] - (\S+)$", "CHANGELOG.md")
    assert found(r'^date-released: "(\S+)"$', "CITATION.cff")[1] == released[1]


def test_data_files_are_packaged():
    """requirement: starters, report and whatever else is no module come with the wheel."""
    project = tomllib.loads((TOP / "pyproject.toml").read_text(encoding="utf-8"))
    packaged = project["tool"]["setuptools"]["package-data"]
    for path in (TOP / "thermowear").rglob("*"):
        if path.is_dir() or path.suffix in {".py", ".pyc"}:
            continue
        package = ".".join(path.parent.relative_to(TOP).parts)
        assert any(fnmatch(path.name, pattern) for pattern in packaged.get(package, ())), path


def test_dependencies_are_those_of_the_recipe():
    """requirement: what the wheel asks for the conda recipe has, too."""
    project = tomllib.loads((TOP / "pyproject.toml").read_text(encoding="utf-8"))
    recipe = (TOP / "conda" / "recipe.yaml").read_text(encoding="utf-8")
    for needed in project["project"]["dependencies"]:
        name = re.match(r"[\w-]+", needed)[0].replace("matplotlib", "matplotlib-base")
        assert re.search(rf"^    - {name}( |$)", recipe, re.MULTILINE), name

"""Benchmarks, which the tests do not run."""

import importlib
from pathlib import Path

import pytest

NAMES = [path.stem for path in (Path(__file__).parent / "benchmarks").glob("[a-z]*.py")]
ELSEWHERE = {"hertz_getfem", "hertz_3d_peers"}
"""Those that need packages of other programs."""


@pytest.mark.parametrize("name", sorted({*NAMES} - ELSEWHERE))
def test_what_a_benchmark_imports_exists(name):
    """requirement: names that have moved are followed."""
    importlib.import_module(f"tests.benchmarks.{name}")

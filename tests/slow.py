"""Parameters of tests that are left out of `make test`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def marked_slow(parameters: Iterable, *slow) -> list:
    """Parameters, or tuples of parameters, of which some are marked slow."""
    left_out = {_as_tuple(each) for each in slow}
    assert left_out <= {_as_tuple(each) for each in parameters}
    return [
        pytest.param(*each, marks=[pytest.mark.slow] * (each in left_out))
        for each in map(_as_tuple, parameters)
    ]


def _as_tuple(parameter: Any) -> tuple:
    return parameter if isinstance(parameter, tuple) else (parameter,)

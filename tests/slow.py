"""Parameters of tests that are left out of `make test`."""

from __future__ import annotations

from collections.abc import Iterable

import pytest


def marked_slow(parameters: Iterable, *slow) -> list:
    """Parameters, of which some are marked slow."""
    marks = {True: pytest.mark.slow, False: ()}
    return [pytest.param(each, marks=marks[each in slow]) for each in parameters]

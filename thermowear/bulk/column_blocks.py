"""Blocks of columns of loads that are solved for together."""

from __future__ import annotations

from collections.abc import Iterator

_COLUMNS = {2: 32, 3: 128}
"""Right-hand sides per solution, by dimension; limited by the caches."""
_BLOCK_MEMORY, _LEAST = 1.5e8, 32
"""Memory of the solutions of a block [bytes], unless it has the least number of columns."""


def blocks(count: int, dim: int, rows: int = 0) -> Iterator[slice]:
    """Ranges of columns of a number of rows that are solved for together, in a dimension `dim`."""
    fitting = int(_BLOCK_MEMORY / (8 * max(rows, 1)))
    size = min(_COLUMNS[dim], max(fitting, _LEAST))
    return (slice(start, min(start + size, count)) for start in range(0, count, size))

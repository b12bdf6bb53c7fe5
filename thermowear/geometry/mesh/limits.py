"""Limits on the number of cells, checked before meshing."""

from __future__ import annotations

import math

from ...errors import CaseError

MOST_CELLS = 1_000_000
"""Largest number of cells of a body: more are a unit error and would exceed the memory."""


MOST_HEXAHEDRA = 100_000
"""Largest number of cells of a body in space, with many more nodes and neighbours each."""


def check_count(*counts: float, most: int = MOST_CELLS) -> None:
    """Reject a grid of too many cells.

    Parameters
    ----------
    *counts : float
        Number of cells in each direction.
    most : int
        Largest number of cells of a body.

    Raises
    ------
    CaseError
    """
    cells = math.prod(counts)
    if not cells <= most:
        raise CaseError(
            f"geometry: dimensions and mesh.elements lead to about {cells:.2g} cells in one body; "
            f"at most {most} can be meshed; check the units, or use fewer elements"
        )

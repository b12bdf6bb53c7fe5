"""How many cells a mesh may have, checked before any of them is made."""

from __future__ import annotations

import math

from ...errors import CaseError

MOST_CELLS = 1_000_000
"""Of a body: a slip in a unit asks for more, and would fill the memory."""


MOST_HEXAHEDRA = 100_000
"""Of a body in space: a cell there has many more nodes and neighbours."""


def check_count(*counts: float, most: int = MOST_CELLS) -> None:
    """Refuse a grid of too many cells.

    Parameters
    ----------
    *counts : float
        Cells in each of its directions.
    most : int
        Cells that a body may have.

    Raises
    ------
    CaseError
    """
    cells = math.prod(counts)
    if not cells <= most:
        raise CaseError(
            f"geometry: its sizes and mesh.elements ask for about {cells:.2g} cells in one body, "
            f"at most {most} can be meshed; look for a slip in a unit, or use fewer elements"
        )

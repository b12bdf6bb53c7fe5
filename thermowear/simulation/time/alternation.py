"""Alternation of the contact area from step to step: chatter, as opposed to change.

With a conductance that jumps where points touch, faces in steady heat flow may be hot enough to
touch while apart, and too cold while they touch: neither is a solution (Barber, J. Elasticity 8
(1978) 409). In time both then alternate.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

STEPS = 100
"""Number of steps after which alternation is looked for again."""
_TURNS = 30
"""Number of turns among the last steps from which a quantity alternates; others turn rarely."""

ALTERNATES = (
    "the edge of the contact alternates between open and closed, as the conductance of the faces "
    "jumps there; steps are small. A heat.conductance that vanishes with the pressure, such as "
    '"1e5 W/(m^2 K) * p/(1 MPa)", avoids that'
)


def alternates(values: Sequence[float]) -> bool:
    """True if a quantity alternates in its last `STEPS` values."""
    last = values[-STEPS:]
    changes = [after > before for before, after in pairwise(last) if after != before]
    return sum(a != b for a, b in pairwise(changes)) >= _TURNS

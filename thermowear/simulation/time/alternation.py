"""Alternation of the contact area from step to step: chatter, as opposed to change.

With a conductance that jumps where points touch, faces in steady heat flow may be hot enough to
touch while apart, and too cold while they touch: neither is a solution (Barber, J. Elasticity 8
(1978) 409). In time both then alternate.
"""

from __future__ import annotations

from collections import deque
from itertools import pairwise

_STEPS = 100
_TURNS = 30
"""Number of turns among the last steps from which a quantity alternates; others turn rarely."""

ALTERNATES = (
    "the edge of the contact alternates between open and closed, as the conductance of the faces "
    "jumps there; steps are small. A heat.conductance that vanishes with the pressure, such as "
    '"1e5 W/(m^2 K) * p/(1 MPa)", avoids that'
)


class Alternation:
    """Last values of a quantity, to tell once that it alternates."""

    def __init__(self) -> None:
        self._values: deque[float] = deque(maxlen=_STEPS)
        self._told = False

    def begins(self, value: float) -> bool:
        """Add a value; True when it is first seen that the quantity alternates."""
        self._values.append(value)
        changes = [after > before for before, after in pairwise(self._values) if after != before]
        found = not self._told and sum(a != b for a, b in pairwise(changes)) >= _TURNS
        self._told |= found
        return found

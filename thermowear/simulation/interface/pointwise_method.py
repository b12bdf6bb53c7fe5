"""Contact solver with contact conditions at each point, on the condensed interface."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...contact.solvers.pointwise import PointwiseContact
from ...errors import CaseError
from ..system.system import System
from .condensed_method import CondensedMethod
from .contact_solver import ContactSolution


class PointwiseMethod(CondensedMethod):
    """Contact conditions at each point, from the solution of weak contact.

    Without wear, heat and friction in the section.

    Raises
    ------
    CaseError
        If there is one of them.
    """

    def __init__(self, system: System):
        super().__init__(system)
        if system.thermal is not None or system.traction is not system.trace:
            raise CaseError(_ALONE)
        self._points = PointwiseContact(system.influence, system.contact, system.holder)

    def solve(
        self, gap, slope, guess: ContactSolution | None, conditions, heat, pointwise=None
    ) -> ContactSolution:
        wears = len(slope.rows) or np.any(slope.point != self._system.softness)
        if wears or heat is not None or pointwise is not None:
            raise CaseError(_ALONE)
        weak = super().solve(gap, slope, guess, conditions, heat)
        given, start = gap + self._dead, weak.warm_start
        found = self._points.solve(
            given, slope.point, conditions.load, start.coefficients, start.motion
        )
        motion = self._given.copy()
        motion[self._free] = found.motion
        resolved = replace(start, coefficients=found.coefficients, motion=found.motion)
        return ContactSolution(found.pressure, motion, resolved)


_ALONE = 'contact.method: "pointwise" is for contact without wear, heat and friction'

"""Wear that stays in the gap to the end, and what is to be said where it is not small."""

from __future__ import annotations

import numpy as np

from ...case.tables.analyses import Fretting, Reciprocating
from ..geometry_update.gap_wear import GapWear
from ..model.system import System
from ..results.result import Interface


def not_small(system: System, interface: Interface) -> str | None:
    """What a user should know of an analysis that moves no meshes; every rank calls.

    Of one that slides to and fro, the depths are those seen where body 1 passes the middle.

    Returns
    -------
    str or None
        None where the wear is small, as it is also where ``wear.update = "never"`` says so.
    """
    analysis, allowed = system.case.analysis, system.case.wear.largest_kept
    if not isinstance(analysis, Fretting | Reciprocating):
        return None
    fraction = GapWear(system).fraction(np.array([interface.wear_1, interface.wear_2]))
    if fraction <= allowed:
        return None
    return (
        f"the wear, which a {analysis.type} analysis keeps in the gap, comes to {fraction:.2%} of "
        "the thickness behind the face or of its radius of curvature, or tilts elements by ten "
        f"times that: pressures and shapes are those of small wear, up to {allowed:.2%}"
    )

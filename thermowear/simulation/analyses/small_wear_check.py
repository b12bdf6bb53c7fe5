"""Check of the small-wear assumption for analyses without geometry updates."""

from __future__ import annotations

import numpy as np

from ...model.analyses import Analysis, FrettingAnalysis, ReciprocatingAnalysis
from ...results import InterfaceFields
from ..geometry_update.gap_wear import GapWear
from ..system.system import System


def not_small(system: System, analysis: Analysis, interface: InterfaceFields) -> str | None:
    """Note on an analysis without mesh motion that leaves the small-wear regime; every rank calls.

    In reciprocating sliding the depths are those at mid-stroke of body 1.

    Returns
    -------
    str or None
        None if the wear is small, or declared small by ``wear.update = "never"``.
    """
    if not isinstance(analysis, FrettingAnalysis | ReciprocatingAnalysis):
        return None
    allowed = analysis.largest_kept
    fraction = GapWear(system).fraction(np.array([interface.wear_1, interface.wear_2]))
    if fraction <= allowed:
        return None
    return (
        f"the wear, which a {analysis.type} analysis keeps in the gap, comes to {fraction:.2%} of "
        "the thickness behind the face or of its radius of curvature, or tilts elements by ten "
        f"times that: pressures and shapes are those of small wear, up to {allowed:.2%}"
    )

"""Requirements of a search for hot spots."""

from __future__ import annotations

from ...errors import CaseError, ComputationError
from ...model.analyses import StabilityAnalysis
from ..system.system import System


def require_waves(system: System, analysis: StabilityAnalysis) -> None:
    """Reject models without waves along the sliding.

    Raises
    ------
    CaseError
    """
    model = system.model
    ring = model.kinematics == "axisymmetric"
    if ring != bool(analysis.hot_spots):
        wanted = "an axisymmetric model" if analysis.hot_spots else "a plane-strain model"
        key = "hot_spots" if analysis.hot_spots else "wave_lengths"
        raise CaseError(f"analysis.{key}: needs {wanted}; found model = {model.kinematics!r}")
    if model.kinematics not in ("axisymmetric", "plane-strain"):
        raise CaseError(
            f"analysis.wave_lengths: found model = {model.kinematics!r}; waves along the sliding "
            "need a plane-strain section"
        )
    if not ring and any(not (i.motion.at_rest or i.motion.across) for i in model.interfaces):
        raise CaseError(
            "analysis.wave_lengths: a body slides within the section; waves along the sliding need "
            "a section normal to it (across = true)"
        )
    if system.thermal is None or system.thermal.conduction.capacity is None:
        raise ComputationError(
            "hot spots move on at least one body; they need density and specific_heat of all bodies"
        )
    unknown = set(analysis.mirror) - set(system.bodies.each[0].surfaces)
    if unknown:
        raise CaseError(f"analysis.mirror: found {sorted(unknown)[0]!r}; it is no surface")
    guided = {*model.symmetry, *(s for b in model.bodies for s in b.rollers)}
    if set(analysis.mirror) - guided:
        raise CaseError(
            f"analysis.mirror: {sorted(set(analysis.mirror) - guided)[0]} is no plane of symmetry; "
            "its normal displacement must vanish (symmetry or rollers)"
        )

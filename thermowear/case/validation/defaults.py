"""Notes on keys left out whose defaults are often not what is meant."""

from __future__ import annotations

from ...errors import note
from ..assembly.schema import AssemblyCase
from ..tables.schema import Case


def note_defaults(case: Case) -> None:
    """Note a thickness that forces act on, and conduction in a moving body as if at rest."""
    geometry, motion, moving = case.geometry, case.motion, case.geometry.bodies[1]
    _note_thickness(case, case.load.force is not None)
    if motion is None or not _conducts_by_default(case) or case.model == "axisymmetric":
        return
    if geometry.passes:
        _note_advection(moving, 'heat.advection = "resolved" carries the heat along with it')
    elif geometry.from_file and case.model != "3d":
        _note_advection(
            moving,
            "if it passes under the other body, as a strip does, give geometry.track (its length) "
            'and heat.advection = "resolved"',
        )


def note_assembly_defaults(case: AssemblyCase) -> None:
    """Note the same for several bodies."""
    _note_thickness(case, any(holder.force is not None for holder in case.holders.values()))
    passing = [body for body, motion in case.motions.items() if not motion.across]
    if len(passing) == 1 and _conducts_by_default(case) and case.model != "axisymmetric":
        _note_advection(
            passing[0],
            'heat.advection = "resolved" carries the heat along with it'
            if case.motions[passing[0]].axis is None
            else "about an axis in place nothing else is supported",
        )


def _conducts_by_default(case: Case | AssemblyCase) -> bool:
    """True if heat is conducted, and the case does not say if it is also carried along."""
    return case.heat is not None and case.heat.leaves_out("advection")


def _note_thickness(case: Case | AssemblyCase, loaded: bool) -> None:
    if loaded and case.model.startswith("plane") and case.geometry.leaves_out("thickness"):
        note("geometry.thickness is left out: forces act on a thickness of 1 mm")


def _note_advection(moving: str, remedy: str) -> None:
    note(f"heat.advection is left out: {moving} conducts heat as if it were at rest; {remedy}")

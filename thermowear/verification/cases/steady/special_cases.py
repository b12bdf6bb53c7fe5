"""Nine special cases of Páczelt and Mróz: closed forms, and running-in by finite elements."""

from __future__ import annotations

from functools import partial

from ...check import Checks
from ...closed_forms.guided import case_3, case_4, case_5, case_7
from ...closed_forms.punches import case_1, case_2, case_6, case_8, case_9
from .annular_punch import story
from .finite_elements import running_in


def _run(starter: str, label: str, *overrides: str, without: tuple[str, ...] = ()) -> Checks:
    """Running-in of a starter case with keys changed, or tables left out."""
    return partial(running_in, label, starter, *overrides, without=without)


def _thermal_keys(upper: str, *cooled: str) -> tuple[str, ...]:
    """Keys that add conduction, expansion and cooling to the bodies of a case without heat."""
    cooling = ", ".join(f"{surface}='2000 W/(m^2 K)'" for surface in cooled)
    return (
        f"bodies.{upper}.conductivity=50 W/(m K)",
        f"bodies.{upper}.expansion=1.2e-5 1/K",
        f"heat={{conductance='1e5 W/(m^2 K)', ambient='20 degC', cooling={{{cooling}}}}}",
    )


_HOT_DRUM = (
    *_thermal_keys("shoe", "shoe_inside", "drum_rim"),
    "bodies.lining.conductivity=2 W/(m K)",
    "bodies.lining.expansion=1e-5 1/K",
    "bodies.drum.conductivity=48 W/(m K)",
    "bodies.drum.expansion=1.1e-5 1/K",
)
_HOT_RING = _thermal_keys("segment", "segment_inside", "disk_rim")
_HOT_PIVOT = _thermal_keys("block", "block_top", "strip_bottom")
_HOT_TILT = _thermal_keys("punch", "punch_top", "strip_bottom")
_COLD = ("heat",)
_ARC = ("geometry.arc_start=-0.2 rad", "geometry.arc_end=0.7 rad")
_DISK, _RING, _DRUM = "block-on-disk", "ring-segment-on-disk", "drum-brake"
_PIVOT, _TILT = "pivoted-block", "punch-on-strip-tilting"

# hot speeds lie below those at which unworn faces have no steady contact with friction heat
SPECIAL_CASES: dict[Checks, tuple[Checks, ...]] = {
    case_1: (_run("punch-on-strip", "hot"), _run("punch-on-strip", "cold", without=_COLD)),
    case_2: (_run("rectangular-punch", ""),),
    case_3: (
        _run(_DISK, "hot"),
        _run(_DISK, "hot, clockwise", "motion.angular_velocity=-0.3 rad/s"),
        _run(_DISK, "cold", without=_COLD),
        _run(_DISK, "cold, arc from -0.2 to 0.7 rad", *_ARC, without=_COLD),
    ),
    case_4: (
        _run(_RING, "anticlockwise"),
        _run(_RING, "clockwise", "motion.angular_velocity=-1 rad/s"),
        _run(_RING, "hot", *_HOT_RING, "motion.angular_velocity=0.3 rad/s"),
    ),
    case_5: (
        _run(_PIVOT, "strip away from the pivot"),
        _run(_PIVOT, "strip towards the pivot", "motion.velocity=50 mm/s"),
        _run(_PIVOT, "hot", *_HOT_PIVOT, "motion.velocity=-1 mm/s"),
    ),
    case_6: (
        _run(_TILT, "strip to the right"),
        _run(_TILT, "strip to the left", "motion.velocity=50 mm/s"),
        _run(_TILT, "hot", *_HOT_TILT, "motion.velocity=-3 mm/s"),
    ),
    case_7: (
        _run(_DRUM, "leading"),
        _run(_DRUM, "trailing", "motion.angular_velocity=5 rad/s"),
        _run(_DRUM, "hot", *_HOT_DRUM, "motion.angular_velocity=-0.2 rad/s"),
    ),
    case_8: (
        _run("annular-punch", "hot"),
        _run("annular-punch-conical", ""),
        _run("annular-punch-toroidal", ""),
        story,
    ),
    case_9: (
        _run("disk-brake", "hot"),
        _run("disk-brake", "cold", without=_COLD),
        _run("disk-sector", "degree 3", "mesh.degree=3"),
    ),
}
"""Runs by closed form of the special case."""

"""Nine special cases of Páczelt and Mróz: closed forms, and running-in by finite elements."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ..check import Check, Checks
from ..closed_forms import CLOSED_FORMS
from .finite_elements import running_in
from .ring_story import story


@dataclass(frozen=True)
class _Run:
    """Running-in of a starter case with keys changed, or tables left out."""

    label: str
    starter: str
    overrides: tuple[str, ...] = ()
    without: tuple[str, ...] = ()


def _thermal_keys(upper: str, *cooled: str) -> tuple[str, ...]:
    """Keys that add conduction, expansion and cooling to the bodies of a case without heat."""
    cooling = ", ".join(f"{surface}='2000 W/(m^2 K)'" for surface in cooled)
    return (
        f"bodies.{upper}.conductivity=50 W/(m K)",
        f"bodies.{upper}.expansion=1.2e-5 1/K",
        f"heat={{conductance='1e5 W/(m^2 K)', ambient='20 degC', cooling={{{cooling}}}}}",
    )


_LINING = (
    "bodies.lining.conductivity=2 W/(m K)",
    "bodies.lining.expansion=1e-5 1/K",
    "bodies.drum.conductivity=48 W/(m K)",
    "bodies.drum.expansion=1.1e-5 1/K",
)
_COLD = ("heat",)
_DISK, _RING, _DRUM = "block-on-disk", "ring-segment-on-disk", "drum-brake"
_PIVOT, _TILT = "pivoted-block", "punch-on-strip-tilting"

# hot speeds lie below those at which unworn faces have no steady contact with friction heat
_RUNS: dict[str, tuple[_Run, ...]] = {
    "case-1": (_Run("hot", "punch-on-strip"), _Run("cold", "punch-on-strip", without=_COLD)),
    "case-2": (_Run("", "rectangular-punch"),),
    "case-3": (
        _Run("hot", _DISK),
        _Run("hot, clockwise", _DISK, ("motion.angular_velocity=-0.3 rad/s",)),
        _Run("cold", _DISK, without=_COLD),
        _Run(
            "cold, arc from -0.2 to 0.7 rad",
            _DISK,
            ("geometry.arc_start=-0.2 rad", "geometry.arc_end=0.7 rad"),
            _COLD,
        ),
    ),
    "case-4": (
        _Run("anticlockwise", _RING),
        _Run("clockwise", _RING, ("motion.angular_velocity=-1 rad/s",)),
        _Run(
            "hot",
            _RING,
            (
                *_thermal_keys("segment", "segment_inside", "disk_rim"),
                "motion.angular_velocity=0.3 rad/s",
            ),
        ),
    ),
    "case-5": (
        _Run("strip away from the pivot", _PIVOT),
        _Run("strip towards the pivot", _PIVOT, ("motion.velocity=50 mm/s",)),
        _Run(
            "hot",
            _PIVOT,
            (*_thermal_keys("block", "block_top", "strip_bottom"), "motion.velocity=-1 mm/s"),
        ),
    ),
    "case-6": (
        _Run("strip to the right", _TILT),
        _Run("strip to the left", _TILT, ("motion.velocity=50 mm/s",)),
        _Run(
            "hot",
            _TILT,
            (*_thermal_keys("punch", "punch_top", "strip_bottom"), "motion.velocity=-3 mm/s"),
        ),
    ),
    "case-7": (
        _Run("leading", _DRUM),
        _Run("trailing", _DRUM, ("motion.angular_velocity=5 rad/s",)),
        _Run(
            "hot",
            _DRUM,
            (
                *_thermal_keys("shoe", "shoe_inside", "drum_rim"),
                *_LINING,
                "motion.angular_velocity=-0.2 rad/s",
            ),
        ),
    ),
    "case-8": (
        _Run("hot", "annular-punch"),
        _Run("", "annular-punch-conical"),
        _Run("", "annular-punch-toroidal"),
    ),
    "case-9": (
        _Run("hot", "disk-brake"),
        _Run("cold", "disk-brake", without=_COLD),
        _Run("degree 3", "disk-sector", ("mesh.degree=3",)),
    ),
}


def _checks_of(id: str) -> Checks:
    def checks() -> Iterator[Check]:
        yield from CLOSED_FORMS[id]()
        for one in _RUNS[id]:
            yield from running_in(one.label, one.starter, *one.overrides, without=one.without)
        if id == "case-8":
            yield from story()

    return checks


CHECKS: dict[str, Checks] = {id: _checks_of(id) for id in _RUNS}
"""Checks by id of the special case."""

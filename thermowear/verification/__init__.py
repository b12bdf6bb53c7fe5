"""Verification of the program against references, for ``thermowear verify`` and the tests."""

from __future__ import annotations

import importlib

from .cases import special_cases
from .check import Check, Checks, all_checks, compare, identified

_FILES = (
    "annular_punch", "running_in", "patch", "hertz_line", "hertz_sphere", "flat_punch",
    "methods_agree", "mindlin", "growing_cylinder", "growing_sphere", "block_on_ring",
    "pin_on_disc", "deep_wear", "beam_shakedown", "fretting_wear", "fretting_cylinder",
    "fuel_fretting", "reciprocating", "moving_band", "two_slabs", "pressure_conductance",
    "temperature_dependent", "minimality", "step_flux", "braking_stop", "sliding_rod",
    "half_plane_instability", "optimal_shape",
)  # fmt: skip
"""Modules in `cases` with one case each, in the order of ``verify``."""

_CHECKS: dict[str, Checks] = special_cases.CHECKS | {
    name.replace("_", "-"): importlib.import_module(f".cases.{name}", __name__).checks
    for name in _FILES
}
CASES = {id: identified(id, checks) for id, checks in _CHECKS.items()}
"""Verification cases by id; each yields its checks."""

SLOW = frozenset({"deep-wear"})
"""Cases that take more than two minutes."""

__all__ = ["CASES", "SLOW", "Check", "all_checks", "compare"]

"""Verification of the program against references, for ``thermowear verify`` and the tests."""

from .cases import (
    annular_punch,
    beam_shakedown,
    block_on_ring,
    braking_stop,
    deep_wear,
    flat_punch,
    fretting_cylinder,
    fretting_wear,
    fuel_fretting,
    growing_cylinder,
    growing_sphere,
    half_plane_instability,
    hertz_line,
    hertz_sphere,
    methods_agree,
    mindlin,
    minimality,
    moving_band,
    optimal_shape,
    patch,
    pin_on_disc,
    pressure_conductance,
    reciprocating,
    running_in,
    sliding_rod,
    special_cases,
    step_flux,
    temperature_dependent,
    two_slabs,
)
from .check import Check, Checks, all_checks, compare

CASES: dict[str, Checks] = special_cases.CHECKS | {
    case.ID: case.checks
    for case in (
        annular_punch,
        running_in,
        patch,
        hertz_line,
        hertz_sphere,
        flat_punch,
        methods_agree,
        mindlin,
        growing_cylinder,
        growing_sphere,
        block_on_ring,
        pin_on_disc,
        deep_wear,
        beam_shakedown,
        fretting_wear,
        fretting_cylinder,
        fuel_fretting,
        reciprocating,
        moving_band,
        two_slabs,
        pressure_conductance,
        temperature_dependent,
        minimality,
        step_flux,
        braking_stop,
        sliding_rod,
        half_plane_instability,
        optimal_shape,
    )
}
"""Verification cases by id; each yields its checks."""

SLOW = frozenset({deep_wear.ID})
"""Cases that take more than two minutes."""

__all__ = ["CASES", "SLOW", "Check", "all_checks", "compare"]

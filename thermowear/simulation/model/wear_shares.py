"""Softness of each body, which defines the position of the common face between the bodies."""

from __future__ import annotations

from ...case.tables.analyses import Fretting
from ...case.tables.schema import Case
from ...laws.plausible import typical_rate
from .wear_laws import wear_laws

LEAST = 1e-9
"""Softness of a body with an unchanging face, where that of the other body is 1."""


def softness_of_parts(case: Case) -> dict[str, float]:
    """Softness of each part of the bodies for `contact.search.common_face`; only ratios count.

    The gap between opposite points closes by the elastic deflection of both bodies. In continued
    sliding wear the deflection is soon small compared with the wear depths: the shares are then in
    the ratio of the wear rates.
    """
    wearing = _wear_rates(case)
    if not wearing:
        return {part: _elastic(case, part) for part in case.geometry.parts}
    largest = max(wearing.values()) or 1.0  # all rates are 0 below a threshold
    softness: dict[str, float] = {}
    for index, body in enumerate(case.geometry.bodies):
        share = max(wearing.get(index, 0.0) / largest, LEAST)
        softness |= dict.fromkeys(case.geometry.parts_of(body), share)
    return softness


def closes_by_wear(case: Case) -> bool:
    """True if the softness follows the wear rates, not the elastic compliance."""
    return bool(_wear_rates(case))


def _elastic(case: Case, part: str) -> float:
    """Plane-strain compliance ``(1 - ν²) / E`` [1/Pa]."""
    material = case.material(part)
    assert material.young_modulus is not None  # the case has been checked
    assert material.poisson_ratio is not None
    return (1 - material.poisson_ratio**2) / material.young_modulus


def _wear_rates(case: Case) -> dict[int, float]:
    """Wear rates at a typical pressure of the bodies that wear in place, by index [m/s]."""
    if isinstance(case.analysis, Fretting):
        return {}
    bodies = case.geometry.bodies
    return {
        index: typical_rate(law, case.contact.nominal_friction)
        for index, law in wear_laws(case).items()
        if case.wear[bodies[index]].spread == "in-place"
    }

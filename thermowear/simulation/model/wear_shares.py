"""How much each body gives way where the faces close: what the common face is found from."""

from __future__ import annotations

from ...case.tables.analyses import Fretting
from ...case.tables.schema import Case
from ...laws.plausible import typical_rate
from .wear_laws import wear_laws

LEAST = 1e-9
"""Softness of a body whose face does not change, where that of the other one is 1."""


def softness_of_parts(case: Case) -> dict[str, float]:
    """Softness of each part of the bodies for `contact.common_face`; only ratios count.

    The gap between opposite points closes by the elastic deflection of both bodies. Where bodies
    slide and wear on and on, the deflection is soon small beside the wear, and closes by what each
    of them loses: the shares are those of the wear rates.
    """
    wearing = _wear_rates(case)
    if not wearing:
        return {part: _elastic(case, part) for part in case.geometry.parts}
    largest = max(wearing.values()) or 1.0  # below a threshold none of them wears
    softness: dict[str, float] = {}
    for index, body in enumerate(case.geometry.bodies):
        share = max(wearing.get(index, 0.0) / largest, LEAST)
        softness |= dict.fromkeys(case.geometry.parts_of(body), share)
    return softness


def closes_by_wear(case: Case) -> bool:
    """Whether softness is that of wear."""
    return bool(_wear_rates(case))


def _elastic(case: Case, part: str) -> float:
    """``(1 - ν²) / E`` [1/Pa]."""
    material = case.material(part)
    assert material.young_modulus is not None  # the case has been checked
    assert material.poisson_ratio is not None
    return (1 - material.poisson_ratio**2) / material.young_modulus


def _wear_rates(case: Case) -> dict[int, float]:
    """Wear rates of the bodies whose faces change, by index, at one pressure [m/s]."""
    if isinstance(case.analysis, Fretting):
        return {}
    bodies = case.geometry.bodies
    return {
        index: typical_rate(law, case.contact.nominal_friction)
        for index, law in wear_laws(case).items()
        if case.wear[bodies[index]].spread == "in-place"
    }

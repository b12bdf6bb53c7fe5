"""How much each body gives way where the faces close: what the common face is found from."""

from __future__ import annotations

from ..case.analyses import Transient
from ..case.schema import Case
from .wear_laws import wear_laws

_PRESSURE, _SPEED = 1e7, 0.1
"""At which wear rates are compared: bodies that rub have the same exponents as a rule [Pa, m/s]."""
LEAST = 1e-9
"""Share of a body that does not wear, where the other one does."""


def softness_of_parts(case: Case) -> dict[str, float]:
    """Softness of each part of the bodies for `contact.common_face`; only ratios count.

    The gap between opposite points closes by the elastic deflection of both bodies. Where bodies
    wear on and on, the deflection is soon small beside the wear, and the common face is that of
    the body which wears less.
    """
    wearing = _wear_rates(case)
    if wearing:
        bodies = case.geometry.bodies
        largest = max(wearing.values())
        rates = [max(wearing.get(k, 0.0), LEAST * largest) for k in range(len(bodies))]
        pairs = zip(bodies, rates, strict=True)
        return {part: rate for body, rate in pairs for part in case.geometry.parts_of(body)}
    return {part: _elastic(case, part) for part in case.geometry.parts}


def _elastic(case: Case, part: str) -> float:
    """``(1 - ν²) / E`` [1/Pa]."""
    material = case.material(part)
    assert material.young_modulus is not None  # the case has been checked
    assert material.poisson_ratio is not None
    return (1 - material.poisson_ratio**2) / material.young_modulus


def _wear_rates(case: Case) -> dict[int, float]:
    """Wear rates of the bodies whose faces change, by index, at one pressure [m/s]."""
    if not isinstance(case.analysis, Transient):
        return {}
    bodies = case.geometry.bodies
    return {
        index: float(law.rate(_PRESSURE, _SPEED))
        for index, law in wear_laws(case).items()
        if case.wear[bodies[index]].spread == "in-place"
    }

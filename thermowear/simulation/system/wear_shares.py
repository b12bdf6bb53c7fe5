"""Softness of each body, which defines the position of the common face between the bodies."""

from __future__ import annotations

from ...model.model import Model

LEAST = 1e-9
"""Softness of a body with an unchanging face, where that of the other body is 1."""


def softness_of_parts(model: Model) -> dict[str, float]:
    """Softness of each part of the bodies for `contact.search.common_face`; only ratios count.

    The gap between opposite points closes by the elastic deflection of both bodies. In continued
    sliding wear the deflection is soon small compared with the wear depths: the shares are then in
    the ratio of the wear rates.
    """
    wearing = model.interface.wearing_in_place
    if not wearing:
        return {part: material.compliance for part, material in model.materials.items()}
    largest = max(wearing.values()) or 1.0  # all rates are 0 below a threshold
    softness: dict[str, float] = {}
    for index, body in enumerate(model.bodies):
        share = max(wearing.get(index, 0.0) / largest, LEAST)
        softness |= dict.fromkeys(body.parts, share)
    return softness

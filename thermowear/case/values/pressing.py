"""Normal load of a contact, for estimates of its zone."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Pressing:
    """Normal load and contact modulus, for estimates of the contact zone.

    Attributes
    ----------
    force : float or None
        Normal force [N]; None if the approach is given.
    approach : float or None
        Approach [m]; None if the force is given.
    modulus : float
        Contact modulus E*, ``1/E* = Σ (1 - ν²)/E`` [Pa].
    """

    force: float | None
    approach: float | None
    modulus: float

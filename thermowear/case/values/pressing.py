"""Normal load of a contact, for estimates of its zone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

_FOR_EVER = "steady", "stability"
"""Analyses of wear that goes on for ever, which brings whole faces into contact."""


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


def resolving(case: Any, pressing: Callable[[], Sequence[Pressing | None]]) -> Any:
    """Geometry of a case; one from CAD knows the small zones that loads of its contacts close.

    Parameters
    ----------
    case : Case or AssemblyCase
    pressing : callable
        Loads of the contacts that slide; None where there is none to estimate a zone from.
    """
    geometry, mesh = case.geometry, case.mesh
    sized = geometry.sized and any(mesh.sizes(body)[1] is None for body in geometry.bodies)
    if not sized or case.analysis.type in _FOR_EVER:
        return geometry
    return geometry.pressed(pressing())

"""Balances that every run must satisfy: equilibrium, heat, and worn volume.

They are computed independently of the solution, so that errors of either become visible. A run
that violates them ends as a failed computation; its results stay readable.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .errors import ComputationError

ALLOWED = 1e-6
"""Largest relative error allowed of a balance."""


@dataclass(frozen=True)
class Balance:
    """Balance with its name, the reference scale of its error, and a remedy for violations."""

    name: str
    scale: str
    remedy: str


BALANCES = {
    "equilibrium_relative_error": Balance(
        "equilibrium",
        "the forces on the bodies",
        "the stiffness is too ill-conditioned: use Poisson ratios farther from 0.5, stiffnesses of "
        "the parts of a body that differ by less, or a lower mesh.degree",
    ),
    "heat_balance_relative_error": Balance(
        "heat balance",
        "the heat turned over",
        "some heat has hardly a way out: check heat.cooling and heat.temperature, and use "
        "conductivities and cooling that differ by less",
    ),
    "geometry_volume_error": Balance(
        "worn volume",
        "the volume worn off",
        "the moved mesh does not follow the worn face: use more elements along the contact "
        "(mesh.elements) or a smaller wear.update",
    ),
}
"""All balances by the key of their error in the summary."""


def holds(error: float) -> bool:
    """Test whether a relative error is within the allowed limit; NaN is not."""
    return abs(error) <= ALLOWED


def relative(missing: float, scale: float) -> float:
    """Defect of a balance relative to a scale; infinite where it is not a number."""
    if missing == 0.0:
        return 0.0
    error = abs(missing) / scale if scale > 0.0 else math.inf
    return error if math.isfinite(error) else math.inf


def violated(summary: Mapping[str, Any]) -> list[str]:
    """One line per violated balance of a summary: its name, error and remedy."""
    return [
        f"the {balance.name} has a relative error of {summary[key]:.1e} of {balance.scale} "
        f"(allowed: {ALLOWED:g}); {balance.remedy}"
        for key, balance in BALANCES.items()
        if isinstance(summary.get(key), int | float) and not holds(summary[key])
    ]


def judged(summary: Mapping[str, Any]) -> ComputationError | None:
    """Error of a run with violated balances; None if all hold."""
    found = violated(summary)
    return ComputationError("not balanced: " + "; ".join(found)) if found else None


def require(**errors: float) -> None:
    """Raise an error if any of the balances, given by their keys, is violated.

    Raises
    ------
    ComputationError
    """
    error = judged(errors)
    if error is not None:
        raise error

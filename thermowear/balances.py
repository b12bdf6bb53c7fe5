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


_STIFF = (
    "the stiffness is too ill-conditioned: use Poisson ratios farther from 0.5, stiffnesses of the "
    "parts of a body that differ by less, or a lower mesh.degree"
)
BALANCES = {
    "equilibrium_relative_error": Balance(
        "equilibrium",
        "the forces on the bodies",
        _STIFF,
    ),
    "force_balance_relative_error": Balance("balance of forces", "the forces on it", _STIFF),
    "moment_balance_relative_error": Balance(
        "balance of moments", "the forces times the size of the body", _STIFF
    ),
    "heat_balance_relative_error": Balance(
        "heat balance",
        "the heat turned over",
        "some heat has hardly a way out: check heat.cooling and heat.temperature, and use "
        "conductivities and cooling that differ by less",
    ),
    "wear_volume_relative_error": Balance(
        "worn volume by the wear rates in time",
        "the volume worn off",
        "the wear of the track is not that of its contacts: use more elements along the contacts "
        "(mesh.elements)",
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
        f"the {balance.name}{where} has a relative error of {error:.1e} of {balance.scale} "
        f"(allowed: {ALLOWED:g}); {balance.remedy}"
        for where, balance, error in errors_of(summary)
        if not holds(error)
    ]


def errors_of(summary: Mapping[str, Any]) -> list[tuple[str, Balance, float]]:
    """Balances of a summary with their errors: those of all bodies, then of each of several.

    With the body that each belongs to, as in " of disk"; empty for all bodies.
    """
    bodies = summary.get("bodies")
    each = bodies.items() if isinstance(bodies, Mapping) else ()
    tables = [("", summary), *((f" of {name}", table) for name, table in each)]
    return [
        (where, balance, table[key])
        for where, table in tables
        for key, balance in BALANCES.items()
        if isinstance(table.get(key), int | float)
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

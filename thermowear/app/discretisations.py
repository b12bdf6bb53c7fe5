"""Comparison of a case with a coarser and a finer discretisation: ``run --accuracy``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from .. import load
from ..case import Case
from ..errors import CaseError, ComputationError

COMPARED = (
    "dofs_displacement",
    "contact_points",
    "max_pressure_Pa",
    "mean_pressure_Pa",
    "contact_area_m2",
    "approach_m",
    "shape_range_m",
    "max_temperature_K",
    "pressure_error_estimate_relative",
    "max_pressure_error_estimate_relative",
    "shape_error_estimate_relative",
    "temperature_error_estimate_relative",
)
"""Keys of the summary that are compared."""
_LOWEST, _HIGHEST = 1, 10


def neighbours(case: Case) -> dict[str, tuple[str, ...]]:
    """Overrides of a case for a coarser and a finer discretisation.

    One polynomial degree lower and higher, also of the pressure space if its degree is given; half
    and twice the number of elements at the limits of the degree.
    """
    return {"coarser": _changed(case, -1), "finer": _changed(case, 1)}


def _changed(case: Case, by: int) -> tuple[str, ...]:
    degree, given = case.mesh.degree + by, case.contact.pressure_degree
    if not _LOWEST <= degree <= _HIGHEST:
        elements = max(case.mesh.elements // 2, 1) if by < 0 else 2 * case.mesh.elements
        return (f"mesh.elements={elements}",)
    changes = [f"mesh.degree={degree}"]
    if isinstance(given, int):
        pressure_degree = min(max(given + by, _LOWEST), _HIGHEST)
        changes.append(f"contact.pressure_degree={pressure_degree}")
    return tuple(changes)


def side_by_side(path: Path, overrides: tuple[str, ...], comm) -> dict[str, dict[str, Any]]:
    """Compute the coarser and finer discretisations for the summary of a case. Every rank calls.

    If one of them cannot be computed, its entry contains the reason instead of numbers.
    """
    from ..simulation import run

    found: dict[str, dict[str, Any]] = {}
    for name, changes in neighbours(load(path, overrides)).items():
        entry: dict[str, Any] = {"changes": ", ".join(changes)}
        try:
            result = run(load(path, (*overrides, *changes)), comm)
            if result.stopped is not None:
                raise result.stopped
            entry |= {key: result.summary.get(key) for key in COMPARED}
        except (CaseError, ComputationError) as error:
            entry["failed"] = str(error)
        found[f"{name}_discretisation"] = entry
    return found

"""A case on a coarser and on a finer discretisation beside its own: ``run --accuracy``."""

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
"""Keys of the summary that are shown side by side."""
_LOWEST, _HIGHEST = 1, 10


def neighbours(case: Case) -> dict[str, tuple[str, ...]]:
    """Changes of a case that make it coarser and finer, by what it becomes.

    One polynomial degree lower and higher, and of the pressure space likewise where it is given;
    where there is no such degree, half and twice the elements.
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
    """Numbers of the neighbours of a case file, as its summary keeps them. Every rank calls.

    A neighbour that cannot be computed has the reason in the place of its numbers.
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

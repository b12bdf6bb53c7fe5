"""Cells of the probes of a model."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ...bulk.bodies import Bodies
from ...bulk.points import CellPoint, located
from ...errors import CaseError
from ...model.model import Model
from ...model.probe import Probe


def probe_points(
    model: Model, bodies: Bodies, worn: bool = False
) -> tuple[list[CellPoint | None], np.ndarray]:
    """Cells of the probes. Every rank calls.

    Parameters
    ----------
    model : Model
    bodies : Bodies
    worn : bool, optional
        True if meshes have followed the wear, so that probes may have been worn off.

    Returns
    -------
    cells : list of CellPoint or None
        None on the ranks that do not own the cell.
    lost : ndarray of bool, shape (n_probes,)
        Probes outside their body.

    Raises
    ------
    CaseError
        If a probe lies in no body, in several ones, or the model has no heat.
    """
    if model.probes and model.heat is None:
        raise CaseError(f"probes.{model.probes[0].name}: needs temperatures, the model has no heat")
    owners = {part: body.name for body in model.bodies for part in body.parts}
    dim = bodies.dim
    for probe in model.probes:
        if len(probe.point) != dim:
            raise CaseError(f"probes.{probe.name}.point: needs {dim} coordinates")
    found = located(bodies, [probe.point for probe in model.probes], owners)
    names = [_owner(probe, at, worn) for probe, at in zip(model.probes, found, strict=True)]
    cells = [None if name is None else at[name] for name, at in zip(names, found, strict=True)]
    return cells, np.array([name is None for name in names], dtype=bool)


def _owner(probe: Probe, bodies: Iterable[str], worn: bool) -> str | None:
    """Body of a probe among those that its point lies in; None if it has been worn off."""
    inside = [name for name in bodies if probe.body in (None, name)]
    if len(inside) == 1:
        return inside[0]
    path, point = f"probes.{probe.name}", ", ".join(f"{x:g}" for x in probe.point)
    if inside:
        raise CaseError(
            f"{path}: the point ({point}) m lies in {' and '.join(inside)}; give the body"
        )
    if worn:
        return None
    where = "all bodies" if probe.body is None else f"the body {probe.body!r}"
    raise CaseError(f"{path}.point: the point ({point}) m lies outside {where}")

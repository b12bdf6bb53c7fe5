"""Consistency checks of the probes of the temperature."""

from __future__ import annotations

from collections.abc import Iterator

from ..any_case import AnyCase
from ..values.section import Fault

_SUPPORTED = ("initial", "steady", "transient")
"""Analyses with temperatures at probes."""


def probes(case: AnyCase) -> Iterator[Fault]:
    """Probes have the coordinates of the model, a known body, and temperatures to measure."""
    count, type_ = 3 if case.model == "3d" else 2, case.analysis.type
    for name, probe in case.probes.items():
        path = f"probes.{name}"
        if case.heat is None:
            yield path, "needs temperatures: a table [heat]"
        elif type_ not in _SUPPORTED:
            yield path, f"is not supported in a {type_} analysis"
        if len(probe.point) != count:
            found = len(probe.point)
            yield f"{path}.point", f"found {found} coordinates; a {case.model} model has {count}"
        if probe.body is not None and probe.body not in case.geometry.bodies:
            yield f"{path}.body", f"unknown body; must be one of: {', '.join(case.geometry.bodies)}"

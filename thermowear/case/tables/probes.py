"""Probes of the temperature."""

from __future__ import annotations

from ..values import units
from ..values.section import Section


class ProbeTable(Section):
    """Table ``probes.NAME``, see `model.probe.Probe`.

    Attributes
    ----------
    point : tuple of float
        Two coordinates, in space three [m].
    body : str or None
        Needed only where the point lies in several bodies.
    """

    point: tuple[units.Coordinate, ...]
    body: str | None = None

"""Probe: point of a body whose temperature is recorded."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Probe:
    """Point of a body whose temperature is recorded, as by a thermocouple.

    Attributes
    ----------
    name : str
    point : tuple of float
        Coordinates in the mesh of the body; (r, z) in an axisymmetric model [m].
    body : str or None
        Name of the body; None: the only body that the point lies in.
    """

    name: str
    point: tuple[float, ...]
    body: str | None = None

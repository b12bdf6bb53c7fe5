"""Discretisation of the bodies."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Discretisation:
    """Finite-element spaces on the mesh.

    Attributes
    ----------
    degree : int
        Polynomial degree of displacement and temperature.
    positioning : bool
        Move the mesh until element ends coincide with the contact edges.
    """

    degree: int
    positioning: bool = False

"""Stack of layers that touch: pads and disk, a clutch pack, the rings of a seal."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Literal

from pydantic import model_validator

from ...case.assembly.geometry import AssemblyGeometry
from ...case.values.section import KeyFault, Section
from ...case.values.units import Angle, Coordinate, Length
from ..checks.assembly_checks import check_drawn
from ..meshing.stacked_layers import Layer, stacked_layers, surface_names


class LayerTable(Section):
    """Layer of a stack.

    Attributes
    ----------
    x : tuple of float
        Its range of x, or of the radius in an axisymmetric model [m].
    height : float
        Height of the layer [m].
    """

    x: tuple[Coordinate, Coordinate]
    height: Length

    @model_validator(mode="after")
    def _ordered(self):
        if not self.x[0] < self.x[1]:
            raise KeyFault("x", "the first value must be less than the second one")
        return self


class Stack(AssemblyGeometry):
    """Layers on top of each other, each in contact with the next one.

    The contact of two layers is named after both of them, ``upper-lower``. The surfaces of a layer
    are its ``top`` and ``bottom`` (where a neighbour covers a part of it, this part, and the rest
    ``top_rest`` and ``bottom_rest``), ``inside`` and ``outside``.

    Attributes
    ----------
    layers : dict of str to LayerTable
        From the top downwards; the first one ends at y = 0.
    thickness : float
        Thickness of a plane model, which forces refer to [m].
    angle : float
        Angle about the axis that the layers cover; forces and powers refer to this sector [rad].
    whole : tuple of str
        Layers that are whole rings, which pass through this sector.
    """

    name = "stack"
    models = ("axisymmetric", "plane-strain", "plane-stress")
    has_skin = True

    type: Literal["stack"]
    layers: dict[str, LayerTable]
    thickness: Length = 1e-3
    angle: Angle = 2 * math.pi
    whole: tuple[str, ...] = ()

    @model_validator(mode="after")
    def _touching(self):
        if len(self.layers) < 2:
            raise KeyFault("layers", f"needs two or more layers; found {len(self.layers)}")
        for (one, upper), (other, lower) in pairwise(self.layers.items()):
            if min(upper.x[1], lower.x[1]) <= max(upper.x[0], lower.x[0]):
                raise KeyFault(f"layers.{other}.x", f"does not overlap that of {one}, next to it")
        for name in self.whole:
            if name not in self.layers:
                raise KeyFault(
                    "whole", f"found {name!r}; must be some of: {', '.join(self.layers)}"
                )
        if not 0 < self.angle <= 2 * math.pi * (1 + 1e-12):
            raise KeyFault("angle", "must be greater than 0 deg, at most 360 deg")
        return self

    @property
    def bodies(self) -> tuple[str, ...]:
        return tuple(self.layers)

    @property
    def surfaces(self) -> tuple[str, ...]:
        return surface_names(self._layers)

    @property
    def contacts(self) -> dict[str, tuple[str, str]]:
        return {f"{a}-{b}": (f"{a}_bottom", f"{b}_top") for a, b in pairwise(self.layers)}

    @property
    def thickness_factor(self) -> float | None:  # type: ignore[override]
        return self.thickness

    @property
    def sector(self) -> float:  # type: ignore[override]
        return self.angle / (2 * math.pi)

    @property
    def rings(self) -> tuple[str, ...]:  # type: ignore[override]
        return self.whole

    @property
    def _layers(self) -> dict[str, Layer]:
        return {name: Layer(*layer.x, layer.height) for name, layer in self.layers.items()}

    def press_direction(self, surface: str) -> tuple[float, ...]:
        return (0.0, 1.0) if surface.endswith("_bottom") else (0.0, -1.0)

    def check(self, mesh, case):
        check_drawn(mesh, case)

    def build(self, mesh):
        return stacked_layers(self._layers, mesh.face, mesh.row)

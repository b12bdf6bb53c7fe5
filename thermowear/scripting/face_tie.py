"""Glued faces of bodies on users' meshes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ..case.values import units
from ..case.values.units import in_python
from ..errors import CaseError
from ..model.tie import Tie
from .body import BodySurface, MeshBody, require_surface


@dataclass(frozen=True, eq=False)
class FaceTie:
    """Two glued faces, on any meshes.

    Attributes
    ----------
    one, other : BodySurface
    conductance : float, quantity or None
        Conductance of the joint; None: continuous temperature [W/(m² K)].
    """

    one: BodySurface
    other: BodySurface
    conductance: Any = None

    def __post_init__(self):
        for face in self.faces:
            require_surface(face, "Tie")
        if self.one.body is self.other.body:
            raise CaseError("Tie: both faces are on the same body")

    @property
    def faces(self) -> tuple[BodySurface, BodySurface]:
        """Glued faces."""
        return self.one, self.other

    def in_model(self, bodies: Sequence[MeshBody]) -> Tie:
        """Tie of a model with given bodies."""
        h = self.conductance
        if h is not None:
            h = in_python(units.LeastHeatTransfer, h, "Tie.conductance")
        one, other = (bodies.index(face.body) for face in self.faces)
        name = f"{self.one.body.name}-{self.other.body.name}"
        return Tie((self.one.name, self.other.name), (one, other), name, h)

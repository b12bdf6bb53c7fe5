"""Table ``wear``: wear law of each body, of its layers and parts, settings of geometry updates."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Annotated, ClassVar, Literal

from pydantic import ConfigDict, Field, model_validator

from ...values.regions import RegionOfSpace
from ...values.section import KeyFault, Section, number_or
from .layers import LayersTable
from .wear_rate import RateTable


class PartWearTable(RateTable):
    """Wear law of a part of a contact face.

    Attributes
    ----------
    where : Region or None
        Region of a part by the place; without it the name is that of a cell set or zone.
    """

    where: RegionOfSpace | None = None


class BodyWearTable(RateTable):
    """Wear law of one body, and those of its parts.

    Attributes
    ----------
    spread : str
        ``"in-place"``: wear at the contact points; ``"track"``: wear of body 2 along its whole
        track: uniform in plane models; on a rotating disk at each radius, multiplied by the
        fraction of a turn for which it is under the pad.
    layers : LayersTable or None
        Layers on the face; the body's own law is that of the substrate below them.
    materials : dict of str to PartWearTable
        Wear laws by cell set of a mesh file, by zone of a geometry, or by a name of their own for a
        region (`where`). All other cells of the face
        wear by the body's own law, which may be omitted if there are none.
    """

    spread: Literal["in-place", "track"] = "in-place"
    layers: LayersTable | None = None
    materials: dict[str, PartWearTable] = {}

    @property
    def has_law(self) -> bool:
        return not self.materials or bool(self.model_fields_set & RateTable.model_fields.keys())

    @model_validator(mode="after")
    def _layers_fit(self):
        for layer, law in enumerate(self.of_layers):
            try:
                if law.rate is None:
                    law.require_coefficient()
            except KeyFault as fault:
                raise KeyFault(f"layers.coefficient.{layer}", str(fault)) from None
        return self

    @property
    def of_layers(self) -> tuple[RateTable, ...]:
        """Law of each layer, from the surface down."""
        return () if self.layers is None else self.layers.each(self)


_UPDATE = number_or(
    "auto",
    "never",
    where=lambda size: 0.0 < size <= 1.0,
    allowed='"auto", "never", or a number up to 1',
)


class WearTable(Section, Mapping[str, BodyWearTable]):
    """Wear laws by body, a mapping to `BodyWearTable`, and settings of the geometry updates.

    Attributes
    ----------
    update : str or float
        Largest gap wear before a geometry update, relative to the sizes of the bodies: a number,
        ``"auto"`` for `AUTOMATIC`, or ``"never"`` for no updates.
    cycles : int or None
        Number of cycles of a fretting or reciprocating analysis.
    max_jump : int or None
        Largest cycle jump.
    """

    model_config = ConfigDict(extra="allow")

    AUTOMATIC: ClassVar[float] = 0.01

    __pydantic_extra__: dict[str, BodyWearTable]

    update: Annotated[float | Literal["auto", "never"], _UPDATE] = "auto"
    cycles: Annotated[int, Field(ge=1, strict=True)] | None = None
    max_jump: Annotated[int, Field(ge=1, strict=True)] | None = None

    @property
    def largest_kept(self) -> float:
        """Largest gap wear, relative to the sizes of the bodies."""
        if self.update == "never":
            return math.inf
        return self.AUTOMATIC if self.update == "auto" else float(self.update)

    @property
    def laws(self) -> dict[str, RateTable]:
        """Wear laws of bodies and parts, by the path of their table below ``wear``."""
        found: dict[str, RateTable] = {}
        for name, body in self.items():
            found |= {name: body} if body.has_law else {}
            found |= {f"{name}.materials.{part}": law for part, law in body.materials.items()}
        return found

    def __getitem__(self, body: str) -> BodyWearTable:
        return self.__pydantic_extra__[body]

    def __iter__(self) -> Iterator[str]:  # type: ignore[override]
        return iter(self.__pydantic_extra__)

    def __len__(self) -> int:
        return len(self.__pydantic_extra__)

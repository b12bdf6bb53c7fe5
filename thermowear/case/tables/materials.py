"""Materials of a body, or the name of the body whose material it shares."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from ..values import units
from ..values.section import Number, Section
from .tabulated import ExpansionTable, TemperatureTable


class Properties(Section):
    """Keys of `model.body.Material`, or the name of the body whose material applies (``like``).

    Tables of factors are `conductivity_factor` and `expansion_factor`.
    """

    like: str | None = None
    young_modulus: units.Pressure | None = None
    poisson_ratio: Annotated[Number, Field(gt=-1.0, lt=0.5)] | None = None
    conductivity: units.Conductivity | None = None
    expansion: units.Expansion | None = None
    density: units.Density | None = None
    specific_heat: units.SpecificHeat | None = None
    hardness: units.Pressure | None = None
    conductivity_factor: TemperatureTable | None = None
    expansion_factor: ExpansionTable | None = None


class MaterialTable(Properties):
    """Material of a cell set in a body."""


class BodyTable(Properties):
    """Material of a body, and of cell sets in it.

    Attributes
    ----------
    materials : dict of str to MaterialTable
        Materials by cell set of a mesh file. All other cells of the body have the body's own
        material, which may be omitted if every cell set of the body has one.
    """

    materials: dict[str, MaterialTable] = {}

    @property
    def has_own(self) -> bool:
        """True if the body has a material of its own, besides those of its cell sets."""
        return bool(self.model_fields_set - {"materials"})

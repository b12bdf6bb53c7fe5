"""Selection of the geometry class by ``geometry.type``."""

from __future__ import annotations

import importlib
from typing import Annotated, Any

from pydantic import BeforeValidator, SerializeAsAny, ValidationInfo

from ...errors import quoted
from ..values.section import KeyFault
from .geometry import KNOWN, Geometry


def known_geometries() -> dict[str, type[Geometry]]:
    """All geometries that a case file can name, sorted by name.

    Imports their room by name where this has not been done yet, as that room imports this one.
    """
    importlib.import_module("thermowear.geometry.geometries")
    return dict(sorted(KNOWN.items()))


def _pick(data: Any, info: ValidationInfo) -> Any:
    if isinstance(data, Geometry):
        return data
    if not isinstance(data, dict):
        raise ValueError(f"found {quoted(data)}; must be a table")
    if "type" not in data:
        raise KeyFault("type", f"missing; one of: {', '.join(known_geometries())}")
    try:
        kind = known_geometries()[data["type"]]
    except (KeyError, TypeError):
        raise KeyFault(
            "type", f"found {quoted(data['type'])}; must be one of: {', '.join(known_geometries())}"
        ) from None
    return kind.model_validate(data, context=info.context)


AnyGeometry = Annotated[SerializeAsAny[Geometry], BeforeValidator(_pick)]

"""Choice of the geometry of a case by the key ``type`` of its table."""

from __future__ import annotations

import importlib
from typing import Annotated, Any

from pydantic import BeforeValidator, SerializeAsAny, ValidationInfo

from ...errors import quoted
from ..values.json_schema import AnyOf
from ..values.section import MODEL, KeyFault
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
    known, name = known_geometries(), data.get("type")
    if "type" not in data:
        raise KeyFault("type", f"missing; one of: {', '.join(known)}")
    if not isinstance(name, str) or name not in known:
        raise KeyFault("type", f"found {quoted(name)}; must be one of: {', '.join(known)}")
    context = (info.context or {}) | {MODEL: info.data.get("model")}
    return known[name].model_validate(data, context=context)


AnyGeometry = Annotated[
    SerializeAsAny[Geometry], BeforeValidator(_pick), AnyOf(typed=known_geometries)
]

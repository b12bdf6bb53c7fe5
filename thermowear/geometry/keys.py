"""Types of keys that several geometries share."""

from typing import Annotated

from pydantic import AfterValidator

from ..case.section import Switch
from ..case.units import quantity


def _refuse(half: bool) -> bool:
    if half:
        raise ValueError("found true; this geometry is not symmetric, it is meshed whole")
    return half


Distance = quantity("m", "0.05 mm", ge=0)
Whole = Annotated[Switch, AfterValidator(_refuse)]
"""The key `half` of plane bodies that are not symmetric."""

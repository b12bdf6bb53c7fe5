"""A flat punch with sharp edges on a strip that moves along x under it.

The contact lies at y = 0 and is centred at x = 0.
"""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from ..case.units import Length
from .on_strip import OnStrip
from .stacked import Section


class PunchOnStrip(OnStrip):
    """Sizes of punch and strip.

    Attributes
    ----------
    width, height : float
        Of the punch [m].
    """

    name = "punch-on-strip"
    bodies = ("punch", "strip")

    type: Literal["punch-on-strip"]
    width: Length
    height: Length

    @model_validator(mode="after")
    def _fits(self):
        self.check_strip()
        return self

    @property
    def upper(self) -> Section:
        return Section(-self.width / 2, self.width / 2, self.height)

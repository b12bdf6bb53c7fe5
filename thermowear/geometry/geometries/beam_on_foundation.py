"""Beam, clamped on the left and supported on the right, above a foundation moving along x.

The top of the foundation is y = 0, the lower face of the unloaded beam lies a gap above it.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from pydantic import model_validator

from ...case.tables.geometry import named
from ...case.tables.plane_geometry import PlaneGeometry
from ...case.values.section import KeyFault
from ...case.values.units import Distance, Length
from ..mesh.tagged import TaggedMesh
from ..meshing.cells import Sheet, between, both, grid, level, mesh_body, tagged_bodies
from ..meshing.divisions import joined


class BeamOnFoundation(PlaneGeometry):
    """Dimensions of beam and foundation; the width of the beam is its `thickness`.

    The contact of a beam that bends and wears is not known in advance: its elements have equal
    lengths, regardless of ``mesh.grading``.

    Attributes
    ----------
    length : float
        Length of the beam [m].
    height : float
        Height of the beam [m].
    load_position : float
        Distance of the middle of the loaded part of the top from the clamp [m].
    load_width : float
        Length of the loaded part of the top [m].
    gap : float
        Gap between the unloaded beam and the foundation [m].
    foundation_height : float
        Height of the foundation [m].
    """

    name = "beam-on-foundation"
    models = ("plane-strain", "plane-stress")
    bodies = ("beam", "foundation")
    surfaces = (
        *named("beam", "face", "clamp", "support", "load", "top"),
        *named("foundation", "face", "left", "right", "bottom"),
    )
    held = "beam_clamp"
    fixed = "foundation_bottom"
    rollers = ("beam_support",)

    type: Literal["beam-on-foundation"]
    length: Length
    height: Length
    load_position: Length
    load_width: Length
    gap: Distance
    foundation_height: Length

    @model_validator(mode="after")
    def _fits(self):
        start, end = self.load_span
        if not (start > 0 and end < self.length):
            raise KeyFault(
                "load_position",
                f"the load ranges from {start:g} m to {end:g} m; "
                f"must be between the ends of the beam, 0 and {self.length:g} m",
            )
        return self

    @property
    def load_span(self) -> tuple[float, float]:
        """X at the ends of the loaded part of the top [m]."""
        return self.load_position - self.load_width / 2, self.load_position + self.load_width / 2

    def build(self, mesh, zone=None) -> TaggedMesh:
        top, bodies = self.gap + self.height, {}
        # bottom, top, least and largest number of rows
        sections = ((self.gap, top, 2, 4), (-self.foundation_height, 0.0, 1, 3))
        for body, (low, high, least, most) in zip(self.bodies, sections, strict=True):
            columns = self._columns(mesh.face(body)[0])
            wanted = round((high - low) / np.diff(columns).max())
            ends = np.linspace(low, high, min(max(wanted, least), most) + 1)
            bodies[body] = mesh_body([Sheet(grid(columns, ends))], 1)
        claims = {
            "beam_face": level(1, self.gap),
            "beam_clamp": level(0, 0.0),
            "beam_support": level(0, self.length),
            "beam_load": both(level(1, top), between(*self.load_span)),
            "beam_top": level(1, top),
            "foundation_face": level(1, 0.0),
            "foundation_left": level(0, 0.0),
            "foundation_right": level(0, self.length),
            "foundation_bottom": level(1, -self.foundation_height),
        }
        return tagged_bodies(bodies, claims)

    def _columns(self, elements: int) -> np.ndarray:
        """X of the ends of nearly equal elements that match the ends of the load."""
        places = [0.0, *self.load_span, self.length]
        spans = np.diff(places)
        counts = np.ones(3, dtype=int)
        while counts.sum() < elements:
            counts[np.argmax(spans / counts)] += 1
        ends = zip(places[:-1], places[1:], counts + 1, strict=True)
        return joined(*(np.linspace(*span) for span in ends))

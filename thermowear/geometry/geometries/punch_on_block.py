"""Flat punch, sharp or with rounded edges, pressed on a block or sliding along it.

The contact lies at y = 0 and is centred at x = 0; the punch is above.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from pydantic import model_validator

from ...case.tables.geometry import Pressing
from ...case.values.section import KeyFault
from ...case.values.units import Length, Radius
from ..meshing.divisions import face_ends, growing_from_both, smoothed
from ..meshing.quads import ORDER, Sheet, grid, level, mesh_body
from ..meshing.rounded_punch import RoundedPunch, expected_end
from .on_block import PlaneOnBlock


class PunchOnBlock(PlaneOnBlock):
    """Dimensions of punch and block.

    Attributes
    ----------
    width, height : float
        Dimensions of the punch [m].
    edge_radius : float
        Radius of the rounding between the flat and the sides, 0 for sharp edges [m].
    """

    name = "punch-on-block"
    bodies = ("punch", "block")

    type: Literal["punch-on-block"]
    width: Length
    height: Length
    edge_radius: Radius = 0.0

    @model_validator(mode="after")
    def _fits(self):
        bounds = {"half the width": self.width / 2, "height": self.height}
        for name, bound in bounds.items():
            if not self.edge_radius < bound:
                raise KeyFault(
                    "edge_radius", f"{self.edge_radius:g} m must be less than {name} {bound:g} m"
                )
        if not self.width < 0.75 * self.block_width:
            raise KeyFault(
                "block_width",
                f"{self.block_width:g} m must be greater than 4/3 of width {self.width:g} m",
            )
        return self

    @property
    def flat(self) -> float:
        """X of the end of the flat [m]."""
        return self.width / 2 - self.edge_radius

    def contact_area(self) -> float:
        """Area of the flat face, without the rounding of the edges."""
        return 2 * self.flat * self.thickness

    def expected_zone(self, pressing: Pressing) -> tuple[float, float]:
        end = self.flat
        if self.edge_radius > 0:
            if pressing.force is not None:
                line_load = pressing.force / self.thickness
            else:
                assert pressing.approach is not None
                line_load = 0.5 * pressing.modulus * pressing.approach
            end = expected_end(self.flat, self.edge_radius, line_load / pressing.modulus)
        return -end, end

    def upper_limits(self):
        return {"edge_radius": self._rounded().largest} if self.edge_radius > 0 else {}

    def build(self, mesh, zone):
        # the contact of a sharp punch extends to its edges
        return super().build(mesh, zone if self.edge_radius > 0 else (-self.flat, self.flat))

    def block_span(self, ends):
        if self.edge_radius > 0:
            return super().block_span(ends)
        return (0.0 if self.half else -self.flat), self.flat

    def block_ends(self, mesh, zone):
        ends, first, ratio = super().block_ends(mesh, zone)
        grading = mesh.face("block")[1]
        if self.edge_radius > 0:
            return *self._resolved(ends, first, grading, zone), ratio
        if grading < 1:  # edge singularity: refine in all directions
            first, ratio = np.diff(ends).min(), min(3.0, 1 / grading)
        return ends, first, ratio

    def upper_body(self, mesh, zone):
        elements, grading = mesh.face(self.bodies[0])
        if self.edge_radius > 0:
            shape = self._rounded()
            limits = (-shape.end, shape.end)
            ends, largest = face_ends(zone, elements, grading, self.half, limits)
            sheets = shape.cells(*self._resolved(ends, largest, grading, zone))
            highest = shape.end_height
        else:
            sheets, highest = [self._rectangle(elements, grading)], 0.0
        size, on_top = self.width, level(1, self.height)

        def off_axis(p):
            return np.any(p[..., 0] != 0.0, axis=1)

        claims = {
            "face": lambda p: np.all(p[..., 1] <= highest + 1e-9 * size, axis=1) & off_axis(p),
            "side": lambda p: ~on_top(p) & off_axis(p),
            "top": on_top,
        }
        return mesh_body(sheets, ORDER), claims

    def _rounded(self) -> RoundedPunch:
        return RoundedPunch(self.flat, self.edge_radius, self.height, self.half)

    def _resolved(self, ends: np.ndarray, first: float, grading: float, zone):
        """Element ends, and the first row, that resolve the pressure peak at the rounding.

        The end of the flat is an element end. The width of the peak is the contact beyond the flat.
        """
        edges = (self.flat,) if self.half else (-self.flat, self.flat)
        for edge in edges:
            if ends[0] < edge < ends[-1]:
                ends = _with_end(ends, edge, (ends[0], ends[-1], *zone))
        beyond = min(abs(abs(z) - self.flat) for z in (zone[-1:] if self.half else zone))
        if beyond > 1e-6 * self.width:
            first = min(first, 5 * beyond)
        return smoothed(ends, max(2.0, 1 / grading)), first

    def _rectangle(self, elements: int, grading: float) -> Sheet:
        """Cells of a sharp punch: thin rows at the contact and at the holder."""
        zone = (-self.flat, self.flat)
        columns, _ = face_ends(zone, elements, grading, self.half, zone)
        contact = np.diff(columns).min()
        coarsest = max(self.width, self.height) * 3.0 / elements
        first = (contact, math.sqrt(contact * coarsest))
        rows = growing_from_both(0.0, self.height, first, grading, coarsest)
        return Sheet(grid(columns, rows))


def _with_end(ends: np.ndarray, place: float, kept: tuple[float, ...]) -> np.ndarray:
    """Element ends with `place` added, or with the nearest one moved there unless it is kept."""
    nearest = int(np.argmin(np.abs(ends - place)))
    apart = np.abs(np.array(kept) - ends[nearest]).min()
    if apart < 1e-12 and abs(ends[nearest] - place) < 1e-9 * np.ptp(ends):
        return ends
    others = np.delete(ends, nearest) if apart > 1e-12 else ends
    return np.sort(np.append(others, place))

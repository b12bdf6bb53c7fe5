"""Flat punch, sharp or with rounded edges, pressed on a block or sliding along it.

The contact lies at y = 0 and is centred at x = 0; the punch is above. In a punch with rounded edges
the face, the side and a core meet at a point above each rounding, so that cells follow the rounding
and stay well shaped.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from pydantic import model_validator

from ...case.values.pressing import Pressing
from ...case.values.section import KeyFault
from ...case.values.units import Length, Radius
from ..meshing.cells import ORDER, Sheet, grid, level, mesh_body, ruled
from ..meshing.divisions import depth_ends, face_ends, growing_from_both, smoothed
from .on_block import PlaneOnBlock

_END = math.pi / 4
"""Angle of the rounding up to which it belongs to the contact face."""


def expected_end(flat: float, radius: float, load: float) -> float:
    """Half-width of the contact with an elastic half-plane.

    Ciavarella, Hills and Monno (1998): ``2 P r / (b² E*) = (π - 2φ) / (2 sin² φ) - cot φ`` with
    the end of the flat at ``b = a sin φ``.

    Parameters
    ----------
    flat : float
        Half-width of the flat, b [m].
    radius : float
        Radius of the rounding, r [m].
    load : float
        Line load over the contact modulus, P / E* [m].
    """
    from scipy.optimize import brentq

    def excess(phi):
        return (math.pi - 2 * phi) / (2 * math.sin(phi) ** 2) - 1 / math.tan(phi) - target

    target = 2 * load * radius / flat**2
    lowest, highest = 1e-6, math.pi / 2 - 1e-9
    if excess(lowest) < 0:
        return flat / math.sin(lowest)
    return flat / math.sin(brentq(excess, lowest, highest)) if excess(highest) < 0 else flat


@dataclass(frozen=True)
class RoundedPunch:
    """Section of a punch; `flat` is the half-width of its flat face [m].

    Attributes
    ----------
    height : float
        Height of the punch [m].
    """

    flat: float
    radius: float
    height: float
    half: bool

    @property
    def end(self) -> float:
        """X of the end of the contact face [m]."""
        return self.flat + self.radius * math.sin(_END)

    @property
    def end_height(self) -> float:
        """Y of the end of the contact face [m]."""
        return self.radius * (1 - math.cos(_END))

    @property
    def largest(self) -> float:
        """Largest half-width of a contact zone [m]."""
        return self.flat + 0.6 * self.radius

    def cells(self, ends: np.ndarray, first: float) -> list[Sheet]:
        """Cells of the section.

        Parameters
        ----------
        ends : ndarray
            X at the element ends of the contact face; the outermost are moved to its ends [m].
        first : float
            Size of the first row above it [m], bounded by the radius of the rounding.
        """
        width = self.flat + self.radius
        shell = min(max(1.5 * self.radius, 0.4 * width), 0.7 * width, 0.7 * self.height)
        rows = depth_ends(min(first, self.radius), shell, 2.0) / shell
        along = self._along(ends)
        core = np.array([width - shell, shell])
        left = np.array([0.0, shell]) if self.half else core * [-1, 1]
        side = self._side_ends(min(first, self.radius))
        up = np.array([core, [core[0], self.height]])
        sheets = [
            ruled(self._contour, np.array([left, core]), along, rows),
            ruled(self._contour, up, side, rows),
            Sheet(
                grid(
                    np.linspace(left[0], core[0], len(along)),
                    np.linspace(shell, self.height, len(side)),
                )
            ),
        ]
        if not self.half:
            sheets.append(ruled(lambda s: self._contour(s) * [-1, 1], up * [-1, 1], side, rows))
        return sheets

    def _along(self, ends: np.ndarray) -> np.ndarray:
        """Arc lengths along the contour at x, the outermost moved to the ends of the face."""
        x = np.abs(ends)
        over = np.clip((x - self.flat) / self.radius, 0.0, math.sin(_END))
        along = np.minimum(x, self.flat) + self.radius * np.arcsin(over)
        along[[-1] if self.half else [0, -1]] = self.flat + self.radius * _END
        return np.sign(ends) * along

    def _side_ends(self, first: float) -> np.ndarray:
        """Arc lengths along the contour at the element ends beside the contact face."""
        start = self.flat + self.radius * _END
        corner = self.flat + self.radius * math.pi / 2
        up = self.height - self.radius
        return np.concatenate([[start], corner + depth_ends(min(first, up), up, 2.0)])

    def _contour(self, along: np.ndarray) -> np.ndarray:
        """Points of the contour: flat, rounding, side."""
        s = np.abs(along)
        angle = np.clip((s - self.flat) / self.radius, 0.0, math.pi / 2)
        x = np.minimum(s, self.flat) + self.radius * np.sin(angle)
        y = self.radius * 2 * np.sin(angle / 2) ** 2
        y = y + np.maximum(s - self.flat - self.radius * math.pi / 2, 0.0)
        return np.stack([np.sign(along) * x, y], axis=-1)


class PunchOnBlock(PlaneOnBlock):
    """Dimensions of punch and block.

    Attributes
    ----------
    height : float
        Dimensions of the punch [m].
    width : float
        Width of the punch along the block [m].
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

"""Strip pressed from both sides: between two cylinders (a fretting rig), or two flat punches.

The line of symmetry is y = 0, the contacts lie at x = 0 above and below it.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import ClassVar, Literal

import numpy as np
from pydantic import model_validator

from ...case.assembly.geometry import AssemblyGeometry
from ...case.tables.geometry import Geometry
from ...case.values.section import KeyFault
from ...case.values.units import Distance, Length
from ...errors import CaseError
from ..checks.assembly_checks import check_drawn
from ..mesh.tagged import TaggedMesh
from ..meshing.stacked_layers import mirrored
from .on_block import CylinderOnBlock
from .on_strip import PunchOnStrip

_ENDS = "strip_left", "strip_right"
_BELOW = {"upper": "lower", "top": "bottom"}
"""Words in the names of surfaces and of their mirror images."""


class StripBetween(AssemblyGeometry):
    """Base class: ``upper`` and ``lower`` body, and the ``strip`` between them.

    The contacts are ``upper`` and ``lower``. The surfaces of the strip are ``strip_upper`` and
    ``strip_lower`` in contact, ``strip_top`` and ``strip_bottom`` beside them, ``strip_left`` and
    ``strip_right``; those of the others their ``face`` and its opposite side, ``upper_top`` and
    ``lower_bottom``.

    Attributes
    ----------
    strip_height : float
        Height of the whole strip [m].
    half : bool
        Only the upper half, with ``strip_middle`` on the line of symmetry.
    thickness : float
        Thickness that forces refer to [m].
    """

    models = ("plane-strain", "plane-stress")
    renamed: ClassVar[dict[str, str]]
    """Names here of the surfaces of the pair that makes the upper half."""

    strip_height: Length
    half: bool = False
    thickness: Length = 1e-3

    @property
    def bodies(self) -> tuple[str, ...]:
        return ("upper", "strip") if self.half else ("upper", "strip", "lower")

    @property
    def surfaces(self) -> tuple[str, ...]:
        upper = (*dict.fromkeys(self.renamed.values()), *_ENDS)
        if self.half:
            return (*upper, "strip_middle")
        return *upper, *(_image(name) for name in upper if _image(name) != name)

    @property
    def contacts(self) -> dict[str, tuple[str, str]]:
        sides = ("upper",) if self.half else ("upper", "lower")
        return {side: (f"{side}_face", f"strip_{side}") for side in sides}

    @property
    def thickness_factor(self) -> float | None:  # type: ignore[override]
        return self.thickness

    def press_direction(self, surface: str) -> tuple[float, ...]:
        return (0.0, 1.0) if surface.startswith("lower_") else (0.0, -1.0)

    def check(self, mesh, case):
        check_drawn(mesh, case)

    def build(self, mesh):
        if "lower" in mesh.bodies:
            raise CaseError("mesh.bodies.lower: not supported; its mesh is that of upper, mirrored")
        pair = self._pair(_AsPair(mesh, dict(zip(self._half.bodies, self.bodies, strict=False))))
        upper = self._named(pair)
        if self.half:
            return upper
        images = {name: _image(name) for name in upper.surfaces if name != "strip_middle"}
        whole = mirrored(upper, "strip_middle", {"upper": "lower"}, images)
        return _in_order(whole, self.surfaces)

    @property
    @abstractmethod
    def _half(self) -> Geometry:
        """Geometry of the upper half, as a pair with its contact at y = 0."""

    @abstractmethod
    def _pair(self, mesh) -> TaggedMesh:
        """Mesh of the upper half."""

    def _named(self, pair: TaggedMesh) -> TaggedMesh:
        """Upper half with the names and at the place that it has here."""
        points = pair.points + np.array([0.0, self.strip_height / 2])
        names = list(self.surfaces if self.half else (*self.surfaces, "strip_middle"))
        right = points[pair.facets][..., 0].mean(axis=1) > 0.0
        tags = np.empty_like(pair.facet_tags)
        for old, name in enumerate(pair.surfaces, start=1):
            new = self.renamed.get(name, "strip_middle" if name.endswith("_bottom") else "")
            own = pair.facet_tags == old
            for end, there in zip(_ENDS, (~right, right), strict=True):
                tags[own & there] = names.index(new or end) + 1
        upper = replace(pair, points=points, facet_tags=tags, bodies=("upper", "strip"))
        return _in_order(
            replace(upper, surfaces=tuple(names)), tuple(n for n in names if _upper(n))
        )


class StripBetweenCylinders(StripBetween):
    """Dimensions of two equal cylinders and of the strip between them.

    Attributes
    ----------
    radius : float
        Radius of the cylinders [m].
    strip_width : float
        Width of the strip, |x| <= strip_width / 2 [m].
    zone : float
        Half-width of the fine mesh of each contact [m].
    """

    name = "strip-between-cylinders"
    renamed = {
        "cylinder_face": "upper_face",
        "cylinder_side": "upper_side",
        "cylinder_top": "upper_top",
        "block_face": "strip_upper",
        "block_top": "strip_top",
    }

    type: Literal["strip-between-cylinders"]
    radius: Length
    strip_width: Length
    zone: Length

    @model_validator(mode="after")
    def _fits(self):
        limit = min(self.radius / 2, 0.375 * self.strip_width)
        if not self.zone <= limit:
            text = f"{self.zone:g} m is too large for this radius and strip_width; at most"
            raise KeyFault("zone", f"{text} {limit:.3g} m")
        return self

    @property
    def _half(self) -> CylinderOnBlock:
        return CylinderOnBlock(
            type="cylinder-on-block",
            radius=f"{self.radius!r} m",
            block_width=f"{self.strip_width!r} m",
            block_height=f"{self.strip_height / 2!r} m",
        )

    def _pair(self, mesh):
        return self._half.build(mesh, (-self.zone, self.zone))


class StripBetweenPunches(StripBetween):
    """Dimensions of two equal flat punches with sharp edges, and of the strip between them.

    Attributes
    ----------
    width : float
        Width of a punch along the strip [m].
    height : float
        Height of a punch [m].
    strip_length : float
        Length of the strip [m].
    stroke : float
        Amplitude of a reciprocating strip: it is meshed for contact over the whole stroke [m].
    """

    name = "strip-between-punches"
    renamed = {
        "punch_face": "upper_face",
        "punch_top": "upper_top",
        "punch_left": "upper_left",
        "punch_right": "upper_right",
        "strip_face": "strip_upper",
        "strip_top": "strip_top",
    }

    type: Literal["strip-between-punches"]
    width: Length
    height: Length
    strip_length: Length
    stroke: Distance = 0.0

    @model_validator(mode="after")
    def _fits(self):
        if not self.width + 2 * self.stroke < self.strip_length:
            text = f"{self.strip_length:g} m must be greater than the way of a punch on the strip"
            raise KeyFault("strip_length", f"{text}, {self.width + 2 * self.stroke:g} m")
        return self

    @property
    def _half(self) -> PunchOnStrip:
        return PunchOnStrip(
            type="punch-on-strip",
            width=f"{self.width!r} m",
            height=f"{self.height!r} m",
            strip_length=f"{self.strip_length!r} m",
            strip_height=f"{self.strip_height / 2!r} m",
            stroke=f"{self.stroke!r} m",
        )

    def _pair(self, mesh):
        return self._half.build(mesh)


@dataclass(frozen=True)
class _AsPair:
    """Mesh settings of a pair from those of the bodies here.

    Attributes
    ----------
    settings : MeshTable
    names : dict of str to str
        Bodies here by those of the pair.
    """

    settings: object
    names: dict[str, str]

    def face(self, body: str) -> tuple[int, float]:
        """See `MeshTable.face`."""
        return self.settings.face(self.names[body])  # type: ignore[attr-defined]

    def row(self, height: float) -> float:
        """See `MeshTable.row`."""
        return self.settings.row(height)  # type: ignore[attr-defined]


def _image(name: str) -> str:
    """Name of the mirror image of a surface."""
    return "_".join(_BELOW.get(word, word) for word in name.split("_"))


def _upper(name: str) -> bool:
    """True for a surface of the upper half."""
    return _image(name) != name or name in (*_ENDS, "strip_middle")


def _in_order(mesh: TaggedMesh, names: tuple[str, ...]) -> TaggedMesh:
    """Mesh with its surfaces in an order, which has all that have facets."""
    numbers = [names.index(name) + 1 if name in names else 0 for name in mesh.surfaces]
    tags = np.array(numbers, dtype=np.int32)[mesh.facet_tags - 1]
    return replace(mesh, facet_tags=tags, surfaces=names)

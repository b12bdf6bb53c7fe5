"""Keys that name solids and faces of CAD files, and what they ask of these files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, model_serializer, model_validator

from ....case.values.json_schema import A_NAME, LIST_OF_NAMES, AnyOf, OrAlso
from ....case.values.pressing import Pressing
from ....case.values.section import KeyFault, Number, Section
from ....case.values.units import Coordinate
from ...from_cad.meshing_process import curved_places
from ...from_cad.request import BodyRequest, CadRequest, FaceChoice
from ...from_cad.touching import expected_zones

Place = tuple[Coordinate, Coordinate, Coordinate]
_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
_BREP = ".brep"


class CadFaceTable(Section):
    """Faces of CAD bodies, chosen in one of three ways.

    Attributes
    ----------
    label : str or None
        Label of the faces in a STEP file.
    point : tuple of float or None
        Point on one face [m].
    plane : str, tuple of float or None
        Axis or vector normal to the plane that faces lie in.
    at : float or None
        Distance of this plane from the origin, along its normal [m].
    body : str or None
        Body of the faces, where several come into question.
    """

    label: str | None = None
    point: Place | None = None
    plane: Literal["x", "y", "z"] | tuple[Number, Number, Number] | None = None
    at: Coordinate | None = None
    body: str | None = None

    @model_validator(mode="after")
    def _one_way(self):
        ways = [key for key in ("label", "point", "plane") if getattr(self, key) is not None]
        if len(ways) != 1:
            raise ValueError(
                f"found {' and '.join(ways) or 'none'}; needs one of: label, point, plane"
            )
        if self.plane is None and self.at is not None:
            raise KeyFault("at", "requires a plane")
        if self.plane is not None and self.at is None:
            raise KeyFault("at", 'missing; a plane needs its distance from the origin: at = "5 mm"')
        if isinstance(self.plane, tuple) and not np.linalg.norm(self.plane) > 0.0:
            raise KeyFault("plane", "the normal has no direction")
        return self

    @model_serializer(mode="wrap")
    def _given(self, handler) -> dict[str, Any]:
        return {key: value for key, value in handler(self).items() if value is not None}

    def choice(self) -> FaceChoice:
        plane = None
        if self.plane is not None:
            normal = np.array(_AXES[self.plane] if isinstance(self.plane, str) else self.plane)
            x, y, z = (float(n) for n in normal / np.linalg.norm(normal))
            plane = (x, y, z), float(self.at or 0.0)
        return FaceChoice(self.label, self.point, plane, self.body)


class SolidPoint(Section):
    """Point inside a solid.

    Attributes
    ----------
    point : tuple of float
        Its coordinates [m].
    """

    point: Place


def _several(value: Any) -> Any:
    """Choices as a list of tables, from one or several labels or tables."""
    every = value if isinstance(value, list | tuple) else [value]
    if not every:
        raise ValueError("found an empty list; needs a label, a point or a plane")
    return tuple({"label": one} if isinstance(one, str) else one for one in every)


CadFaces = Annotated[
    tuple[CadFaceTable, ...], BeforeValidator(_several), AnyOf(A_NAME, CadFaceTable, several=True)
]
"""Faces by one or several choices."""


def _solids(value: Any) -> Any:
    every = value if isinstance(value, list | tuple) else [value]
    if not every:
        raise ValueError("found an empty list; needs a label or a point inside")
    return tuple(every)


CadSolids = Annotated[
    tuple[str | SolidPoint, ...], BeforeValidator(_solids), AnyOf(A_NAME, SolidPoint, several=True)
]
"""Solids by one or several labels, or points inside."""


def _surfaces(value: Any) -> Any:
    """Surfaces by their names, from a list of labels that are the names."""
    if isinstance(value, list | tuple) and all(isinstance(name, str) for name in value):
        if len(set(value)) < len(value):
            raise ValueError(f"found {value!r}; names a surface twice")
        return {name: name for name in value}
    return value


CadSurfaces = Annotated[dict[str, CadFaces], BeforeValidator(_surfaces), OrAlso(LIST_OF_NAMES)]
"""Surfaces of a body by their names, or a list of labels."""


def check_files(geometry: Any) -> None:
    """Check the keys of the files: STEP files have a unit of length, BREP files need one.

    Parameters
    ----------
    geometry : CadFile or CadAssembly

    Raises
    ------
    KeyFault
    """
    for body in geometry.body_names:
        if body not in geometry.bodies:
            known = ", ".join(geometry.bodies)
            raise KeyFault(f"bodies.{body}", f"unknown body; must be one of: {known}")
    files = list(geometry.paths.values()) if geometry.path is None else [geometry.path]
    bare = [Path(file).suffix.lower() == _BREP for file in files]
    if any(bare) and geometry.length_unit is None:
        raise KeyFault("length_unit", 'missing; a BREP file has no unit: such as "1 mm"')
    if not any(bare) and geometry.length_unit is not None:
        raise KeyFault("length_unit", "leave it out; STEP files have a unit of their own")


def body_requests(geometry: Any, mesh: Any) -> tuple[BodyRequest, ...]:
    """Bodies of a geometry with `body_names`, `path`, `paths` and `length_unit`.

    Parameters
    ----------
    geometry : CadFile or CadAssembly
    mesh : MeshTable or None
        None: sizes follow from those of the bodies.
    """
    result = []
    for body in geometry.bodies:
        own = geometry.path is None
        path = geometry.paths[body] if own else geometry.path
        solids = tuple(
            solid if isinstance(solid, str) else solid.point
            for solid in geometry.body_names.get(body, ())
        )
        size, contact = (None, None) if mesh is None else mesh.sizes(body)
        result.append(
            BodyRequest(
                name=body,
                path=path,
                key=f"geometry.paths.{body}" if own else "geometry.path",
                solids=solids,
                solids_key=f"geometry.bodies.{body}",
                unit=geometry.length_unit,
                size=size,
                contact_size=contact,
                grading=1.0 if mesh is None else mesh.face(body)[1],
            )
        )
    return tuple(result)


def with_zones(geometry: Any, request: CadRequest, pressing: Sequence[Pressing | None]) -> Any:
    """Geometry with the small zones that loads of its contacts close, see `expected_zones`."""
    result = geometry.model_copy()
    result._zones = expected_zones(request, curved_places(request), pressing)
    return result

"""Two bodies from CAD files, meshed with quadratic tetrahedra."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, Self

from pydantic import Field, PrivateAttr, ValidationInfo, model_validator

from ....case.tables.geometry import keyed
from ....case.tables.mesh import MeshTable
from ....case.values.pressing import Pressing
from ....case.values.section import KeyFault
from ....case.values.units import Length
from ...from_cad.meshing_process import meshed_contents
from ...from_cad.request import CadRequest, FaceChoice, SurfaceRequest, TouchRequest, Zone
from ...reading.assembly import bodies_in
from ..mesh_file import MeshFile
from .cad_keys import CadFaces, CadSolids, body_requests, check_files, with_zones


class CadFile(MeshFile):
    """CAD files, and how solids, faces and surfaces of them are named.

    Surfaces that are not listed under ``surfaces`` are named by labels in the file.

    Attributes
    ----------
    path : str or None
        ``.step``, ``.stp`` or ``.brep`` with both bodies.
    paths : dict of str to str
        Files by body, instead of ``path``; the held body first.
    length_unit : float or None
        Length of one unit of a BREP file [m].
    body_names : dict of str to tuple
        Key ``bodies``: labels of solids, or points inside them; not needed if each body has a file
        of its own.
    contact_names : tuple of str or "auto"
        Key ``contact``: contact faces of both bodies; ``"auto"``: all faces where they touch, named
        ``body_face``.
    contact_tolerance : float or None
        Largest distance of faces that touch [m]; None: a small part of the smaller body.
    surface_names : dict of str to tuple of CadFaceTable
        Key ``surfaces``: faces of each surface.
    """

    name = "cad"
    models = ("3d",)
    sized = True
    unmeshed = (*MeshFile.unmeshed, "contact_tolerance")
    along_paths = False

    type: Literal["cad"]  # type: ignore[assignment]
    length_unit: Length | None = None
    body_names: dict[str, CadSolids] = Field(  # type: ignore[assignment]
        alias="bodies", default={}
    )
    contact_names: Literal["auto"] | tuple[str, str] = Field(  # type: ignore[assignment]
        alias="contact", default="auto"
    )
    contact_tolerance: Length | None = None
    surface_names: dict[str, CadFaces] = Field(  # type: ignore[assignment]
        alias="surfaces", default={}
    )

    _zones: tuple[Zone, ...] = PrivateAttr(default=())

    @model_validator(mode="after")
    def _from_cad(self, info: ValidationInfo):
        check_files(self)
        if self.contact_names == "auto":
            for name in set(self.contact) & set(self.surface_names):
                raise KeyFault(f"surfaces.{name}", 'is found by contact = "auto"')
        elif self.contact_tolerance is not None:
            raise KeyFault("contact_tolerance", 'requires contact = "auto"')
        return self

    @keyed
    def bodies(self) -> tuple[str, ...]:
        return tuple(self.paths or self.body_names)

    @keyed
    def contact(self) -> tuple[str, str]:
        if self.contact_names == "auto":
            first, second = self.bodies
            return f"{first}_face", f"{second}_face"
        return self.contact_names

    def sets_of(self, body: str) -> tuple[str, ...]:
        return (body,)

    def _in_file(self, name: str) -> str:
        return name

    def pressed(self, pressing: Sequence[Pressing | None]) -> Self:
        """Geometry with the zone that a load of the contact closes."""
        return with_zones(self, self._request(None), pressing)

    def build(self, mesh, zone):
        contents = meshed_contents(self._request(mesh))
        cells = {body: (body,) for body in self.bodies}
        return bodies_in(contents, cells, list(self._purposes().values()), self._with_material)

    def _request(self, mesh: MeshTable | None) -> CadRequest:
        auto = self.contact_names == "auto"
        return CadRequest(
            bodies=body_requests(self, mesh),
            surfaces=tuple(
                SurfaceRequest(
                    name, of.key, self._choices(name), self._body(of.body), self._reason(name)
                )
                for name, of in self._purposes().items()
                if not (auto and name in self.contact)
            ),
            touching=(
                (TouchRequest(self.bodies, self.contact, "geometry.contact"),) if auto else ()
            ),
            faces=(self.contact,),
            tolerance=self.contact_tolerance,
            zones=self._zones,
        )

    def _choices(self, name: str) -> tuple[FaceChoice, ...]:
        """Faces of a surface; by its name as a label unless it is listed."""
        tables = self.surface_names.get(name)
        return (FaceChoice(name),) if tables is None else tuple(t.choice() for t in tables)

    def _reason(self, name: str) -> str:
        """Key that assigns a surface to one of the bodies, for messages."""
        roles = {self.held: ("held", 0), self.fixed: ("fixed", 1)}
        roles |= {face: ("contact", index) for index, face in enumerate(self.contact)}
        if name not in roles:
            return ""
        key, index = roles[name]
        which = ("first", "second")[index]
        return f"geometry.{key} needs a surface of the {which} body, {self.bodies[index]!r}"

    def _body(self, index: int | None) -> str | None:
        return None if index is None else self.bodies[index]

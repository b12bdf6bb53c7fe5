"""Any number of bodies from CAD files, meshed with quadratic tetrahedra."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import Literal, Self

from pydantic import Field, PrivateAttr, model_validator

from ....case.tables.mesh import MeshTable
from ....case.values.pressing import Pressing
from ....case.values.section import KeyFault
from ....case.values.units import Length
from ...from_cad.meshing_process import meshed_contents, touching_bodies
from ...from_cad.request import CadRequest, SurfaceRequest, TouchRequest, Zone
from ...reading.assembly import bodies_in
from ...reading.contents import Named
from ..assembly_file import AssemblyFile
from .cad_keys import CadSolids, CadSurfaces, body_requests, check_files, with_zones


class CadAssembly(AssemblyFile):
    """CAD files of several bodies, and how solids, faces and surfaces of them are named.

    Attributes
    ----------
    path : str or None
        ``.step``, ``.stp`` or ``.brep`` with all bodies.
    paths : dict of str to str
        Files by body, instead of ``path``.
    length_unit : float or None
        Length of one unit of a BREP file [m].
    body_names : dict of str to tuple
        Key ``bodies``: labels of solids, or points inside them; not needed if each body has a file
        of its own.
    contact : dict of str to tuple of str, or "auto"
        Pairs of bodies whose faces touch, by the name of the contact; the faces are named
        ``body_contact``. ``"auto"``: all bodies that touch; contact and face of ``body`` on
        ``other`` are named ``body-other``.
    contact_tolerance : float or None
        Largest distance of faces that touch [m]; None: a small part of the smaller body.
    surface_names : dict of str to dict of str to tuple of CadFaceTable
        Key ``surfaces``: surfaces of each body, and their faces; a list names them by labels.
    """

    name = "cad"
    models = ("3d",)
    sized = True

    type: Literal["cad"]  # type: ignore[assignment]
    length_unit: Length | None = None
    body_names: dict[str, CadSolids] = Field(  # type: ignore[assignment]
        alias="bodies", default={}
    )
    contact: Literal["auto"] | dict[str, tuple[str, str]] = {}
    contact_tolerance: Length | None = None
    surface_names: dict[str, CadSurfaces] = Field(  # type: ignore[assignment]
        alias="surfaces", default={}
    )
    _sliding: tuple[tuple[str, str], ...] = PrivateAttr(default=())
    _zones: tuple[Zone, ...] = PrivateAttr(default=())

    @model_validator(mode="after")
    def _from_cad(self):
        check_files(self)
        if not self.contact and self.contact_tolerance is not None:
            raise KeyFault("contact_tolerance", "requires contact")
        if self.contact == "auto":
            return self
        seen: dict[frozenset[str], str] = {}
        for name, pair in self.contact.items():
            for body in pair:
                if body not in self.bodies:
                    known = ", ".join(self.bodies)
                    raise KeyFault(f"contact.{name}", f"found {body!r}; must be two of: {known}")
            if frozenset(pair) in seen or pair[0] == pair[1]:
                raise KeyFault(f"contact.{name}", "must be two bodies that no other contact has")
            seen[frozenset(pair)] = name
        for body, names in self._surfaces_of().items():
            if len(set(names)) < len(tuple(names)):
                raise KeyFault(
                    f"surfaces.{body}", "has the name of a face that is found by contact"
                )
        return self

    @property
    def bodies(self) -> tuple[str, ...]:
        return tuple(self.paths or self.body_names)

    @property
    def contacts(self) -> dict[str, tuple[str, str]]:
        return {name: touch.names for name, touch in self.touches.items()}

    @cached_property
    def touches(self) -> dict[str, TouchRequest]:
        """Pairs of bodies that touch, by the name of the contact; reads the files for "auto"."""
        key = "geometry.contact"
        if self.contact == "auto":
            request = CadRequest(body_requests(self, None), (), tolerance=self.contact_tolerance)
            return {
                f"{a}-{b}": TouchRequest((a, b), (f"{a}-{b}", f"{b}-{a}"), key)
                for a, b in touching_bodies(request)
            }
        return {
            name: TouchRequest((a, b), (f"{a}_{name}", f"{b}_{name}"), f"{key}.{name}")
            for name, (a, b) in self.contact.items()
        }

    def _surfaces_of(self) -> Mapping[str, Iterable[str]]:
        found = {body: list(self.surface_names.get(body, ())) for body in self.bodies}
        for touch in self.touches.values():
            for body, name in zip(touch.bodies, touch.names, strict=True):
                found[body].append(name)
        return found

    def sets_of(self, body: str) -> tuple[str, ...]:
        return (body,)

    def with_sliding(self, faces: tuple[tuple[str, str], ...]) -> CadAssembly:
        result = self.model_copy()
        result._sliding = faces
        return result

    def pressed(self, pressing: Sequence[Pressing | None]) -> Self:
        """Geometry with the zones that loads of the contacts close."""
        return with_zones(self, self._request(None), pressing)

    def build(self, mesh):
        named = [
            Named(name, (name,), f"geometry.surfaces.{body}", self.bodies.index(body))
            for body, names in self._surfaces_of().items()
            for name in names
        ]
        contents = meshed_contents(self._request(mesh))
        cells = {body: (body,) for body in self.bodies}
        return bodies_in(contents, cells, named, self._with_material)

    def _request(self, mesh: MeshTable | None) -> CadRequest:
        surfaces = tuple(
            SurfaceRequest(
                name, f"geometry.surfaces.{body}.{name}", tuple(t.choice() for t in tables), body
            )
            for body, names in self.surface_names.items()
            for name, tables in names.items()
        )
        return CadRequest(
            bodies=body_requests(self, mesh),
            surfaces=surfaces,
            touching=tuple(self.touches.values()),
            faces=self._sliding,
            tolerance=self.contact_tolerance,
            zones=self._zones,
        )

"""Bodies meshed in another program and read from a file."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from operator import attrgetter
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self

from pydantic import (
    BeforeValidator,
    Field,
    PrivateAttr,
    ValidationInfo,
    model_serializer,
    model_validator,
)

from ...case.tables.geometry import keyed
from ...case.tables.plane_geometry import HalvableGeometry
from ...case.values.section import MODEL, KeyFault, UserFile
from ...case.values.units import Area, Coordinate, Length
from ..checks.mesh_checks import check_mesh
from ..checks.pair_checks import check_pair
from ..checks.solid_pairs import projected_area
from ..checks.solid_surfaces import check_solid_mesh
from ..mesh.mixed import AnyMesh
from ..reading.assembly import has_surface, read_bodies
from ..reading.contents import Named

_KEYS = {
    "body_names": "bodies",
    "contact_names": "contact",
    "held_name": "held",
    "fixed_name": "fixed",
    "symmetry_names": "symmetry",
    "roller_names": "rollers",
    "mid_plane_names": "mid_plane",
    "rotates_about": "rotation_center",
    "track_length": "track",
    "contact_area_given": "contact_area",
    "surface_names": "surfaces",
}
"""Attributes whose keys are named like properties of every geometry."""
_IN_SPACE = ("rollers", "mid_plane", "rotation_center")
"""Keys of bodies in space."""


def _cell_sets(value: Any) -> Any:
    names = [value] if isinstance(value, str) else value
    if isinstance(names, list | tuple) and names and all(isinstance(name, str) for name in names):
        return value if isinstance(value, str) else tuple(names)
    raise ValueError(f"found {value!r}; must be text in quotation marks, or a list of such names")


CellSets = Annotated[str | tuple[str, ...], BeforeValidator(_cell_sets)]
CurvedSurfaces = bool | tuple[str, ...]


def curved_surfaces(curved: CurvedSurfaces, surfaces: tuple[str, ...]) -> tuple[str, ...]:
    """Names of surfaces that are smooth, of those of a geometry.

    Raises
    ------
    KeyFault
        If one is unknown.
    """
    for name in () if isinstance(curved, bool) else curved:
        if name not in surfaces:
            known = ", ".join(surfaces)
            raise KeyFault("curved", f"unknown surface {name!r}; must be one of: {known}")
    return (surfaces if curved else ()) if isinstance(curved, bool) else curved


class FromFiles:
    """Common part of geometries of one file, or of a file for each body."""

    if TYPE_CHECKING:
        path: str | None
        paths: dict[str, str]
        length_unit: float
        body_names: dict[str, CellSets]
        curved: CurvedSurfaces
        _with_material: dict[str, dict[str, str]]
        _in_space: bool

        @property
        def surfaces(self) -> tuple[str, ...]: ...

    @keyed
    def bodies(self) -> tuple[str, ...]:
        return tuple(self.body_names)

    @keyed
    def mesh_files(self) -> str | None:
        return self.path or " and ".join(self.paths.values())

    @keyed
    def set_of(self) -> dict[str, str]:
        return {
            f"{body}.{name}": name for body, names in self._with_material.items() for name in names
        }

    @keyed
    def zones(self) -> dict[str, str]:
        return {
            f"{body}.{name}": body for body, sets in self._with_material.items() for name in sets
        }

    def sets_of(self, body: str) -> tuple[str, ...]:
        names = self.body_names[body]
        return (names,) if isinstance(names, str) else names

    def with_cell_sets(self, sets: dict[str, dict[str, str]]) -> Self:
        result = copy(self)
        result._with_material = {body: sets[body] for body in self.bodies if body in sets}
        return result

    def _check_files(self) -> None:
        if self.paths and self.path is not None:
            raise KeyFault("paths", "only one of path and paths can be given")
        if self.paths and set(self.paths) != set(self.bodies):
            raise KeyFault("paths", f"needs a file for each of: {', '.join(self.bodies)}")
        if not self.paths and self.path is None:
            raise KeyFault("path", "missing")

    def _read(self, surfaces: Sequence[Named]) -> AnyMesh:
        return read_bodies(
            self.path,
            self.paths,
            3 if self._in_space else 2,
            self.length_unit,
            {body: self.sets_of(body) for body in self.bodies},
            surfaces,
            self._with_material,
            curved_surfaces(self.curved, self.surfaces),
        )

    def _has_surface(self, name: str) -> bool:
        return has_surface(name, self.path, self.paths, 3 if self._in_space else 2)


class MeshFile(FromFiles, HalvableGeometry):
    """Path of a mesh file, and the names of bodies and surfaces in it.

    The file names bodies and surfaces by physical groups (gmsh), sets (Abaqus), families (MED) or
    the numbers of integer cell data (VTK, XDMF). A surface not listed under ``surfaces`` has its
    name in the file.

    Attributes
    ----------
    path : str or None
        ``.msh``, ``.inp``, ``.vtu``, ``.xdmf`` or ``.med``.
    paths : dict of str to str
        Files by body, instead of ``path``, if each body has a file of its own. A surface may be in
        any of them; of one name in both it is united.
    length_unit : float
        Length of one unit of the file [m].
    body_names : dict of str to str or tuple of str
        Key ``bodies``: cell sets in the file that make up body 1 (held and loaded) and body 2, by
        the names of the bodies in the case; several sets are united.
    contact_names : tuple of str
        Key ``contact``: contact faces of body 1 and body 2.
    held_name : str
        Key ``held``: surface of body 1 on the holder.
    fixed_name : str
        Key ``fixed``: fixed surface of body 2.
    symmetry_names : tuple of str
        Key ``symmetry``: surfaces on planes of symmetry x = const.
    roller_names : tuple of str
        Key ``rollers``: surfaces on planes of symmetry y = const, in space.
    mid_plane_names : tuple of str
        Key ``mid_plane``: surfaces of body 2, or the held one, on planes z = const in space.
    rotates_about : tuple of float or None
        Key ``rotation_center``: x and y of the axis along z that body 2 rotates about in space; by
        default the bodies slide along x [m].
    track_length : float or None
        Key ``track``: length of the track on body 2 that passes under body 1, as of a strip, in a
        plane model; by default body 2 stays under it [m].
    surface_names : dict of str to str
        Key ``surfaces``: names in the file of further surfaces, or of those above, by their names
        in the case.
    contact_area_given : float or None
        Key ``contact_area``: area for a mean pressure, in space by default the lesser one of both
        faces, projected along the load [m²].
    curved : bool or tuple of str
        Surfaces of cells of order 1 that are smooth: nodes between corners, whose cells then have
        order 2, are put on planes, cylinders, cones and spheres (circles in a section) through the
        corners, or on smooth surfaces. True: all named surfaces. Adjacent facets at more than 40°
        meet in an edge.
    """

    name = "file"
    models: ClassVar[tuple[str, ...]] = ("axisymmetric", "plane-strain", "plane-stress", "3d")
    from_file = True

    type: Literal["file"]
    path: UserFile | None = None
    paths: dict[str, UserFile] = {}
    length_unit: Length = 1.0
    body_names: dict[str, CellSets] = Field(alias="bodies")
    contact_names: tuple[str, str] = Field(alias="contact")
    held_name: str = Field(alias="held")
    fixed_name: str = Field(alias="fixed")
    symmetry_names: tuple[str, ...] = Field(alias="symmetry", default=())
    roller_names: tuple[str, ...] = Field(alias="rollers", default=())
    mid_plane_names: tuple[str, ...] = Field(alias="mid_plane", default=())
    rotates_about: tuple[Coordinate, Coordinate] | None = Field(
        alias="rotation_center", default=None
    )
    track_length: Length | None = Field(alias="track", default=None)
    surface_names: dict[str, str] = Field(alias="surfaces", default={})
    contact_area_given: Area | None = Field(alias="contact_area", default=None)
    curved: CurvedSurfaces = False
    _with_material: dict[str, dict[str, str]] = PrivateAttr(default={})
    _in_space: bool = PrivateAttr(default=False)
    _measured: float | None = PrivateAttr(default=None)

    @model_validator(mode="after")
    def _complete(self, info: ValidationInfo):
        model = (info.context or {}).get(MODEL) or ""
        self._in_space = model == "3d"
        if len(self.bodies) != 2:
            raise KeyFault(
                "bodies", f"needs two bodies, the held one first; found {len(self.bodies)}"
            )
        self._check_files()
        if self.track is not None and not (model.startswith("plane") and not self.half):
            raise KeyFault("track", "requires a plane model, not half of it")
        if self._in_space:
            self._check_space()
        else:
            self._check_plane()
        roles = {"contact": self.contact, "held": (self.held,), "fixed": (self.fixed,)}
        seen: set[str] = set()
        for key, names in roles.items():
            for name in names:
                if name in seen:
                    raise KeyFault(key, f"{name!r} is used twice; a surface can have one role only")
                seen.add(name)
        curved_surfaces(self.curved, self.surfaces)
        return self

    def _check_plane(self) -> None:
        if self.half and not self.symmetry:
            raise KeyFault("half", "needs the surfaces on the plane of symmetry: symmetry = [...]")
        if self.symmetry and not self.half:
            raise KeyFault("symmetry", "requires a half model; add half = true")
        for key in _IN_SPACE:
            if getattr(self, key):
                raise KeyFault(key, "requires a 3d model")

    def _check_space(self) -> None:
        if self.half:
            raise KeyFault(
                "half",
                "requires a plane model; in space list the surfaces on planes of symmetry: "
                "symmetry = [...] (x = const), rollers = [...] (y = const), "
                "mid_plane = [...] (z = const)",
            )
        if "thickness" in self.model_fields_set:
            raise KeyFault("thickness", "requires a plane model")

    @model_serializer(mode="wrap")
    def _by_keys(self, handler) -> dict[str, Any]:
        left_out = {"half", "thickness", "track"} if self._in_space else set(_IN_SPACE)
        left_out |= (set() if self.paths else {"paths"}) | (set() if self.curved else {"curved"})
        found = {_KEYS.get(name, name): value for name, value in handler(self).items()}
        return {name: value for name, value in found.items() if name not in left_out}

    contact: ClassVar[Any] = keyed(attrgetter("contact_names"))
    held: ClassVar[Any] = keyed(attrgetter("held_name"))
    fixed: ClassVar[Any] = keyed(attrgetter("fixed_name"))
    symmetry: ClassVar[Any] = keyed(attrgetter("symmetry_names"))

    rollers: ClassVar[Any] = keyed(attrgetter("roller_names"))
    mid_plane: ClassVar[Any] = keyed(attrgetter("mid_plane_names"))
    rotation_center: ClassVar[Any] = keyed(attrgetter("rotates_about"))
    track: ClassVar[Any] = keyed(attrgetter("track_length"))

    @keyed
    def press_direction(self) -> tuple[float, ...]:
        return (0.0, 0.0, -1.0) if self._in_space else (0.0, -1.0)

    @keyed
    def thickness_factor(self) -> float | None:
        return None if self._in_space else super().thickness_factor

    def rollers_of(self, body: str) -> tuple[str, ...]:
        """All surfaces on rollers, which may belong to both bodies, for the first one."""
        return self.rollers if body == self.bodies[0] else ()

    @keyed
    def surfaces(self) -> tuple[str, ...]:
        return tuple(self._purposes())

    def contact_area(self) -> float | None:
        if self._in_space and self.contact_area_given is None and self._measured is None:
            mesh = self.build(None, None)
            self._measured = min(projected_area(mesh, face) for face in self.contact)
        return self.contact_area_given or self._measured

    @property
    def facing(self) -> tuple[str | None, str | None]:
        first, second = (None if name in self._with_material else name for name in self.bodies)
        return first, second

    def build(self, mesh, zone):
        return self._read(list(self._purposes().values()))

    def not_listed(self, surface: str) -> bool:
        if self.sized or surface in self.surface_names.values():
            return False
        return self._has_surface(surface)

    def check(self, mesh, case):
        if self._in_space:
            check_solid_mesh(mesh, self)
        else:
            check_mesh(mesh, self, case.model)
        check_pair(mesh, case)

    def _purposes(self) -> dict[str, Named]:
        """All surfaces by their names in the case."""
        (upper, lower) = self.contact
        uses: list[tuple[str, str, int | None]] = [("contact", upper, 0), ("contact", lower, 1)]
        uses += [("held", self.held_name, 0), ("fixed", self.fixed_name, 1)]
        uses += [("symmetry", name, None) for name in self.symmetry_names]
        uses += [("rollers", name, None) for name in self.roller_names]
        uses += [("mid_plane", name, int(name != self.held_name)) for name in self.mid_plane_names]
        uses += [("surfaces", name, None) for name in self.surface_names]
        result: dict[str, Named] = {}
        for use, name, body in uses:
            renamed = name in self.surface_names
            key = f"geometry.surfaces.{name}" if renamed else f"geometry.{use}"
            result.setdefault(name, Named(name, (self._in_file(name),), key, body))
        return result

    def _in_file(self, name: str) -> str:
        """Name in the file of a surface."""
        return self.surface_names.get(name, name)

"""Any number of bodies meshed in another program and read from a file, or a file each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import (
    BeforeValidator,
    Field,
    PrivateAttr,
    ValidationInfo,
    model_serializer,
    model_validator,
)

from ...case.assembly.geometry import AssemblyGeometry
from ...case.values.json_schema import LIST_OF_NAMES, OrAlso
from ...case.values.section import MODEL, KeyFault, UserFile
from ...case.values.units import Length
from ..checks.assembly_checks import check_assembly
from ..reading.contents import Named
from .mesh_file import CellSets, CurvedSurfaces, FromFiles, curved_surfaces

_KEYS = {"body_names": "bodies", "surface_names": "surfaces"}
"""Attributes whose keys are named like properties of every geometry."""


def _names(value: Any) -> Any:
    """Names in the file by names in the case, from a list of names that are the same in both."""
    named = isinstance(value, list | tuple | Mapping)
    if not named or not all(isinstance(name, str) for name in value):
        raise ValueError(f"found {value!r}; must be a list of names, or a table of names")
    if len(set(value)) < len(value):
        raise ValueError(f"found {value!r}; names a surface twice")
    return value if isinstance(value, Mapping) else {name: name for name in value}


SurfaceNames = Annotated[dict[str, str], BeforeValidator(_names), OrAlso(LIST_OF_NAMES)]


class AssemblyFile(FromFiles, AssemblyGeometry):
    """Path of a mesh file of several bodies, and the names of bodies and surfaces in it.

    See `mesh_file.MeshFile` for the formats.

    Attributes
    ----------
    path : str or None
        ``.msh``, ``.inp``, ``.vtu``, ``.xdmf`` or ``.med``.
    paths : dict of str to str
        Files by body, instead of ``path``, if each body has a file of its own.
    length_unit : float
        Length of one unit of the file [m].
    thickness : float
        Thickness of a plane model, which forces refer to [m].
    body_names : dict of str to str or tuple of str
        Key ``bodies``: cell sets in the file that make up each body, by its name in the case.
    surface_names : dict of str to dict of str to str
        Key ``surfaces``: surfaces of each body, names in the file by names in the case; a list
        names surfaces by their names in the file. Bodies that share the nodes of their joint may
        both name the same surface of the file.
    curved : bool or tuple of str
        Surfaces of cells of order 1 that are smooth, see `mesh_file.MeshFile`.
    """

    name = "file"
    models: ClassVar[tuple[str, ...]] = ("axisymmetric", "plane-strain", "plane-stress", "3d")
    from_file = True

    type: Literal["file"]
    path: UserFile | None = None
    paths: dict[str, UserFile] = {}
    length_unit: Length = 1.0
    thickness: Length = 1e-3
    body_names: dict[str, CellSets] = Field(alias="bodies")
    surface_names: dict[str, SurfaceNames] = Field(alias="surfaces", min_length=1)
    curved: CurvedSurfaces = False
    _with_material: dict[str, dict[str, str]] = PrivateAttr(default={})
    _in_space: bool = PrivateAttr(default=False)
    _plane: bool = PrivateAttr(default=False)

    @model_validator(mode="after")
    def _complete(self, info: ValidationInfo):
        model = (info.context or {}).get(MODEL) or ""
        self._in_space, self._plane = model == "3d", model.startswith("plane")
        if len(self.bodies) < 2:
            raise KeyFault("bodies", f"needs two or more bodies; found {len(self.bodies)}")
        self._check_files()
        if "thickness" in self.model_fields_set and not self._plane:
            raise KeyFault("thickness", "requires a plane model")
        self._check_surfaces()
        return self

    def _check_surfaces(self) -> None:
        owners: dict[str, str] = {}
        for body, names in self.surface_names.items():
            if body not in self.bodies:
                known = ", ".join(self.bodies)
                raise KeyFault(f"surfaces.{body}", f"unknown body; must be one of: {known}")
            if not all(names) or not names:
                raise KeyFault(f"surfaces.{body}", "needs names of surfaces that are not empty")
            for name in names:
                if name in owners:
                    raise KeyFault(
                        f"surfaces.{body}",
                        f"{name!r} is a surface of {owners[name]}, too; give it a name of its own: "
                        f'{body} = {{ NAME = "{names[name]}" }}',
                    )
                owners[name] = body
        if self.curved:
            curved_surfaces(self.curved, self.surfaces)

    @model_serializer(mode="wrap")
    def _by_keys(self, handler) -> dict[str, Any]:
        left_out = set() if self._plane else {"thickness"}
        left_out |= (set() if self.paths else {"paths"}) | (set() if self.curved else {"curved"})
        found = {_KEYS.get(name, name): value for name, value in handler(self).items()}
        return {name: value for name, value in found.items() if name not in left_out}

    @property
    def surfaces(self) -> tuple[str, ...]:
        return tuple(name for names in self._surfaces_of().values() for name in names)

    def _surfaces_of(self) -> Mapping[str, Iterable[str]]:
        """Names of surfaces by body."""
        return self.surface_names

    def body_of(self, surface: str) -> str:
        return next(body for body, names in self._surfaces_of().items() if surface in names)

    @property
    def thickness_factor(self) -> float | None:  # type: ignore[override]
        return self.thickness if self._plane else None

    def press_direction(self, surface: str) -> tuple[float, ...]:
        return (0.0, 0.0, -1.0) if self._in_space else (0.0, -1.0)

    def build(self, mesh):
        surfaces = [
            Named(name, (in_file,), f"geometry.surfaces.{body}", self.bodies.index(body))
            for body, names in self.surface_names.items()
            for name, in_file in names.items()
        ]
        return self._read(surfaces)

    def not_listed(self, surface: str) -> bool:
        if self.sized or any(surface in of.values() for of in self.surface_names.values()):
            return False
        return self._has_surface(surface)

    def check(self, mesh, case):
        check_assembly(mesh, case)

"""Base class of geometries of more than two bodies, and the choice of one by its ``type``."""

from __future__ import annotations

import importlib
from abc import abstractmethod
from typing import Annotated, Any, ClassVar

from pydantic import BeforeValidator, SerializeAsAny, ValidationInfo

from ...errors import quoted
from ..values.json_schema import AnyOf
from ..values.section import MODEL, KeyFault, Section

KNOWN: dict[str, type[AssemblyGeometry]] = {}
"""Geometries by ``geometry.type``; see `known_assemblies`."""


class AssemblyGeometry(Section):
    """Base of the geometries of more than two bodies.

    Attributes
    ----------
    name : str
        Value of ``geometry.type``.
    models : tuple of str
        Values of ``model`` that it supports.
    bodies : tuple of str
    surfaces : tuple of str
        All named surfaces, of a mesh made by the program each ``body_…``.
    contacts : dict of str to tuple of str
        Pairs of faces that touch, by the name of the contact, unless the case has a table of
        contacts.
    zones : dict of str to str
        Parts of bodies that may have their own material, and the body of each.
    set_of : dict of str to str
        Cell sets of a mesh file by the zones that represent them.
    thickness_factor : float or None
        Thickness that forces of plane models refer to [m].
    sector : float
        Fraction of the circumference covered by the bodies of an axisymmetric model.
    rings : tuple of str
        Bodies whose whole ring passes through that sector.
    mirror : tuple of str
        Surfaces in a plane about which modes of instability may also be antisymmetric.
    sized : bool
        True if the mesh has the sizes ``mesh.size`` and ``mesh.contact_size``.
    has_skin : bool
        True if the mesh has rows along the contact faces, the first as high as ``mesh.skin``.
    mesh_files : str or None
        Paths of the mesh files, for messages; None if the mesh is made by the program.
    """

    name: ClassVar[str]
    models: ClassVar[tuple[str, ...]]

    zones: ClassVar[dict[str, str]] = {}
    set_of: ClassVar[dict[str, str]] = {}
    thickness_factor: ClassVar[float | None] = None
    sector: ClassVar[float] = 1.0
    rings: ClassVar[tuple[str, ...]] = ()
    mirror: ClassVar[tuple[str, ...]] = ()
    from_file: ClassVar[bool] = False
    sized: ClassVar[bool] = False
    has_skin: ClassVar[bool] = False
    mesh_files: ClassVar[str | None] = None

    type: str

    def __init_subclass__(cls, **kwargs: Any):
        super().__init_subclass__(**kwargs)
        if cls.__dict__.get("name"):  # bases of several geometries have none
            KNOWN[cls.name] = cls

    @property
    @abstractmethod
    def bodies(self) -> tuple[str, ...]: ...

    @property
    @abstractmethod
    def surfaces(self) -> tuple[str, ...]: ...

    @property
    def contacts(self) -> dict[str, tuple[str, str]]:
        return {}

    @property
    def parts(self) -> tuple[str, ...]:
        """All parts that have a material: the bodies, then the zones."""
        return *self.bodies, *self.zones

    def parts_of(self, body: str) -> tuple[str, ...]:
        """Body and its zones."""
        return body, *(zone for zone, owner in self.zones.items() if owner == body)

    def not_listed(self, surface: str) -> bool:
        """True if a file has a surface of this name that the case does not list."""
        return False

    def body_of(self, surface: str) -> str:
        """Body that a surface belongs to."""
        owners = [body for body in self.bodies if surface.startswith(f"{body}_")]
        return max(owners, key=len)

    def press_direction(self, surface: str) -> tuple[float, ...]:
        """Unit vector along which a holder of a surface presses unless it says otherwise."""
        return (0.0, -1.0)

    def pivot(self, surface: str) -> tuple[float, ...] | None:
        """Centre of rotation of a holder of a surface by default; None: the origin."""
        return None

    def track(self, face: str) -> tuple[str, float] | None:
        """Name and length [m] of the track that passes a contact face; None if it has none.

        A track of one name may pass several contacts.
        """
        return None

    def sets_of(self, body: str) -> tuple[str, ...]:
        """Cell sets of a mesh file that a body consists of."""
        return ()

    def with_cell_sets(self, sets: dict[str, dict[str, str]]) -> AssemblyGeometry:
        """Geometry with zones for the cell sets of bodies, given with the paths of their tables."""
        return self

    def with_sliding(self, faces: tuple[tuple[str, str], ...]) -> AssemblyGeometry:
        """Geometry that knows the faces of the contacts that slide, for the mesh there."""
        return self

    @abstractmethod
    def build(self, mesh) -> Any:
        """Mesh all bodies.

        Parameters
        ----------
        mesh : thermowear.case.tables.mesh.MeshTable

        Returns
        -------
        thermowear.geometry.mesh.tagged.TaggedMesh
        """

    def check(self, mesh: Any, case: Any) -> None:
        """Check a mesh that was read from a file; no-op for generated meshes.

        Parameters
        ----------
        mesh : thermowear.geometry.mesh.tagged.TaggedMesh
        case : thermowear.case.assembly.schema.AssemblyCase

        Raises
        ------
        CaseError
            If it contradicts the case.
        """


def known_assemblies() -> dict[str, type[AssemblyGeometry]]:
    """All such geometries that a case file can name, sorted by name; imports their room."""
    importlib.import_module("thermowear.geometry.geometries")
    return dict(sorted(KNOWN.items()))


def _pick(data: Any, info: ValidationInfo) -> Any:
    if isinstance(data, AssemblyGeometry):
        return data
    if not isinstance(data, dict):
        raise ValueError(f"found {quoted(data)}; must be a table")
    known, name = known_assemblies(), data.get("type")
    if not isinstance(name, str) or name not in known:
        raise KeyFault(
            "type",
            f"found {quoted(name)}; of several bodies there are: {', '.join(known)}",
        )
    context = (info.context or {}) | {MODEL: info.data.get("model")}
    return known[name].model_validate(data, context=context)


AnyAssembly = Annotated[
    SerializeAsAny[AssemblyGeometry], BeforeValidator(_pick), AnyOf(typed=known_assemblies)
]

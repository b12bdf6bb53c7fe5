"""Base class of geometries: keys in the case file and interface to the program; their selection.

Each geometry is a subclass in the room ``geometry``.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable
from typing import Any, ClassVar, get_args

from pydantic import model_validator
from pydantic.fields import FieldInfo

from ..values.pressing import Pressing
from ..values.section import KeyFault, Section, UserFile
from ..values.units import Length

KNOWN: dict[str, type[Geometry]] = {}
"""Geometries by ``geometry.type``; see `known_geometries`."""

_APART = 1e7
"""Largest ratio of two lengths of a geometry: coordinates have 16 digits, meshes few layers."""


def keyed(value: Callable[[Any], Any]) -> Any:
    """Decorate a property computed from the keys that is a class attribute in other geometries."""
    return property(value)


def named(body: str, *parts: str) -> tuple[str, ...]:
    """Names of surfaces of a body: ``body_part``."""
    return tuple(f"{body}_{part}" for part in parts)


class Geometry(Section):
    """Base of all geometries.

    Names are class attributes, or `keyed` properties where they follow from the keys.

    Attributes
    ----------
    name : str
        Value of ``geometry.type``.
    models : tuple of str
        Values of ``model`` that it supports.
    bodies : tuple of str
        Body 1 (held and loaded) and body 2.
    surfaces : tuple of str
        All named surfaces.
    contact : tuple of str
        Contact faces of body 1 and body 2, by default ``body_face``.
    held, fixed : str
        Surface of body 1 on the rigid holder; fixed surface of body 2.
    unmeshed : tuple of str
        Length keys that are no dimension of the mesh.
    slides_across : bool
        True if body 1 may slide across its axis or section, as a ball on a flat does.
    from_file : bool
        True if the mesh was made elsewhere and therefore has to be checked like the case.
    sized : bool
        True if the mesh has the sizes ``mesh.size`` and ``mesh.contact_size``.
    has_skin : bool
        True if the mesh has rows along the contact faces, see ``mesh.skin``.
    symmetry, rollers, mid_plane : tuple of str
        Surfaces that cannot move along x, y or z, but freely in their planes.
    mirror : tuple of str
        Those of a plane about which modes of instability may also be antisymmetric.
    press_direction : tuple of float
        Unit vector of the load direction of body 1, towards body 2.
    pivot_point : tuple of float or None
        Default centre of rotation of the holder of body 1 [m].
    rotation_center : tuple of float or None
        Centre of rotation of body 2, in the section; None: it moves along x [m].
    track : float or None
        Length of the track on body 2 that passes under body 1 [m].
    duty : float or None
        Duty factor: fraction of a turn for which a point of body 2 is under body 1, in space.
    duty_by_radius : tuple of tuple of float or None
        Distances from the centre of rotation, increasing, and the duty factors there, for faces of
        other outlines, in space [m] and [-].
    footprint : tuple of float or None
        Distance of a round face from the centre of rotation, and its radius if known, in space [m].
    along_paths : bool
        True if body 2 has rows of cells along the paths of its points.
    sector : float
        Fraction of the circumference covered by an axisymmetric body 1.
    thickness_factor : float or None
        Thickness that forces of plane models refer to; twice the key's in half models [m].
    mesh_files : str or None
        Paths of the mesh files, for messages; None if the mesh is made by the program.
    zones : dict of str to str
        Parts of bodies that may have their own material, and the body of each.
    set_of : dict of str to str
        Cell sets of a mesh file by the zones that represent them.
    initial_shape : str or None
        File with an initial worn shape (a design written by ``shape``, or ``profile.csv`` of an
        earlier run).
    """

    name: ClassVar[str]
    models: ClassVar[tuple[str, ...]]
    bodies: ClassVar[tuple[str, str]]
    surfaces: ClassVar[tuple[str, ...]]
    held: ClassVar[str]
    fixed: ClassVar[str]

    unmeshed: ClassVar[tuple[str, ...]] = ("thickness", "length_unit")
    slides_across: ClassVar[bool] = False
    from_file: ClassVar[bool] = False
    sized: ClassVar[bool] = False
    has_skin: ClassVar[bool] = False
    symmetry: ClassVar[tuple[str, ...]] = ()
    rollers: ClassVar[tuple[str, ...]] = ()
    mid_plane: ClassVar[tuple[str, ...]] = ()
    mirror: ClassVar[tuple[str, ...]] = ()
    press_direction: ClassVar[tuple[float, ...]] = (0.0, -1.0)
    pivot_point: ClassVar[tuple[float, ...] | None] = None
    rotation_center: ClassVar[tuple[float, float] | None] = None
    track: ClassVar[float | None] = None
    duty: ClassVar[float | None] = None
    duty_by_radius: ClassVar[tuple[tuple[float, ...], tuple[float, ...]] | None] = None
    footprint: ClassVar[tuple[float, float | None] | None] = None
    along_paths: ClassVar[bool] = True
    sector: ClassVar[float] = 1.0
    thickness_factor: ClassVar[float | None] = None
    mesh_files: ClassVar[str | None] = None
    zones: ClassVar[dict[str, str]] = {}
    set_of: ClassVar[dict[str, str]] = {}

    type: str
    initial_shape: UserFile | None = None

    def __init_subclass__(cls, **kwargs: Any):
        super().__init_subclass__(**kwargs)
        if cls.__dict__.get("name"):  # bases of several geometries have none
            KNOWN[cls.name] = cls

    @model_validator(mode="after")
    def _comparable_sizes(self):
        """Reject dimensions many orders of magnitude apart: unit errors, which cannot be meshed."""
        sizes = self.sizes()
        if not sizes:
            return self
        middle = sorted(sizes.values())[len(sizes) // 2]
        wrong = max(sizes, key=lambda key: abs(math.log(sizes[key] / middle)))
        other = (min if sizes[wrong] >= middle else max)(sizes, key=lambda key: sizes[key])
        ratio = sizes[wrong] / sizes[other]
        if max(ratio, 1 / ratio) > _APART:
            raise KeyFault(
                wrong,
                f"found {sizes[wrong]:g} m beside {other} = {sizes[other]:g} m; sizes of a "
                f"geometry must be within a factor {_APART:g} of each other (wrong unit?)",
            )
        return self

    def has_key(self, key: str) -> bool:
        """True if the table of this geometry can have a key."""
        fields = type(self).model_fields.items()
        return any(key in (name, field.alias) for name, field in fields)

    def not_listed(self, surface: str) -> bool:
        """True if a file has a surface of this name that the case does not list."""
        return False

    def sizes(self) -> dict[str, float]:
        """Lengths that the mesh is made from, by key [m]."""
        fields = type(self).model_fields.items()
        keys = (k for k, field in fields if k not in self.unmeshed and _is_length(field))
        return {key: length for key in keys if (length := getattr(self, key))}

    def check_less(self, key: str, other: str) -> None:
        """Reject a length that is not less than another one."""
        a, b = getattr(self, key), getattr(self, other)
        if not a < b:
            raise KeyFault(key, f"{a:g} m must be less than {other} {b:g} m")

    def check_greater(self, key: str, other: str) -> None:
        """Reject a length that is not greater than another one."""
        a, b = getattr(self, key), getattr(self, other)
        if not a > b:
            raise KeyFault(key, f"{a:g} m must be greater than {other} {b:g} m")

    @keyed
    def contact(self) -> tuple[str, str]:
        first, second = self.bodies
        return f"{first}_face", f"{second}_face"

    @property
    def facing(self) -> tuple[str | None, str | None]:
        """Part that bears the contact face of each body: the body, or the first of its zones.

        None where this depends on the mesh.
        """
        first, second = (self.parts_of(body)[:2][-1] for body in self.bodies)
        return first, second

    def sets_of(self, body: str) -> tuple[str, ...]:
        """Cell sets of a mesh file that a body consists of."""
        return ()

    def with_cell_sets(self, sets: dict[str, dict[str, str]]) -> Geometry:
        """Geometry with zones for the cell sets of bodies, given with the paths of their tables."""
        return self

    @property
    def passes(self) -> bool:
        """True if body 2 passes under body 1 in the model, as a strip, a disk or a drum does."""
        turns_in_space = self.rotation_center is not None and len(self.press_direction) == 3
        return self.track is not None or turns_in_space

    @property
    def parts(self) -> tuple[str, ...]:
        """All parts that have a material: the bodies, then the zones."""
        return *self.bodies, *self.zones

    def parts_of(self, body: str) -> tuple[str, ...]:
        """Body and its zones."""
        return body, *(zone for zone, owner in self.zones.items() if owner == body)

    @property
    def follows_contact(self) -> bool:
        """True if the mesh is refined for the contact zone and moves with it."""
        return type(self).expected_zone is not Geometry.expected_zone

    def rollers_of(self, body: str) -> tuple[str, ...]:
        """Surfaces of a body on rollers."""
        held = (self.held, self.fixed)[self.bodies.index(body)]
        return tuple(s for s in self.rollers if s == held or s.startswith(f"{body}_"))

    def mid_plane_of(self, body: str) -> tuple[str, ...]:
        """Surfaces of a body on planes z = const: of body 1 the held one, of body 2 all others."""
        first = body == self.bodies[0]
        return tuple(s for s in self.mid_plane if (s == self.held) is first)

    def contact_area(self) -> float | None:
        """Nominal contact area for a mean pressure; None if there is none [m²]."""
        return None

    def bearing_area(self) -> float | None:
        """Largest projected area that can bear a load; None where its zone is checked [m²]."""
        return self.contact_area()

    def expected_zone(self, pressing: Pressing) -> tuple[float, float] | None:
        """Estimate of the contact zone as a range of x; None where the whole face is meshed alike.

        The mesh is refined there.
        """
        return None

    def check_zone(self, zone: tuple[float, float]) -> None:
        """Reject a contact zone that lies outside the faces or cannot be meshed.

        Parameters
        ----------
        zone : tuple of float
            Range of x, as returned by `expected_zone` [m].

        Raises
        ------
        CaseError
        """

    @abstractmethod
    def build(self, mesh, zone: tuple[float, float] | None):
        """Mesh both bodies.

        Parameters
        ----------
        mesh : thermowear.case.tables.mesh.MeshTable
        zone : tuple of float, optional
            Contact zone as a range of x; element ends lie at both ends of it unless it is the whole
            face.

        Returns
        -------
        thermowear.geometry.mesh.tagged.TaggedMesh
        """

    def check(self, mesh, case) -> None:
        """Check a mesh that was read from a file; no-op for generated meshes.

        Parameters
        ----------
        mesh : thermowear.geometry.mesh.tagged.TaggedMesh
        case : thermowear.case.tables.schema.Case

        Raises
        ------
        CaseError
            If it contradicts the case.
        """


def _is_length(field: FieldInfo) -> bool:
    """Test whether a key holds a length greater than 0, or may do so."""
    optional = (getattr(part, "__metadata__", ()) for part in get_args(field.annotation))
    return any(Length.__metadata__[0] in marks for marks in (field.metadata, *optional))

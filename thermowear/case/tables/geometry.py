"""What the case file may say about a geometry, and what every geometry answers.

Each geometry is a subclass in the room ``geometry`` (one file a geometry).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, get_args

from pydantic import model_validator
from pydantic.fields import FieldInfo

from ..values.paths import UserFile
from ..values.section import KeyFault, Section
from ..values.units import Length

KNOWN: dict[str, type[Geometry]] = {}
"""By the word behind ``geometry.type``; see `geometry_type.known_geometries`."""

_APART = 1e7
"""Ratio of the sizes of a geometry at most: coordinates have 16 digits, and meshes some layers."""


@dataclass(frozen=True)
class Pressing:
    """How hard the bodies are pressed together, for estimates.

    Attributes
    ----------
    force : float or None
        Normal force [N]; None where the approach is given.
    approach : float or None
        [m]; None where the force is given.
    modulus : float
        Contact modulus E*, ``1/E* = Σ (1 - ν²)/E`` [Pa].
    """

    force: float | None
    approach: float | None
    modulus: float


def keyed(value: Callable[[Any], Any]) -> Any:
    """Decorate what one geometry works out from its keys and others have as a plain attribute."""
    return property(value)


class Geometry(Section):
    """Base of all geometries.

    Names are attributes of the class, or `keyed` where they follow from the keys.

    Attributes
    ----------
    name : str
        The word behind ``geometry.type``.
    models : tuple of str
        The values of ``model`` it can be used with.
    bodies : tuple of str
        Body 1 (held and loaded) and body 2.
    surfaces : tuple of str
        All named surfaces.
    contact : tuple of str
        Contact faces of body 1 and body 2.
    held, fixed : str
        Surface of body 1 on the rigid holder; fixed surface of body 2.
    unmeshed : tuple of str
        Keys of lengths that are no size of a mesh.
    slides_across : bool
        Whether body 1 may slide across its axis, as a ball does on a flat, or across its section.
    from_file : bool
        Whether the mesh was made elsewhere, so that it can be wrong as the case can.
    initial_shape : str or None
        File with the worn shape to start from (a design, as ``shape`` writes it, or ``profile.csv``
        of an earlier run).
    """

    name: ClassVar[str]
    models: ClassVar[tuple[str, ...]]
    bodies: ClassVar[tuple[str, str]]
    surfaces: ClassVar[tuple[str, ...]]
    contact: ClassVar[tuple[str, str]]
    held: ClassVar[str]
    fixed: ClassVar[str]

    unmeshed: ClassVar[tuple[str, ...]] = ("thickness", "length_unit")
    slides_across: ClassVar[bool] = False
    from_file: ClassVar[bool] = False

    type: str
    initial_shape: UserFile | None = None

    def __init_subclass__(cls, **kwargs: Any):
        super().__init_subclass__(**kwargs)
        if cls.__dict__.get("name"):  # bases of several geometries have none
            KNOWN[cls.name] = cls

    @model_validator(mode="after")
    def _of_one_order(self):
        """Sizes many orders apart are slips of a unit, and cannot be meshed."""
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
                f"geometry must be within a factor {_APART:g} of each other (a slip in a unit?)",
            )
        return self

    def sizes(self) -> dict[str, float]:
        """The lengths that the meshes are made from, by their keys [m]."""
        keys = [key for key, field in type(self).model_fields.items() if _is_length(field)]
        return {
            key: getattr(self, key)
            for key in keys
            if key not in self.unmeshed and getattr(self, key)
        }

    @property
    def symmetry(self) -> tuple[str, ...]:
        """Surfaces on a plane of symmetry x = const."""
        return ()

    @property
    def rollers(self) -> tuple[str, ...]:
        """Surfaces that cannot move along y, but freely along x."""
        return ()

    @property
    def press_direction(self) -> tuple[float, ...]:
        """Unit vector along which body 1 is pressed on body 2."""
        return (0.0, -1.0)

    @property
    def pivot_point(self) -> tuple[float, ...] | None:
        """Point about which the holder of body 1 turns, unless the case gives one [m]."""
        return None

    @property
    def rotation_center(self) -> tuple[float, float] | None:
        """Point about which body 2 turns, in the section; None: it moves along x [m]."""
        return None

    @property
    def track(self) -> float | None:
        """Length of the path round body 2 that passes under body 1 [m]."""
        return None

    @property
    def duty(self) -> float | None:
        """Part of a turn for which a point of body 2 is under body 1, at every radius, in space."""
        return None

    @property
    def sector(self) -> float:
        """Part of the circumference that an axisymmetric body 1 takes up."""
        return 1.0

    @property
    def zones(self) -> dict[str, str]:
        """Parts of bodies that may have a material of their own, and the body of each."""
        return {}

    @property
    def facing(self) -> tuple[str | None, str | None]:
        """What touches: each body, or the first of its zones, which bears its contact face.

        None where only the mesh can tell.
        """
        first, second = (self.parts_of(body)[:2][-1] for body in self.bodies)
        return first, second

    @property
    def set_of(self) -> dict[str, str]:
        """Cell sets of a mesh file by the zones that stand for them."""
        return {}

    def sets_of(self, body: str) -> tuple[str, ...]:
        """Cell sets of a mesh file that a body is made of."""
        return ()

    def with_cell_sets(self, sets: dict[str, tuple[str, ...]]) -> Geometry:
        """The geometry with zones for cell sets of bodies, by body; as it is where it has none."""
        return self

    @property
    def passes(self) -> bool:
        """Whether body 2 passes under body 1 in the model, as a strip, a disk or a drum does."""
        turns_in_space = self.rotation_center is not None and len(self.press_direction) == 3
        return self.track is not None or turns_in_space

    @property
    def parts(self) -> tuple[str, ...]:
        """Everything that has a material: the bodies, then the zones."""
        return *self.bodies, *self.zones

    def parts_of(self, body: str) -> tuple[str, ...]:
        """A body, and its zones."""
        return body, *(zone for zone, owner in self.zones.items() if owner == body)

    @property
    def thickness_factor(self) -> float | None:
        """Thickness of plane models that forces are of; twice the given one for half models [m]."""
        return None

    @property
    def follows_contact(self) -> bool:
        """Whether the mesh is made for where the faces touch, and moves with it."""
        return type(self).expected_zone is not Geometry.expected_zone

    def contact_area(self) -> float | None:
        """Nominal contact area, which turns a mean pressure into a force; None without one [m²]."""
        return None

    def expected_zone(self, pressing: Pressing) -> tuple[float, float] | None:
        """Where the faces will touch, as a range of x; None where the whole face is meshed alike.

        An estimate is enough: the mesh is refined there.
        """
        return None

    def check_zone(self, zone: tuple[float, float]) -> None:
        """Refuse a zone where the faces cannot touch, or that cannot be meshed.

        Parameters
        ----------
        zone : tuple of float
            Range of x, as `expected_zone` gives it [m].

        Raises
        ------
        CaseError
        """

    def build(self, mesh, zone: tuple[float, float] | None):
        """Mesh both bodies.

        Parameters
        ----------
        mesh : thermowear.case.tables.schema.Mesh
        zone : tuple of float, optional
            Range of x where the faces touch; element ends lie at both ends of it where it is not
            the whole face.

        Returns
        -------
        thermowear.geometry.mesh.tagged.TaggedMesh
        """
        raise NotImplementedError

    def check(self, mesh, case) -> None:
        """Check a mesh that was not made here: nothing, where it was.

        Parameters
        ----------
        mesh : thermowear.geometry.mesh.tagged.TaggedMesh
        case : thermowear.case.tables.schema.Case

        Raises
        ------
        CaseError
            If it cannot be what the case says it is.
        """


def _is_length(field: FieldInfo) -> bool:
    """Whether a key holds a length greater than 0, or may do so."""
    optional = (getattr(part, "__metadata__", ()) for part in get_args(field.annotation))
    return any(Length.__metadata__[0] in marks for marks in (field.metadata, *optional))

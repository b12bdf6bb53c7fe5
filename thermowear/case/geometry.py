"""What the case file may say about a geometry, and what every geometry answers.

Each geometry is a subclass in the room ``geometry`` (one file a geometry) and is known to the case
file by its ``type`` as soon as that room is imported.
"""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from pydantic import BeforeValidator, SerializeAsAny

from .section import KeyFault, Section

_KNOWN: dict[str, type[Geometry]] = {}


class Geometry(Section):
    """Base of all geometries.

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
    """

    name: ClassVar[str]
    models: ClassVar[tuple[str, ...]]
    bodies: ClassVar[tuple[str, str]]
    surfaces: ClassVar[tuple[str, ...]]
    contact: ClassVar[tuple[str, str]]
    held: ClassVar[str]
    fixed: ClassVar[str]

    type: str

    def __init_subclass__(cls, **kwargs: Any):
        super().__init_subclass__(**kwargs)
        _KNOWN[cls.name] = cls

    def contact_area(self) -> float:
        """Nominal contact area, which turns a mean pressure into a force [m²]."""
        raise NotImplementedError

    def build(self, mesh):
        """Mesh both bodies.

        Parameters
        ----------
        mesh : thermowear.case.schema.Mesh

        Returns
        -------
        thermowear.geometry.tagged.TaggedMesh
        """
        raise NotImplementedError


def known_geometries() -> dict[str, type[Geometry]]:
    """All geometries that can be named in a case file."""
    return dict(sorted(_KNOWN.items()))


def _pick(data: Any) -> Any:
    if isinstance(data, Geometry):
        return data
    if not isinstance(data, dict):
        raise ValueError(f"found {data!r}; needs a table")
    if "type" not in data:
        raise KeyFault("type", f"missing; one of: {', '.join(known_geometries())}")
    try:
        kind = _KNOWN[data["type"]]
    except (KeyError, TypeError):
        raise KeyFault(
            "type", f"found {data['type']!r}; must be one of: {', '.join(known_geometries())}"
        ) from None
    return kind.model_validate(data)


AnyGeometry = Annotated[SerializeAsAny[Geometry], BeforeValidator(_pick)]

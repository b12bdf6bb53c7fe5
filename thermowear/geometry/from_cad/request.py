"""Request for the mesh of CAD files: bodies, named surfaces, faces that touch, element sizes.

Sent to the process that runs OpenCASCADE, see `meshing_process`.
"""

from __future__ import annotations

from dataclasses import dataclass

Point = tuple[float, float, float]


class CadError(ValueError):
    """One line about a CAD file or the choice of its faces, with the path of the key."""


@dataclass(frozen=True)
class BodyRequest:
    """Body of the case, and the solids that it consists of.

    Attributes
    ----------
    name : str
    path : str
        ``.step``, ``.stp`` or ``.brep``.
    key : str
        Path of the key with the file, for messages.
    solids : tuple of str or Point
        Labels in the file, or points inside [m]; empty: all solids of the file.
    solids_key : str
        Path of the key with the solids, for messages.
    unit : float or None
        Length of one unit of a file that has none of its own [m].
    size, contact_size : float or None
        Largest element size, and that on the contact face [m]; None: follow from the size of the
        body.
    grading : float
        Element size at the edge of the contact face relative to that on it.
    """

    name: str
    path: str
    key: str
    solids: tuple[str | Point, ...]
    solids_key: str
    unit: float | None
    size: float | None
    contact_size: float | None
    grading: float


@dataclass(frozen=True)
class FaceChoice:
    """Choice of faces by one of three ways.

    Attributes
    ----------
    label : str or None
        Label of faces in the file.
    point : Point or None
        Point on one face [m].
    plane : tuple or None
        Unit normal, and distance of the plane from the origin along it [m].
    body : str or None
        Only faces of this body.
    """

    label: str | None = None
    point: Point | None = None
    plane: tuple[Point, float] | None = None
    body: str | None = None


@dataclass(frozen=True)
class SurfaceRequest:
    """Named surface: all faces of its choices; of one body, or of those that have any.

    Attributes
    ----------
    name : str
    key : str
        Path of the key that chooses the faces, for messages.
    choices : tuple of FaceChoice
    body : str or None
        Only body that the faces can belong to.
    reason : str
        Why it is the only one, for messages.
    """

    name: str
    key: str
    choices: tuple[FaceChoice, ...]
    body: str | None = None
    reason: str = ""


@dataclass(frozen=True)
class TouchRequest:
    """Surfaces of the faces where two bodies touch."""

    bodies: tuple[str, str]
    names: tuple[str, str]
    key: str


@dataclass(frozen=True)
class Zone:
    """Small zone of a contact that a load closes, for which both meshes are refined.

    Attributes
    ----------
    faces : tuple of str
        Surfaces that slide on each other.
    centres : tuple of Point
        Its centre on each of them [m].
    along : Point
        Unit vector of its length.
    length, width : float
        Halves of its length and of its width [m].
    """

    faces: tuple[str, str]
    centres: tuple[Point, Point]
    along: Point
    length: float
    width: float


@dataclass(frozen=True)
class CadRequest:
    """Everything that a mesh follows from, besides the contents of the files.

    Attributes
    ----------
    bodies : tuple of BodyRequest
    surfaces : tuple of SurfaceRequest
    touching : tuple of TouchRequest
    faces : tuple of tuple of str
        Surfaces, two each, that slide on each other: the mesh is refined there.
    tolerance : float or None
        Largest distance of faces that touch [m]; None: a small part of the smaller body.
    zones : tuple of Zone
    digests : tuple of str
        SHA-256 of the files of the bodies.
    """

    bodies: tuple[BodyRequest, ...]
    surfaces: tuple[SurfaceRequest, ...]
    touching: tuple[TouchRequest, ...] = ()
    faces: tuple[tuple[str, str], ...] = ()
    tolerance: float | None = None
    zones: tuple[Zone, ...] = ()
    digests: tuple[str, ...] = ()

"""Body on a user's dolfinx mesh, with the user's own tags."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..errors import CaseError, quoted
from ..model.body import Body, Material


@dataclass(frozen=True)
class BodySurface:
    """Facets of a body with one tag.

    Attributes
    ----------
    body : MeshBody
    tag : int
    """

    body: MeshBody
    tag: int

    @property
    def name(self) -> str:
        """Name of the surface in the model."""
        return f"{self.body.name}:{self.tag}"


def require_surface(given: Any, name: str) -> None:
    """Raise a `CaseError` if an argument is no surface."""
    if not isinstance(given, BodySurface):
        raise CaseError(f"{name}: found {quoted(given)}; must be body.surface(tag)")


@dataclass(frozen=True, eq=False)
class MeshBody:
    """Elastic and heat-conducting body on all or some cells of a dolfinx mesh.

    Attributes
    ----------
    name : str
    mesh : dolfinx.mesh.Mesh
        Mesh of this body alone, or of several bodies; the joint of two bodies with common nodes is
        separated.
    cells : dolfinx.mesh.MeshTags, ndarray of int or None
        Tags of the cells if `materials` is a mapping. Otherwise the local indices of the cells of
        the body, such as ``cell_tags.find(205)``; None: all cells.
    facets : dolfinx.mesh.MeshTags
        Tags of the facets.
    materials : Material or mapping of int to Material
        Material of all cells, or materials by cell tag; the body consists of the cells with these
        tags.
    fixed, rollers : int or sequence of int
        Tags of clamped surfaces; of surfaces that cannot move along y, but freely along x, also of
        one on a holder.
    mid_plane : int or sequence of int
        In space: tags of surfaces on planes z = const that cannot move along z, but freely in the
        plane, also of one on a holder.
    curved : int or sequence of int
        Tags of smooth surfaces of straight-sided cells: nodes between corners are put on planes,
        cylinders, cones and spheres (circles in a section) through the corners, or on smooth
        surfaces. Adjacent facets at more than 40° meet in an edge.
    """

    name: str
    mesh: Any = field(repr=False)
    cells: Any = field(repr=False)
    facets: Any = field(repr=False)
    materials: Material | Mapping[int, Material] = field(repr=False)
    fixed: int | Sequence[int] = ()
    rollers: int | Sequence[int] = ()
    mid_plane: int | Sequence[int] = ()
    curved: int | Sequence[int] = ()

    def __post_init__(self):
        if isinstance(self.materials, Mapping) != hasattr(self.cells, "values"):
            raise CaseError(
                f"Body {self.name!r}: materials by cell tag need the MeshTags of the cells, one "
                "material an array of cells (cell_tags.find(tag), or None for all)"
            )

    def surface(self, tag: int) -> BodySurface:
        """Surface with a facet tag. Every rank calls.

        Raises
        ------
        CaseError
            If no facet of the mesh has the tag.
        """
        every = self.mesh.comm.allgather(np.unique(self.facets.values))
        known = np.unique(np.concatenate(every))
        if tag not in known:
            tags = ", ".join(map(str, known)) or "none"
            raise CaseError(f"Body {self.name!r}: no facet has the tag {tag!r}; known: {tags}")
        return BodySurface(self, int(tag))

    @property
    def parts(self) -> dict[str, Material]:
        """Materials by the name of a part; the first part has the name of the body."""
        if not isinstance(self.materials, Mapping):
            return {self.name: self.materials}
        first, *others = self.materials.items()
        return {self.name: first[1]} | {f"{self.name}:{tag}": m for tag, m in others}

    @property
    def part_of_tag(self) -> dict[int, str]:
        """Name of the part of each cell tag; empty for a body of one material."""
        tags = self.materials if isinstance(self.materials, Mapping) else ()
        return dict(zip(tags, self.parts, strict=False))

    def part_of_cells(self) -> np.ndarray:
        """Index of the part of each owned cell of the mesh, -1 for cells of other bodies."""
        parts = np.full(self.mesh.topology.index_map(self.mesh.topology.dim).size_local, -1)
        if isinstance(self.materials, Mapping):
            groups = [self.cells.find(tag) for tag in self.materials]
        else:
            groups = [np.arange(len(parts)) if self.cells is None else np.asarray(self.cells)]
        for part, cells in enumerate(groups):
            parts[cells[cells < len(parts)]] = part
        return parts

    def _names(self, tags: int | Sequence[int]) -> tuple[str, ...]:
        """Names of the surfaces with some tags."""
        return tuple(self.surface(tag).name for tag in np.atleast_1d(np.asarray(tags, dtype=int)))

    @property
    def smooth(self) -> tuple[str, ...]:
        """Names of the surfaces that are curved. Every rank calls."""
        return self._names(self.curved)

    def in_model(self, surfaces: tuple[str, ...], held: BodySurface | None) -> Body:
        """Body of a model, with all its surfaces, on a holder or fixed."""
        fixed, rollers, mid_plane = map(self._names, (self.fixed, self.rollers, self.mid_plane))
        if held is not None and fixed:
            raise CaseError(f"Body {self.name!r}: is on a holder; leave out fixed")
        clamped = fixed if held is None else tuple({held.name} - {*rollers, *mid_plane})
        return Body(self.name, self.parts, clamped, rollers, mid_plane, surfaces)

"""Contact faces divided by expressions of the place: groups of materials by facet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...contact.faces.face import Face, Surface
from ...errors import CaseError
from ...lagrange import lattice
from ...laws.expressions import Region
from ...model.face_wear import CompositeWear
from ...model.interface import Interface
from ...model.model import Model

_SAMPLES = 4
"""Degree of the lattice of places on a facet."""
_AT_BORDER = 1e-6
"""Distance from the border of a region, relative to the facet, that counts as zero."""


def regions_of(interface: Interface) -> list[tuple[int, str, Region, int]]:
    """Face, name, region and group of each part of the faces by an expression of the place."""
    return [
        (side, name, region, wear.each.index(law))
        for side, wear in interface.wear.items()
        if isinstance(wear, CompositeWear)
        for name, (region, law) in wear.regions.items()
    ]


def divided_faces(
    model: Model, interface: Interface, faces: Sequence[Face | Surface]
) -> list[Face | Surface]:
    """Faces of an interface, with the groups of the regions that their facets lie in.

    Raises
    ------
    CaseError
        If the border of a region cuts facets, or regions overlap.
    """
    divided, owner = list(faces), dict[int, np.ndarray]()
    for side, name, region, group in regions_of(interface):
        face = faces[side]
        where = f"{table(model, interface, side)}.{name}.where"
        inside = _inside(face, region, where, model.kinematics == "axisymmetric")
        known = owner.setdefault(side, np.full(len(face.nodes), "", dtype=object))
        twice = inside & (known != "")
        if twice.any():
            raise CaseError(
                f"{where}: overlaps {known[twice][0]} on {face.name}, near {_place(face, twice)}; "
                "each element of the face needs one law"
            )
        known[inside] = name
        groups = np.where(inside, group, divided[side].group_at(np.arange(len(face.nodes))))
        divided[side] = replace(divided[side], group=groups)
    return divided


def require_regions(model: Model, faces: Sequence[Sequence[Face | Surface]]) -> None:
    """Reject regions without an element of any contact face of their body.

    Raises
    ------
    CaseError
    """
    found: dict[str, bool] = {}
    for interface, both in zip(model.interfaces, faces, strict=True):
        for side, name, region, _ in regions_of(interface):
            where = f"{table(model, interface, side)}.{name}.where"
            axisymmetric = model.kinematics == "axisymmetric"
            some = bool(_inside(both[side], region, where, axisymmetric).any())
            found[where] = found.get(where, False) or some
    for where, some in found.items():
        if not some:
            raise CaseError(f"{where}: no element of a contact face of this body lies there")


def table(model: Model, interface: Interface, side: int) -> str:
    """Path of the table of the parts of a face."""
    return f"wear.{model.bodies[interface.bodies[side]].name}.materials"


def _inside(face: Face | Surface, region: Region, where: str, axisymmetric: bool) -> np.ndarray:
    """Facets inside a region, shape (n_facets,)."""
    t, count = lattice(_SAMPLES, face.kind).reshape(-1, face.dim), len(face.nodes)
    facet, t = face.on_each(t if face.dim > 1 else t[:, 0])
    depth = region.depth(face.points(facet, t), axisymmetric).reshape(count, -1)
    wrong = ~np.isfinite(depth).all(axis=1)
    if wrong.any():
        raise CaseError(f"{where}: has no value near {_place(face, wrong)}")
    near = _AT_BORDER * np.ptp(face.nodes, axis=1).max(axis=1)
    cut = (depth.max(axis=1) > near) & (depth.min(axis=1) < -near)
    if cut.any():
        raise CaseError(
            f"{where}: the border of this region cuts an element of {face.name} near "
            f"{_place(face, cut)}; end elements there (mesh.elements, mesh.grading), or move the "
            "border"
        )
    return depth.max(axis=1) > near


def _place(face: Face | Surface, facets: np.ndarray) -> str:
    """Middle of the first of some facets, for messages."""
    middle = face.nodes[facets][0].mean(axis=0)
    return "(" + ", ".join(f"{x:.4g}" for x in middle) + ") m"

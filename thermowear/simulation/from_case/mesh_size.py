"""Meshes that differ in degree, elements and grading, and the changes between them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from ...case.tables.mesh import MOST_ELEMENTS

_HIGHEST = 10
_GRADINGS = (0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 1.0)


@dataclass(frozen=True)
class MeshSize:
    """Keys of ``mesh`` that an accuracy stands for, see `MeshTable`."""

    degree: int = 1
    elements: int = 4
    grading: float = 0.5

    def higher(self) -> MeshSize | None:
        """The next degree."""
        return replace(self, degree=self.degree + 1) if self.degree < _HIGHEST else None

    def lower(self) -> MeshSize | None:
        """The degree before."""
        return replace(self, degree=self.degree - 1) if self.degree > 1 else None

    def finer(self) -> MeshSize | None:
        """Elements shorter by a third, an even number."""
        elements = max(self.elements + 2, 2 * round(0.75 * self.elements))
        return replace(self, elements=elements) if elements <= MOST_ELEMENTS else None

    def coarser(self) -> MeshSize | None:
        """Elements longer by a half, an even number."""
        elements = min(self.elements - 2, 2 * round(self.elements / 3))
        return replace(self, elements=elements) if elements >= 2 else None

    def steeper(self) -> MeshSize | None:
        """Elements smaller towards the edges of the contact."""
        smaller = [g for g in _GRADINGS if g < self.grading]
        return replace(self, grading=smaller[-1]) if smaller else None

    def flatter(self) -> MeshSize | None:
        """Elements less small towards the edges of the contact."""
        larger = [g for g in _GRADINGS if g > self.grading]
        return replace(self, grading=larger[0]) if larger else None


Step = Callable[[MeshSize], MeshSize | None]

_FORWARD: dict[str, tuple[str, Step]] = {
    "higher degree": ("degree", MeshSize.higher),
    "more elements": ("elements", MeshSize.finer),
    "steeper grading": ("grading", MeshSize.steeper),
    "flatter grading": ("grading", MeshSize.flatter),
}
"""Changes that may reduce the error, with the key that they change."""
_BACK: dict[str, tuple[str, Step]] = _FORWARD | {
    "higher degree": ("degree", MeshSize.lower),
    "more elements": ("elements", MeshSize.coarser),
}
"""Changes that may reduce the number of unknowns."""


def changes(chosen: set[str]) -> tuple[Mapping[str, Step], Mapping[str, Step], Step]:
    """Changes of the keys that are to be chosen.

    Returns
    -------
    forward, back : mapping of str to callable
        Changes that may reduce the error, and the number of unknowns.
    finer : callable
        Change to a mesh that is finer in every respect.
    """
    forward, back = (
        {name: step for name, (key, step) in steps.items() if key in chosen}
        for steps in (_FORWARD, _BACK)
    )
    if {"degree", "elements"} <= chosen:
        back["degree for elements"] = _both(MeshSize.lower, MeshSize.finer)
        back["elements for degree"] = _both(MeshSize.higher, MeshSize.coarser)
    refined = [name for name in ("higher degree", "more elements") if name in forward]
    return forward, back, _each(*(forward[name] for name in refined or forward))


def _both(first: Step, second: Step) -> Step:
    """Two changes at once; None if one is not possible."""

    def changed(size: MeshSize) -> MeshSize | None:
        between = first(size)
        return None if between is None else second(between)

    return changed


def _each(*steps: Step) -> Step:
    """All changes that are possible; None if none is."""

    def changed(size: MeshSize) -> MeshSize | None:
        found = size
        for step in steps:
            found = step(found) or found
        return None if found == size else found

    return changed

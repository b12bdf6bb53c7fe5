"""Both contact faces of a case; closed curves are cut far from the contact.

Contact points are ordered along a face from its first end to its last; closed curves (full pin in a
full bush) have no ends. Such a curve is cut at the vertex farthest from the other face.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from dolfinx import fem

from ...bulk.bodies import Bodies
from .face import ONWARD, Face, gather_face
from .projection import project
from .surface import Surface


def gather_faces(
    bodies: Bodies, surfaces: tuple[str, str], softness: fem.Function | None = None
) -> tuple[Face | Surface, Face | Surface]:
    """Gather both contact faces, see `face.gather_face`; every rank calls."""
    first, second = (gather_face(bodies, surface, softness) for surface in surfaces)
    return _opened(first, second), _opened(second, first)


def _opened(face: Face | Surface, other: Face | Surface) -> Face | Surface:
    """Face; a closed curve is cut far from the other face and runs along `ONWARD` past it."""
    if isinstance(face, Surface) or not face.closed:
        return face
    offsets = project(other, face.nodes[:, 0])[2]
    first = int(np.linalg.norm(offsets, axis=1).argmax())
    rolled = _reordered(face, np.roll(np.arange(len(face.nodes)), -first))
    position = np.concatenate([[0.0], np.cumsum(rolled.sizes)])
    middle = int(np.searchsorted(position, position[-1] / 2, side="right")) - 1
    onward = (rolled.nodes[middle, -1] - rolled.nodes[middle, 0]) @ ONWARD
    return rolled if onward > 0 else _reversed(rolled)


def _reordered(face: Face, order: np.ndarray) -> Face:
    """Face with its facets in another order."""
    names = ("nodes", "outward", "rank", "cell", "local_facet", "reversed")
    columns = {name: getattr(face, name)[order] for name in names}
    return replace(face, **columns, softness=face.softness_at(order))


def _reversed(face: Face) -> Face:
    """Face with reversed direction."""
    backward = _reordered(face, np.arange(len(face.nodes))[::-1])
    return replace(
        backward,
        nodes=backward.nodes[:, ::-1],
        outward=-backward.outward,
        reversed=~backward.reversed,
    )

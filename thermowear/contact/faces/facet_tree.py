"""Search trees of the facets of a surface, by octaves of their size."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

_NEAREST = 12
"""Number of facets of each octave that are candidates for the closest one, by their centres."""


class FacetTree:
    """Centres of facets in space, in one tree for each octave of their radii.

    Parameters
    ----------
    nodes : ndarray, shape (n_facets, n_nodes, 3) [m]

    Attributes
    ----------
    radii : ndarray, shape (n_facets,)
        Radii of the spheres round the facets [m].
    """

    def __init__(self, nodes: np.ndarray):
        centres = nodes.mean(axis=1)
        self.radii = np.linalg.norm(nodes - centres[:, None], axis=2).max(axis=1)
        octave = np.floor(np.log2(self.radii / self.radii.min())).astype(int)
        groups = [np.flatnonzero(octave == k) for k in np.unique(octave)]
        self._trees = [(g, cKDTree(centres[g]), float(self.radii[g].max())) for g in groups]

    def nearest(self, points: np.ndarray) -> np.ndarray:
        """Facets of each octave with the nearest centres to points, (n, n_candidates)."""
        found = [
            alike[tree.query(points, np.arange(1, min(_NEAREST, len(alike)) + 1))[1]]
            for alike, tree, _ in self._trees
        ]
        return np.hstack(found)

    def touching(self, centres: np.ndarray, radii: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pairs of a sphere and a facet whose own sphere overlaps it, in order of both."""
        spheres, facets = [], []
        for alike, tree, largest in self._trees:
            found = tree.query_ball_point(centres, radii + largest)
            counts = np.array([len(part) for part in found])
            spheres.append(np.repeat(np.arange(len(centres)), counts))
            facets.append(alike[np.concatenate(found).astype(np.int64)])
        sphere, facet = np.concatenate(spheres), np.concatenate(facets)
        order = np.lexsort((facet, sphere))
        return sphere[order], facet[order]

"""Numbers of the nodes and facets of a surface after the body behind it has been remeshed.

The facets are the same, but facets, their corners and nodes are numbered by the new cells.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...lagrange import corner_nodes, lattice, on_lattice
from .face import Surface


@dataclass(frozen=True)
class Renumbering:
    """New numbers of a surface.

    Attributes
    ----------
    kind : str
        Kind of its facets.
    nodes : ndarray of int, shape (n_nodes,)
        Former number of each node.
    facets : ndarray of int, shape (n_facets,)
        New number of each former facet.
    corners : ndarray of int, shape (n_facets, n_corners)
        Former corner at each new corner of a former facet, in the order of `lagrange.lattice`.
    """

    kind: str
    nodes: np.ndarray
    facets: np.ndarray
    corners: np.ndarray

    def place(self, facet: np.ndarray, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """New facets (n,) and parameters (n, 2) of points given by the former ones."""
        former = on_lattice(1, t, kind=self.kind)[0]
        weights = np.take_along_axis(former, self.corners[facet], axis=1)
        return self.facets[facet], weights @ lattice(1, self.kind)

    def of_facets(self, values: np.ndarray) -> np.ndarray:
        """Values by new facet, given by former facet (n_facets, ...)."""
        result = np.empty_like(values)
        result[self.facets] = values
        return result


def renumbering(former: Surface, places: np.ndarray, new: Surface) -> Renumbering:
    """Match the facets of a surface to those of another mesh with the same nodes.

    Parameters
    ----------
    former : Surface
    places : ndarray, shape (n_nodes, 3)
        Places of its nodes in the new mesh, see `contact.wear.worn_face.nodes_of` [m].
    new : Surface

    Raises
    ------
    ValueError
        If the facets differ.
    """
    own, order = new.numbers(new.order), new.order
    at = np.empty((own.max() + 1, 3))
    at[own] = new.nodes
    nodes = cKDTree(places).query(at)[1]
    ends = corner_nodes(order, new.kind)
    before, after = former.numbers(order)[:, ends], nodes[own][:, ends]
    each = [np.sort(corners, axis=1) for corners in (before, after)]
    first, second = (np.lexsort(corners.T) for corners in each)
    if not np.array_equal(each[0][first], each[1][second]):
        raise ValueError(f"the facets of {former.name} differ")
    facets = np.empty(len(before), dtype=np.int64)
    facets[first] = second
    same = before[:, None] == after[facets][:, :, None]
    return Renumbering(new.kind, nodes, facets, same.argmax(axis=2))

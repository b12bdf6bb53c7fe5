"""Contact points at edges where the pressure of unworn bodies is singular.

A contact that ends at a sharp edge of one body, while the smooth surface of the other one goes on
(within the contact face, or beyond its end there), has
a pressure that grows towards the edge like a negative power of the distance (Dundurs and Lee, J.
Elasticity 2 (1972) 109): the finer the elements, the larger the largest pressure. Forces, and the
pressure away from the edge, converge. Wear and soft layers between the faces make it finite.
"""

from __future__ import annotations

import numpy as np

from ...bulk.bodies import Bodies
from ...contact.faces.rim import beside_edges, edges_of, rim
from ...contact.search.carrier import ends_within
from ...contact.search.common_face import opposite
from ...contact.search.contacts import Contacts
from ...contact.search.pairing import Pairing


def singular_points(bodies: Bodies, contacts: Contacts, softness: np.ndarray) -> np.ndarray:
    """Contact points on facets at such an edge, or next to them, bool (n,). Every rank calls.

    Whether they touch, and whether they are worn, is not asked.

    Parameters
    ----------
    bodies : Bodies
    contacts : Contacts
    softness : ndarray, shape (n,)
        Compliance of the layer between the faces [m/Pa].
    """
    found = [_at_edges(bodies, pairing) for pairing in contacts.each]
    return np.concatenate(found) & (softness == 0.0)


def _at_edges(bodies: Bodies, pairing: Pairing) -> np.ndarray:
    """Points of an interface at sharp edges of either face where the other body goes on, (n,)."""
    carrying = pairing.carrying
    numbers = carrying.face.corner_numbers
    at_edge = []
    for side, other in (pairing.sides, pairing.sides[::-1]):
        face = side.face
        sharp, goes_on = (
            rim(one, bodies.each[one.body], [one.name])[k]
            for k, one in enumerate((face, other.face))
        )
        within = ends_within(face, other.face)
        ends = sharp & ~within  # where the other face may end, too
        if ends.any():
            beyond = opposite(face, *beside_edges(face, ends), other.face).facet
            within[ends] = goes_on[beyond].reshape(np.count_nonzero(ends), -1).any(axis=1)
        sharp &= within
        if face is carrying.face:
            at_edge.append(numbers[:, edges_of(face.kind)][sharp].ravel())
        elif sharp.any():  # cuts facets of the other face
            cut = opposite(face, *beside_edges(face, sharp), other.face).facet
            at_edge.append(numbers[cut].ravel())
    return np.any(np.isin(numbers, np.concatenate(at_edge))[carrying.facet], axis=1)

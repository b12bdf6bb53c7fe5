"""Contact points at edges where the pressure of unworn bodies is singular.

A contact that ends at a sharp edge of one body, while the smooth face of the other one goes on, has
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
    """Points of an interface at the sharp edges of either face within the other one, (n,)."""
    carrying = pairing.carrying
    numbers = carrying.face.corner_numbers
    at_edge = []
    for side, other in (pairing.sides, pairing.sides[::-1]):
        face = side.face
        sharp = rim(face, bodies.each[face.body], [face.name])[0] & ends_within(face, other.face)
        if face is carrying.face:
            at_edge.append(numbers[:, edges_of(face.kind)][sharp].ravel())
        elif sharp.any():  # cuts facets of the other face
            cut = opposite(face, *beside_edges(face, sharp), other.face).facet
            at_edge.append(numbers[cut].ravel())
    return np.any(np.isin(numbers, np.concatenate(at_edge))[carrying.facet], axis=1)

"""Wear of the faces of all interfaces, as laws of the first and of the second faces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...contact.search.contacts import Contacts
from ...contact.search.pairing import Pairing
from ...laws.distribution import IN_PLACE, Distribution, joined_distributions
from ...laws.interfaces import Law
from ...laws.law_by_point import joined_laws
from ...laws.layered_wear import LayeredWear
from ...model.face_wear import FaceWear, Wear
from ...model.model import Model
from ...model.tracks import EvenTrack


@dataclass(frozen=True)
class JointWear:
    """Wear at the contact points of a model.

    Attributes
    ----------
    model : Model
    contacts : Contacts
    """

    model: Model
    contacts: Contacts

    @cached_property
    def laws(self) -> dict[int, Law]:
        """Wear laws of the first (0) and of the second faces; faces without wear are left out."""
        return self.laws_of(self._counts)

    def laws_of(self, counts: Sequence[int]) -> dict[int, Law]:
        """Wear laws, likewise, of numbers of points or pressure functions of each interface."""
        return {
            side: joined_laws([_law(wear, pairing, side) for wear, pairing in each], counts)
            for side, each in self._sides.items()
        }

    @cached_property
    def spreads(self) -> dict[int, Distribution]:
        """Distribution of the wear of these faces, likewise."""
        return {
            side: joined_distributions(
                [self._distribution(wear, pairing) for wear, pairing in each],
                self._counts,
                [_track(wear) or str(k) for k, (wear, _) in enumerate(each)],
            )
            for side, each in self._sides.items()
        }

    @cached_property
    def coverage(self) -> np.ndarray:
        """Fraction of the worn area of each face that is in contact at a time, shape (2, n)."""
        result = np.ones((2, sum(self._counts)))
        for side, spread in self.spreads.items():
            result[side] = spread.coverage
        return result

    def _distribution(self, wear: Wear | None, pairing: Pairing) -> Distribution:
        thickness = self.model.thickness or 1.0
        if wear is None:
            return IN_PLACE
        return wear.distribution(pairing.points, pairing.weights, thickness)

    @property
    def _counts(self) -> list[int]:
        return [len(pairing.weights) for pairing in self.contacts.each]

    @cached_property
    def _sides(self) -> dict[int, list[tuple[Wear | None, Pairing]]]:
        """Wear of a side of every interface, with its points, for the sides that wear anywhere."""
        interfaces = self.model.interfaces
        worn = sorted({side for interface in interfaces for side in interface.wear})
        pairs = list(zip(interfaces, self.contacts.each, strict=True))
        return {side: [(one.wear.get(side), pairing) for one, pairing in pairs] for side in worn}


def _law(wear: Wear | None, pairing: Pairing, side: int) -> Law | None:
    """Law of a side of an interface; None where it does not wear."""
    if wear is None:
        return None
    law = wear.law_at(pairing.groups[side])
    if not (isinstance(law, LayeredWear) and wear.in_place):  # tracks are worn evenly
        return law
    return replace(law, variation=depth_variation(pairing))


def depth_variation(pairing: Pairing) -> np.ndarray:
    """Range of the wear depth between the neighbours of each point, (n,) [m].

    That of the unworn gap: constant in time, as the depth has to be a function of the dose alone.
    """
    facet, gap, area = pairing.carrying.facet, pairing.gap, pairing.weights
    low, high = np.full((2, facet.max() + 1), [[np.inf], [-np.inf]])
    np.minimum.at(low, facet, gap)
    np.maximum.at(high, facet, gap)
    share = area / np.bincount(facet, area)[facet]
    return 2 * (high - low)[facet] * share ** (1 / pairing.carrying.face.dim)


def _track(wear: Wear | None) -> str:
    """Name of the track that passes several interfaces; empty for one of its own."""
    track = wear.track if isinstance(wear, FaceWear) else None
    return track.name if isinstance(track, EvenTrack) else ""

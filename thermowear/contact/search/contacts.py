"""Contact points of all interfaces of a model, one interface after the other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import scipy.sparse as sp

from ...errors import CaseError
from ..faces.face import Surface
from .pairing import Pairing


@dataclass(frozen=True)
class Contacts:
    """Pairings of all interfaces; arrays list their points one interface after the other.

    Attributes
    ----------
    each : tuple of Pairing
    bodies : tuple of tuple of int
        Indices of the first and of the second body of each interface.
    """

    each: tuple[Pairing, ...]
    bodies: tuple[tuple[int, int], ...] = ((0, 1),)

    def __iter__(self) -> Iterator[tuple[Pairing, slice]]:
        """Pairings with the ranges of their points."""
        return zip(self.each, self.ranges, strict=True)

    @property
    def only(self) -> Pairing:
        """Pairing of a single interface.

        Raises
        ------
        CaseError
            If there are several.
        """
        if len(self.each) > 1:
            raise CaseError(
                f"the model has {len(self.each)} interfaces; what is asked for is supported for "
                "one interface only"
            )
        return self.each[0]

    @cached_property
    def ranges(self) -> tuple[slice, ...]:
        """Range of the points of each interface."""
        counts = [len(pairing.weights) for pairing in self.each]
        return tuple(slice(a, b) for a, b in pairwise([0, *np.cumsum(counts)]))

    @cached_property
    def points(self) -> np.ndarray:
        """Points on the common faces, shape (n, gdim) [m]."""
        return self._joined("points")

    @cached_property
    def position(self) -> np.ndarray:
        """Arc length along the face of the first body of the interface, shape (n,) [m]."""
        return self._joined("position")

    @cached_property
    def weights(self) -> np.ndarray:
        """Area at each point, shape (n,) [m²]."""
        return self._joined("weights")

    @cached_property
    def normals(self) -> np.ndarray:
        """Unit normals outward from the first body of the interface, shape (n, gdim)."""
        return self._joined("normals")

    @cached_property
    def gap(self) -> np.ndarray:
        """Gap of the unloaded, unworn bodies, shape (n,) [m]."""
        return self._joined("gap")

    @cached_property
    def on_body_1(self) -> np.ndarray:
        """Points on the face of the first body of the interface, shape (n, gdim) [m]."""
        return self._joined("on_body_1")

    @cached_property
    def on_body_2(self) -> np.ndarray:
        """Points on the face of the second body of the interface, shape (n, gdim) [m]."""
        return self._joined("on_body_2")

    @cached_property
    def facets(self) -> sp.csr_array:
        """Points on each facet of the carrying faces, bool (n_facets, n).

        One interface after the other. A point between facets is on each of them, so that which one
        comes first does not matter.
        """
        return sp.csr_array(sp.block_diag([_on_facets(p) for p in self.each], format="csr"))

    @cached_property
    def carriers(self) -> np.ndarray:
        """Side (0 or 1) of the face of each interface that carries the points."""
        return np.array([pairing.carrier for pairing in self.each])

    def by_side(self, values: np.ndarray) -> np.ndarray:
        """Values of the first and of the second faces from those of the carrying and of the others.

        By interface or by point, (2, n_interfaces) or (2, n).
        """
        each = values.shape[1] == len(self.each)
        second = self.carriers if each else self.per_point(self.carriers)
        return np.where(second == 0, values, values[::-1])

    @cached_property
    def in_space(self) -> bool:
        """True for bodies in space."""
        return isinstance(self.each[0].sides[0].face, Surface)

    def per_point(self, values) -> np.ndarray:
        """Values by interface at the points, shape (n,)."""
        counts = [len(pairing.weights) for pairing in self.each]
        return np.repeat(np.asarray(values, dtype=float), counts)

    def of_body(self, index: int) -> list[tuple[int, slice]]:
        """Sides (0 or 1) and ranges of the points at which a body is in contact."""
        parts = zip(self.bodies, self.ranges, strict=True)
        return [(pair.index(index), points) for pair, points in parts if index in pair]

    def _joined(self, name: str) -> np.ndarray:
        return _concatenated([getattr(pairing, name) for pairing in self.each])


def _on_facets(pairing: Pairing) -> sp.csr_array:
    """Points on each facet of the carrying face, bool (n_facets, n)."""
    pieces, shape = pairing.pieces, (len(pairing.carrying.face.sizes), len(pairing.weights))
    ones = np.ones(len(pieces.facet), dtype=bool)
    return sp.csr_array((ones, (pieces.facet, pieces.point)), shape=shape)


def _concatenated(parts: list[np.ndarray]) -> np.ndarray:
    return parts[0] if len(parts) == 1 else np.concatenate(parts)

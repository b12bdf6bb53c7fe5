"""Where the wear of a body goes: to the spot that touches, or over all that passes by.

A face that stays in the contact wears where it is pressed. Points of a strip, disk or drum visit
the contact for a part of the time only; in a frame that does not move with them their wear rate is
the local one, ``Z p^b``, averaged over the way they go. All three cases are
``rate = share * local + row·local`` with a share and a row that differ.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np


class Spreading(Protocol):
    """How the local rate of a body becomes its rate at the points.

    Attributes
    ----------
    share : float
        Part of the local rate that a point keeps.
    row : ndarray, shape (n,), or None
        Weights of the mean that all points have in common.
    """

    @property
    def share(self) -> float: ...

    @property
    def row(self) -> np.ndarray | None: ...

    def rate(self, local: np.ndarray) -> np.ndarray:
        """Wear rate at the points from the local one, shape (n,) [m/s]."""
        ...

    def operator(self, n: int) -> np.ndarray:
        """The matrix of `rate`, shape (n, n)."""
        ...


@dataclass(frozen=True)
class Share:
    """Each point is in the contact for a part of the time: a disk under a pad.

    Attributes
    ----------
    share : float
        Of a pad on a disk its angle over 2 π.
    """

    share: float
    row: ClassVar[None] = None

    def rate(self, local: np.ndarray) -> np.ndarray:
        return self.share * local

    def operator(self, n: int) -> np.ndarray:
        return self.share * np.eye(n)


@dataclass(frozen=True)
class InPlace(Share):
    """The body wears where it is pressed."""

    share: float = 1.0


@dataclass(frozen=True)
class Track:
    """All points of a track pass through the whole contact: a strip, or a drum under a shoe.

    Attributes
    ----------
    row : ndarray, shape (n,)
        Length along the track that each contact point stands for, over the length of the track.
    """

    row: np.ndarray
    share: ClassVar[float] = 0.0

    def rate(self, local: np.ndarray) -> np.ndarray:
        return np.full(len(local), self.row @ local)

    def operator(self, n: int) -> np.ndarray:
        return np.tile(self.row, (n, 1))


def coverage(spreading: Spreading) -> float:
    """Part of the worn area that is in the contact at a time."""
    return spreading.share + (0.0 if spreading.row is None else float(spreading.row.sum()))

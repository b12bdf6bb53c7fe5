"""What every analysis ends with, before it is summed up and written out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .result import HistoryRow, Interface
from .state import BodyState


@dataclass(frozen=True)
class Outcome:
    """What every analysis ends with, before it is written out.

    Attributes
    ----------
    pressure : ndarray, shape (n,) [Pa]
    motion : ndarray, shape (1,)
        Rigid motion of the holder [m].
    state : BodyState
    interface : Interface
    extra : dict
        What the analysis adds to the summary.
    history : list of HistoryRow
    outputs : dict of float to Interface
    stopped : BaseException or None
    """

    pressure: np.ndarray
    motion: np.ndarray
    state: BodyState
    interface: Interface
    extra: dict
    history: list[HistoryRow]
    outputs: dict[float, Interface]
    stopped: BaseException | None = None

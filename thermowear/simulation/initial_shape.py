"""A worn shape to start from: that of an earlier run."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.interpolate import Akima1DInterpolator

from ..errors import CaseError
from ..parallel import on_root

_KEY = "geometry.initial_shape"
_BEYOND = 1e-6  # of the length of the face


def initial_depth(comm, path: str, position: np.ndarray) -> np.ndarray:
    """Depth that a shape lacks of an unworn face, at positions along it. Every rank calls.

    Parameters
    ----------
    comm : mpi4py.MPI.Comm
    path : str
        A ``profile.csv`` (or ``interface.csv``) of an earlier run, or any table with its columns
        ``s_m`` and ``shape_m``.
    position : ndarray, shape (n,)
        Lengths along the face [m].

    Returns
    -------
    ndarray, shape (n,) [m]

    Raises
    ------
    CaseError
        If the file holds no shape, or that of a shorter face.
    """
    s, shape = on_root(comm, lambda: _read(Path(path)))
    beyond = _BEYOND * position[-1]
    if s[0] > position[0] + beyond or s[-1] < position[-1] - beyond:
        raise CaseError(
            f"{_KEY}: {path} ranges from s = {s[0]:.6g} to {s[-1]:.6g} m, the contact face from "
            f"{position[0]:.6g} to {position[-1]:.6g} m"
        )
    height = Akima1DInterpolator(s, shape, method="makima")(np.clip(position, s[0], s[-1]))
    return height.max() - height


def _read(path: Path) -> tuple[np.ndarray, np.ndarray]:
    try:
        table = np.genfromtxt(path, delimiter=",", names=True)
    except (OSError, ValueError) as error:
        raise CaseError(f"{_KEY}: {path} cannot be read: {error}") from None
    names = table.dtype.names or ()
    if not {"s_m", "shape_m"} <= set(names) or table.size < 2:
        raise CaseError(f"{_KEY}: {path} has no columns s_m and shape_m with numbers")
    s, first = np.unique(table["s_m"], return_index=True)
    shape = table["shape_m"][first]
    if len(s) < 2 or not (np.isfinite(s).all() and np.isfinite(shape).all()):
        raise CaseError(f"{_KEY}: {path} has entries that are no numbers")
    return s, shape

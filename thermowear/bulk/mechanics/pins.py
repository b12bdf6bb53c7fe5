"""Single values that are fixed where supports leave bodies free to move; they carry no load."""

from __future__ import annotations

import numpy as np
from scipy.linalg import null_space

from ...parallel import sum_over_ranks


def pin(fixed: np.ndarray, motions: np.ndarray, comm) -> np.ndarray:
    """Fix as many values, in place, as there are motions that no fixed value prevents.

    Every rank calls.

    Parameters
    ----------
    fixed : ndarray of bool, shape (n_owned,)
    motions : ndarray, shape (n_owned, k)
        Rigid motions of bodies.
    comm : mpi4py.MPI.Comm

    Returns
    -------
    ndarray, shape (n_owned, m)
        Free motions, at most one for each of the given ones.
    """
    free = left = _free(motions, fixed, comm)
    while left.shape[1]:
        _pin(fixed, left[:, 0], comm)
        left = _free(left, fixed, comm)
    return free


def _free(motions: np.ndarray, fixed: np.ndarray, comm) -> np.ndarray:
    """Combinations of motions (n_owned, k) that move no fixed value, scaled to 1."""
    if not motions.shape[1]:
        return motions
    scale = np.sqrt(sum_over_ranks(comm, (motions**2).sum(axis=0)))
    scaled = motions / np.where(scale > 0.0, scale, 1.0)
    held = sum_over_ranks(comm, scaled[fixed].T @ scaled[fixed])
    combined = scaled @ null_space(held, rcond=1e-12) if held.any() else scaled
    largest = max(comm.allgather(float(np.abs(combined).max(initial=0.0))))
    return combined / (largest or 1.0)


def _pin(fixed: np.ndarray, motion: np.ndarray, comm) -> None:
    """Fix the free value that moves most, in place; every rank calls."""
    movable = np.where(fixed, 0.0, np.abs(motion))
    own = float(movable.max(initial=0.0))
    largest = comm.allgather(own)
    if int(np.argmax(largest)) == comm.rank and own > 0.0:
        fixed[int(np.argmax(movable))] = True

"""Consistency of MPI ranks: identical sums, and errors raised on every rank."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from typing import Any

import numpy as np


def sum_over_ranks(comm, values):
    """Sum arrays or numbers over all ranks; the result is bitwise identical on every rank."""
    if comm.size == 1:
        return values
    total = comm.reduce(np.asarray(values), root=0)
    return comm.bcast(total, root=0)


def on_root(comm, action: Callable[[], Any], share: bool = True) -> Any:
    """Run an action on rank 0 only; return its result, or raise its error, on every rank.

    Parameters
    ----------
    comm : mpi4py.MPI.Comm
    action : callable
    share : bool
        False: the other ranks get None, as a large mesh that only rank 0 needs.
    """
    if comm.size == 1:
        return action()
    result, sent = None, None
    if comm.rank == 0:
        try:
            result = action()
            sent = pickle.dumps((result if share else None, None))
        except (Exception, KeyboardInterrupt) as caught:
            sent = pickle.dumps((None, caught))
    received, error = pickle.loads(comm.bcast(sent, root=0))
    if error is not None:
        raise error
    return received if share else result

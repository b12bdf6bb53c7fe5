"""Consistency of MPI ranks: identical sums, and errors raised on every rank."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from typing import Any

import numpy as np

_MANY_ROWS = 1000
"""Least number of rows of a rank for which sharing the work pays."""


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


def rows_over_ranks(
    comm, count: int, compute: Callable[[slice], tuple[np.ndarray, ...]]
) -> tuple[np.ndarray, ...]:
    """Compute arrays by rows, if many a range of them on each rank; whole on every rank.

    Parameters
    ----------
    comm : mpi4py.MPI.Comm or None
        Every rank calls; None: this process alone.
    count : int
        Number of rows.
    compute : callable
        Rows in a range. Errors are raised on every rank.
    """
    if comm is None or count < _MANY_ROWS * comm.size or comm.size == 1:
        return compute(slice(0, count))
    ends = np.linspace(0, count, comm.size + 1).astype(int)
    rows: tuple[np.ndarray, ...] = ()
    error = None
    try:
        rows = compute(slice(ends[comm.rank], ends[comm.rank + 1]))
    except (Exception, KeyboardInterrupt) as caught:
        error = caught
    for raised in comm.allgather(error):
        if raised is not None:
            raise raised
    return tuple(np.concatenate(parts) for parts in zip(*comm.allgather(rows), strict=True))

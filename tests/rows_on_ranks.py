"""Rows of arrays computed on several ranks; started by `test_parallel`."""

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.parallel import rows_over_ranks

COUNT = 5001


def main():
    comm, x = MPI.COMM_WORLD, np.arange(float(COUNT))

    def compute(rows):
        return x[rows] ** 2, np.full(len(x[rows]), comm.rank)

    def failing(rows):
        if rows.stop == COUNT:
            raise ValueError("in the last row")
        return compute(rows)

    squares, rank = rows_over_ranks(comm, COUNT, compute)
    assert np.array_equal(squares, x**2)
    assert np.array_equal(np.unique(rank), np.arange(comm.size))
    with pytest.raises(ValueError, match="in the last row"):
        rows_over_ranks(comm, COUNT, failing)


if __name__ == "__main__":
    main()

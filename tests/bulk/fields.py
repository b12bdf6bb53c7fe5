"""Fields of all bodies, their integrals, and matrices without entries."""

from petsc4py import PETSc

import numpy as np
from dolfinx import fem

from thermowear.parallel import sum_over_ranks


def interpolated(spaces, function):
    """Owned values of a field given at x of shape (3, n)."""
    found = []
    for space, size in zip(spaces.each, np.diff(spaces.starts), strict=True):
        values = fem.Function(space)
        values.interpolate(function)
        found.append(values.x.array[:size])
    return np.concatenate(found)


def integral(bodies, *forms):
    """Sum over bodies and ranks of a form for each body."""
    return sum_over_ranks(bodies.comm, sum(fem.assemble_scalar(fem.form(f)) for f in forms))


def empty_matrix(spaces):
    """Matrix of all bodies without entries."""
    n = (spaces.owned, spaces.total)
    nothing = PETSc.Mat().createAIJ((n, n), comm=spaces.comm)
    nothing.setUp()
    nothing.assemble()
    return nothing


def times(matrix, values):
    """Product of a matrix and owned values."""
    x, y = matrix.createVecs()
    x.setArray(values)
    matrix.mult(x, y)
    return y.getArray().copy()

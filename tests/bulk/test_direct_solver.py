"""Sparse direct solver: solutions, and singular matrices."""

import subprocess
import sys

from petsc4py import PETSc

import numpy as np
import pytest
import scipy.sparse as sp

from thermowear.bulk.solvers.direct import DirectSolver
from thermowear.errors import ComputationError


def petsc(matrix) -> PETSc.Mat:
    rows = sp.csr_matrix(matrix)
    found = PETSc.Mat().createAIJ(rows.shape, csr=(rows.indptr, rows.indices, rows.data))
    found.assemble()
    return found


def test_a_matrix_is_solved_with_many_right_hand_sides():
    """requirement: dense and sparse ones alike."""
    matrix = np.array([[4.0, 1.0, 0.0], [1.0, 3.0, 1.0], [0.0, 1.0, 2.0]])
    factor, loads = DirectSolver(petsc(matrix)), np.array([[1.0, 0.0], [0.0, 2.0], [3.0, 1.0]])
    expected = np.linalg.solve(matrix, loads)
    assert factor.solve(loads) == pytest.approx(expected, rel=1e-14)
    assert factor.solve(sp.csr_matrix(loads)) == pytest.approx(expected, rel=1e-14)


def test_sparse_right_hand_sides_without_entries(monkeypatch):
    """requirement: loads of one body are none of the others: zero, without a call of MUMPS."""
    factor = DirectSolver(petsc(np.diag([4.0, 3.0, 2.0])))
    monkeypatch.setattr(factor, "_factored", None)
    found = factor.solve(sp.csr_matrix((3, 2)))
    assert found.shape == (3, 2)
    assert not found.any()


@pytest.mark.parametrize("symmetry", ["definite", "symmetric", "none"])
def test_a_singular_matrix_is_an_error_in_words(symmetry):
    """requirement: no factor, no solution: exit code 2 and the reason."""
    with pytest.raises(ComputationError, match=r"cannot be factorised.*singular"):
        DirectSolver(petsc(np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 2.0]])), symmetry)


@pytest.mark.parametrize("symmetry", ["symmetric", "none"])
def test_a_workspace_that_is_too_small_is_enlarged(symmetry):
    """requirement: where rows are exchanged and the estimate is too small, the solution is found
    with a larger workspace.
    """
    random, n = np.random.default_rng(1), 1000
    inner, links = (sp.random(n, m, 0.02, random_state=random) for m in (n, n // 2))
    inner = 1e-8 * (inner @ inner.T) + 1e-9 * sp.eye(n)
    links = links + sp.eye(n, n // 2)
    matrix = sp.block_array([[inner, links], [links.T, None]], format="csr")
    load, tried = random.random(matrix.shape[0]), []

    class WithoutReserve(DirectSolver):
        def _prepare(self, workspace=0):
            tried.append(workspace)
            super()._prepare(workspace)

    factor = WithoutReserve(petsc(matrix), symmetry)
    found = factor.solve(load)
    assert np.abs(matrix @ found - load).max() < 1e-10 * np.abs(found).max()
    assert len(tried) > 1


@pytest.mark.parametrize("dim", [2, 3])
def test_unknowns_that_are_all_coupled(dim):
    """requirement: the matrix of a single cell is factorised like any other; PORD would end the
    process. In a process of its own, so that a failing test is not the end of all.
    """
    program = f"""
from thermowear.app.batch.computing import start_petsc
start_petsc()
import numpy as np
import subprocess
import sys

from petsc4py import PETSc
from thermowear.bulk.solvers.direct import DirectSolver
matrix = PETSc.Mat().createDense((24, 24), array=np.eye(24) + 1.0).convert("aij")
print(abs(DirectSolver(matrix, "definite", {dim}).solve(np.full(24, 25.0)) - 1.0).max() < 1e-12)
"""
    command = [sys.executable, "-c", program]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "True"
